#include "lab/export/macro_expansion.h"

#include "base/error.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

namespace gnomon::code {

struct MacroOrigin {
  std::string name;
  std::shared_ptr<const MacroOrigin> outer;
  int depth = 1;
};

namespace {

// Bounds within which all code stays that a person writes; what is beyond them exhausts the stack or the memory.
constexpr int kDeepestMacros = 200;      // within macros
constexpr size_t kMostTokens = 200'000;  // that all macros together become

[[noreturn]] void failAt(const Token& token, const std::string& what, const std::string& remedy) {
  throw WorldError(fmt::format("{}:{}: {}; {}", token.file, token.line, what, remedy));
}
[[noreturn]] void failCall(const Token& token) {
  failAt(token, fmt::format("the call of macro {} does not end", token.text), "close its parenthesis");
}

[[noreturn]] void failDepth(const Token& token) {
  failAt(token, fmt::format("macros are more than {} deep within macros", kDeepestMacros), "use fewer");
}

bool isWithin(const std::shared_ptr<const MacroOrigin>& origin, const std::string& name) {
  for (const MacroOrigin* at = origin.get(); at != nullptr; at = at->outer.get())
    if (at->name == name) return true;
  return false;
}

}  // namespace

void MacroExpansion::set(const std::string& name, Macro macro) {
  expandWaiting();
  macros_[name] = std::move(macro);
}

void MacroExpansion::remove(const std::string& name) {
  expandWaiting();
  if (waiting_.size() > 1 && waiting_.back().token.text == name) failCall(waiting_.back().token);
  macros_.erase(name);
}

void MacroExpansion::read(std::vector<Token>& tokens) {
  for (Token& token : tokens) read_.push_back({.token = std::move(token), .origin = nullptr});
}

std::vector<Token> MacroExpansion::takeExpanded() {
  expandWaiting();
  if (!waiting_.empty()) failCall(waiting_.back().token);
  return std::move(out_);
}

void MacroExpansion::expandWaiting() {
  // The next token is the last.
  std::vector<Waiting> stack(std::make_move_iterator(read_.rbegin()), std::make_move_iterator(read_.rend()));
  read_.clear();
  std::move(waiting_.begin(), waiting_.end(), std::back_inserter(stack));
  waiting_.clear();
  while (!stack.empty())
    if (!expand(stack, out_)) break;
  waiting_ = std::move(stack);
}

// The arguments of the call whose parenthesis is next on the stack, none expanded yet, and `from` behind it. Absent
// where it does not end.
std::optional<std::vector<std::vector<MacroExpansion::Waiting>>> MacroExpansion::takeArguments(
    std::vector<Waiting>& from, const Macro& macro, std::string& after) {
  std::vector<std::vector<Waiting>> args(1);
  int depth = 0;
  for (size_t i = from.size(); i-- > 0;) {
    const std::string& text = from[i].token.text;
    if (text == "(" && depth++ == 0) continue;
    if (text == ")" && --depth == 0) {
      after = from[i].token.after;
      from.resize(i);
      return args;
    }
    if (text == "," && depth == 1 && macro.params.size() > 1)
      args.emplace_back();
    else
      args.back().push_back(from[i]);
  }
  return std::nullopt;
}

// An argument with its macros replaced.
std::vector<MacroExpansion::Waiting> MacroExpansion::expanded(const std::vector<Waiting>& argument) {
  std::vector<Waiting> stack(argument.rbegin(), argument.rend()), all;
  if (++argumentDepth_ > kDeepestMacros) failDepth(argument.front().token);
  while (!stack.empty()) {
    if (!expand(stack, all)) {  // the name of a macro with parameters, which may be called where the argument goes
      all.push_back(std::move(stack.back()));
      stack.pop_back();
    }
  }
  --argumentDepth_;
  return all;
}

// What a macro's call stands for; `after`: the comment behind the call.
std::vector<MacroExpansion::Waiting> MacroExpansion::replacement(const Waiting& call, const Macro& macro,
                                                                 const std::vector<std::vector<Waiting>>& args,
                                                                 const std::string& after) {
  const int depth = call.origin != nullptr ? call.origin->depth + 1 : 1;
  if (depth > kDeepestMacros) failDepth(call.token);
  const auto origin =
      std::make_shared<const MacroOrigin>(MacroOrigin{.name = call.token.text, .outer = call.origin, .depth = depth});
  std::vector<Waiting> replaced;
  for (const Token& part : macro.body) {
    const auto param = std::ranges::find(macro.params, part.text);
    if (param != macro.params.end()) {
      const auto& argument = args[static_cast<size_t>(param - macro.params.begin())];
      replaced.insert(replaced.end(), argument.begin(), argument.end());
    } else {
      replaced.push_back({.token = part, .origin = origin});
      replaced.back().token.file = call.token.file;
      replaced.back().token.line = call.token.line;
    }
    if (replacedCount_ + replaced.size() > kMostTokens)
      failAt(call.token, fmt::format("its macros become more than {} words", kMostTokens), "let them stand for less");
  }
  replacedCount_ += replaced.size();
  if (!replaced.empty()) {
    Token& first = replaced.front().token;
    first.before.insert(first.before.begin(), call.token.before.begin(), call.token.before.end());
    if (replaced.back().token.after.empty()) replaced.back().token.after = after;
  }
  return replaced;
}

// One token, or one macro's call, which the stack then holds replaced. False where the call does not end yet.
template <typename To>
bool MacroExpansion::expand(std::vector<Waiting>& from, To& to) {
  const auto found = macros_.find(from.back().token.text);
  const bool calls = found != macros_.end() && found->second.hasParams;
  if (calls && from.size() == 1 && !isWithin(from.back().origin, found->first)) return false;
  if (found == macros_.end() || (calls && (from.size() == 1 || from[from.size() - 2].token.text != "(")) ||
      isWithin(from.back().origin, found->first)) {
    put(std::move(from.back()), to);
    from.pop_back();
    return true;
  }
  const Macro& macro = found->second;
  const Waiting call = from.back();
  from.pop_back();
  std::string after = call.token.after;
  std::vector<std::vector<Waiting>> args;
  if (macro.hasParams) {
    auto taken = takeArguments(from, macro, after);
    if (!taken) {
      from.push_back(call);
      return false;
    }
    args = std::move(*taken);
    if (args.size() < macro.params.size())
      failAt(call.token, fmt::format("macro {} has {} arguments", call.token.text, macro.params.size()),
             fmt::format("give it {}", macro.params.size()));
    for (auto& argument : args)
      if (!argument.empty()) argument = expanded(argument);
  }
  std::vector<Waiting> replaced = replacement(call, macro, args, after);
  std::move(replaced.rbegin(), replaced.rend(), std::back_inserter(from));
  return true;
}

}  // namespace gnomon::code
