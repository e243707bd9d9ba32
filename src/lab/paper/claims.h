#pragma once
// Claims of a paper and their verdicts. A verdict is computed from measured numbers by the rule next to the claim, and
// by nothing else.
//
//   {.figure = "5 (c)", .says = "...", .conditions = {"leak(5c) < leak(5b) / 10", "acne(5c) >= 0.9 acne(5b)"}}
//
// A number is named quantity(place). A condition compares sums, two or more in a chain (0.9 a(b) <= a(c) <=
// 1.1 a(b)): numbers, literals (10, 0.1%), + - * /, parentheses, min(..., ...) and max(..., ...). All
// conditions true: the claim holds; some: in part; none: it does not hold here. Where a number was not
// measured there is no verdict, and the claim says so.

#include <map>
#include <string>
#include <vector>

namespace gnomon {

// By name, as "acne(5b)". Counts are pixels, times milliseconds, errors fractions.
using Numbers = std::map<std::string, double>;

struct Claim {
  std::string paper;   // weiskopf2003, dou2014
  std::string figure;  // "5 (c)", "table 1", "equation 6"
  std::string says;    // what the paper says, in other words
  std::string run;     // what is run to see
  std::vector<std::string> conditions;
};

enum class ClaimVerdict { Holds, HoldsInPart, DoesNotHold, NotRun };
const char* verdictName(ClaimVerdict verdict);  // "holds", "holds in part", "does not hold here", "not run"

struct JudgedCondition {
  std::string text;
  bool holds = false;
};

struct JudgedClaim {
  Claim claim;
  ClaimVerdict verdict = ClaimVerdict::NotRun;
  std::vector<JudgedCondition> conditions;              // empty where it was not run
  std::vector<std::pair<std::string, double>> numbers;  // that the conditions name, in their order
  std::vector<std::string> missing;                     // numbers that were not measured
};

// Aborts where a condition cannot be parsed: the claims are written in this program.
JudgedClaim judgeClaim(const Claim& claim, const Numbers& numbers);

// A number for people: counts whole, small fractions with three digits.
std::string numberText(double value);
// "acne(5b) = 489, leak(5b) = 807; acne(5b) > 0.1% scored(5b): yes"
std::string evidenceText(const JudgedClaim& claim);

}  // namespace gnomon
