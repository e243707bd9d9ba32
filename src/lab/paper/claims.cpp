#include "lab/paper/claims.h"

#include "base/check.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace gnomon {

namespace {

// Recursive descent over one condition. A number that was not measured is NaN, and remembered.
class Condition {
 public:
  Condition(const std::string& text, const Numbers& numbers, JudgedClaim& claim)
      : text_(text), numbers_(numbers), claim_(claim) {}

  bool holds() {
    bool all = true;
    double left = sum();
    do {
      skipSpace();
      expect(at_ < text_.size() && (text_[at_] == '<' || text_[at_] == '>'));
      const bool less = text_[at_++] == '<';
      const bool orEqual = take('=');
      const double right = sum();
      all = all && (left == right ? orEqual : less == (left < right));
      left = right;
      skipSpace();
    } while (at_ < text_.size());
    return all;
  }

 private:
  void expect(bool condition) const {
    if (!condition) {
      fmt::print(stderr, "condition '{}', at {}\n", text_, at_);
      GNOMON_CHECK(condition);
    }
  }
  void skipSpace() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  }
  bool take(char wanted) {
    skipSpace();
    if (at_ >= text_.size() || text_[at_] != wanted) return false;
    ++at_;
    return true;
  }
  // A literal or a name: where a factor may begin without a sign of multiplication, as in "10 acne(b)".
  bool atFactor() {
    skipSpace();
    return at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '(');
  }

  double sum() {
    double value = product();
    for (;;) {
      if (take('+'))
        value += product();
      else if (take('-'))
        value -= product();
      else
        return value;
    }
  }

  double product() {
    double value = factor();
    for (;;) {
      if (take('*') || atFactor())
        value *= factor();
      else if (take('/'))
        value /= factor();
      else
        return value;
    }
  }

  double factor() {
    if (take('(')) {
      const double value = sum();
      expect(take(')'));
      return value;
    }
    skipSpace();
    expect(at_ < text_.size());
    return std::isdigit(static_cast<unsigned char>(text_[at_])) != 0 ? literal() : named();
  }

  double literal() {
    double value = 0.0;
    const auto [end, failure] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    expect(failure == std::errc());
    at_ = static_cast<size_t>(end - text_.data());
    return take('%') ? value / 100.0 : value;
  }

  // min(a, b), max(a, b), or quantity(place).
  double named() {
    const size_t open = text_.find('(', at_);
    expect(open != std::string::npos);
    const std::string word = text_.substr(at_, open - at_);
    if (word == "min" || word == "max") {
      at_ = open + 1;
      const double a = sum();
      expect(take(','));
      const double b = sum();
      expect(take(')'));
      return word == "min" ? std::min(a, b) : std::max(a, b);
    }
    const size_t close = text_.find(')', open);
    expect(close != std::string::npos);
    const std::string name = text_.substr(at_, close + 1 - at_);
    at_ = close + 1;
    return lookUp(name);
  }

  double lookUp(const std::string& name) {
    const auto found = numbers_.find(name);
    if (found == numbers_.end() || !std::isfinite(found->second)) {
      if (std::ranges::find(claim_.missing, name) == claim_.missing.end()) claim_.missing.push_back(name);
      return std::numeric_limits<double>::quiet_NaN();
    }
    if (std::ranges::find(claim_.numbers, name, &std::pair<std::string, double>::first) == claim_.numbers.end())
      claim_.numbers.emplace_back(name, found->second);
    return found->second;
  }

  const std::string& text_;
  const Numbers& numbers_;
  JudgedClaim& claim_;
  size_t at_ = 0;
};

}  // namespace

const char* verdictName(ClaimVerdict verdict) {
  switch (verdict) {
    case ClaimVerdict::Holds:
      return "holds";
    case ClaimVerdict::HoldsInPart:
      return "holds in part";
    case ClaimVerdict::DoesNotHold:
      return "does not hold here";
    case ClaimVerdict::NotRun:
      return "not run";
  }
  return "";
}

JudgedClaim judgeClaim(const Claim& claim, const Numbers& numbers) {
  JudgedClaim judged{.claim = claim};
  GNOMON_CHECK(!claim.conditions.empty());
  for (const std::string& text : claim.conditions)
    judged.conditions.push_back({text, Condition(text, numbers, judged).holds()});
  if (!judged.missing.empty()) {
    judged.conditions.clear();
    return judged;
  }
  const auto held = std::ranges::count_if(judged.conditions, &JudgedCondition::holds);
  judged.verdict = held == std::ssize(judged.conditions) ? ClaimVerdict::Holds
                   : held > 0                            ? ClaimVerdict::HoldsInPart
                                                         : ClaimVerdict::DoesNotHold;
  return judged;
}

std::string numberText(double value) {
  if (value == std::round(value) && std::abs(value) < 1e15) return fmt::format("{:.0f}", value);
  if (std::abs(value) >= 0.01 && std::abs(value) < 1e6) return fmt::format("{:.4g}", value);
  return fmt::format("{:.3g}", value);
}

std::string evidenceText(const JudgedClaim& claim) {
  std::string text;
  if (!claim.missing.empty()) {
    for (const std::string& name : claim.missing) text += (text.empty() ? "" : ", ") + name;
    return "not measured: " + text;
  }
  for (const auto& [name, value] : claim.numbers)
    text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", name, numberText(value));
  for (const JudgedCondition& condition : claim.conditions)
    text += fmt::format("; {}: {}", condition.text, condition.holds ? "yes" : "no");
  return text;
}

}  // namespace gnomon
