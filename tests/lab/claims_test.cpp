// Verdicts: computed from numbers by the rule that is shown, and by nothing else.
#include "lab/paper/claims.h"
#include "lab/paper/reproduce_dou2014.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace gnomon {
namespace {

JudgedClaim judge(const std::vector<std::string>& conditions, const Numbers& numbers) {
  return judgeClaim({.paper = "", .figure = "", .says = "", .run = "", .conditions = conditions}, numbers);
}

bool holds(const std::string& condition, const Numbers& numbers = {}) {
  return judge({condition}, numbers).verdict == ClaimVerdict::Holds;
}

TEST(Claims, AConditionIsTheArithmeticItReads) {
  EXPECT_TRUE(holds("1 + 2 * 3 >= 7"));
  EXPECT_FALSE(holds("1 + 2 * 3 > 7"));
  EXPECT_TRUE(holds("8 - 2 - 1 <= 5"));
  EXPECT_TRUE(holds("8 / 2 / 2 <= 2"));
  EXPECT_TRUE(holds("2 (1 + 2) >= 6"));
  EXPECT_TRUE(holds("50% 4 <= 2"));
  EXPECT_TRUE(holds("max(1, min(5, 3)) >= 3"));
  EXPECT_TRUE(holds("2 a(5b) > 5", {{"a(5b)", 3.0}}));
  EXPECT_TRUE(holds("a(far wall, best) < 4", {{"a(far wall, best)", 3.0}}));
}

TEST(Claims, AChainHoldsWhereAllItsLinksDo) {
  EXPECT_TRUE(holds("1 <= 2 <= 3"));
  EXPECT_FALSE(holds("1 <= 4 <= 3"));
  EXPECT_FALSE(holds("3 <= 2 <= 3"));
  EXPECT_TRUE(holds("2 <= 2 <= 2"));
  EXPECT_FALSE(holds("2 < 2 <= 2"));
}

TEST(Claims, AVerdictCountsTheConditionsThatAreTrue) {
  const Numbers numbers = {{"a(x)", 1.0}};
  EXPECT_EQ(judge({"a(x) < 2", "a(x) > 0"}, numbers).verdict, ClaimVerdict::Holds);
  EXPECT_EQ(judge({"a(x) < 2", "a(x) > 1"}, numbers).verdict, ClaimVerdict::HoldsInPart);
  EXPECT_EQ(judge({"a(x) > 2", "a(x) > 1"}, numbers).verdict, ClaimVerdict::DoesNotHold);
}

TEST(Claims, WithoutItsNumbersAClaimHasNoVerdict) {
  const JudgedClaim judged = judge({"a(x) < 2", "b(x) < 2"}, {{"a(x)", 1.0}});
  EXPECT_EQ(judged.verdict, ClaimVerdict::NotRun);
  EXPECT_EQ(judged.missing, std::vector<std::string>{"b(x)"});
  EXPECT_EQ(judge({"a(x) < 2"}, {{"a(x)", std::nan("")}}).verdict, ClaimVerdict::NotRun);
}

TEST(Claims, TheEvidenceNamesEachNumberOnce) {
  const JudgedClaim judged = judge({"a(x) < 2 b(x)", "a(x) > 0.25"}, {{"a(x)", 489.0}, {"b(x)", 0.000123456}});
  EXPECT_EQ(evidenceText(judged), "a(x) = 489, b(x) = 0.000123; a(x) < 2 b(x): no; a(x) > 0.25: yes");
}

TEST(ClaimsDeathTest, WhatCannotBeParsedAborts) {
  EXPECT_DEATH(holds("a(x)"), "condition 'a\\(x\\)'");
  EXPECT_DEATH(holds("1 < 2 3)"), "condition");
  EXPECT_DEATH(holds("(1 < 2"), "condition");
}

const JudgedClaim& claimOf(const std::vector<JudgedClaim>& claims, const std::string& figure) {
  return *std::ranges::find_if(claims, [&](const JudgedClaim& judged) { return judged.claim.figure == figure; });
}

// Figure 5 as it was measured; with the numbers of its panels exchanged, the claims turn.
TEST(Claims, TurnedNumbersTurnTheVerdict) {
  const Numbers measured = {{"acne(5b)", 121}, {"leak(5b)", 210}, {"acne(5c)", 121},
                            {"leak(5c)", 0},   {"acne(5e)", 0},   {"leak(5e)", 256},
                            {"acne(5f)", 0},   {"leak(5f)", 0},   {"leak(5d)", 14042}};
  const auto verdictOf = [](const char* figure, const Numbers& numbers) {
    std::vector<JudgedClaim> judged;
    for (const Claim& claim : weiskopfClaims()) judged.push_back(judgeClaim(claim, numbers));
    return claimOf(judged, figure).verdict;
  };
  const auto exchanged = [&](const char* a, const char* b) {
    Numbers numbers = measured;
    std::swap(numbers.at(a), numbers.at(b));
    return numbers;
  };
  EXPECT_EQ(verdictOf("5 (c)", measured), ClaimVerdict::Holds);
  EXPECT_EQ(verdictOf("5 (c)", exchanged("leak(5b)", "leak(5c)")), ClaimVerdict::DoesNotHold);
  EXPECT_EQ(verdictOf("5 (e)", measured), ClaimVerdict::Holds);
  EXPECT_EQ(verdictOf("5 (e)", exchanged("acne(5b)", "acne(5e)")), ClaimVerdict::DoesNotHold);
  Numbers half = measured;
  half.at("leak(5c)") = 50;
  EXPECT_EQ(verdictOf("5 (c)", half), ClaimVerdict::HoldsInPart);
}

// No rule is a tautology, and none asks for the impossible: over random numbers each condition is true for
// some and false for some.
TEST(Claims, EveryRuleCanHoldAndCanFail) {
  constexpr std::array<double, 16> kValues = {0,   0.001, 0.01, 0.5, 0.95, 1,  1.05, 1.15,
                                              1.5, 1.8,   2,    3,   5,    20, 1000, 1e6};
  std::mt19937 random(1);
  std::vector<Claim> claims = weiskopfClaims();
  const std::vector<Claim> others = douClaims();
  claims.insert(claims.end(), others.begin(), others.end());
  EXPECT_GT(claims.size(), 50u);
  for (const Claim& claim : claims) {
    EXPECT_FALSE(claim.says.empty() || claim.run.empty() || claim.figure.empty());
    for (const std::string& condition : claim.conditions) {
      std::set<bool> seen;
      for (int i = 0; i < 20000 && seen.size() < 2; ++i) {
        Numbers numbers;
        for (const std::string& name : judge({condition}, {}).missing)
          numbers[name] = kValues[random() % kValues.size()];
        const JudgedClaim judged = judge({condition}, numbers);
        ASSERT_FALSE(judged.conditions.empty()) << condition;
        seen.insert(judged.conditions.front().holds);
      }
      EXPECT_EQ(seen.size(), 2u) << condition;
    }
  }
}

}  // namespace
}  // namespace gnomon
