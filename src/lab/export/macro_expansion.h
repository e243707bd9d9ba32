#pragma once
// Macros of GLSL, replaced as the C++ preprocessor replaces them, but for # and ##.

#include <cctype>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gnomon::code {

struct Token {
  std::string text;
  std::vector<std::string> before;  // comment lines right above
  std::string after;                // comment on the same line
  std::string file;
  int line = 0;

  bool isName() const { return std::isalpha(static_cast<unsigned char>(text[0])) != 0 || text[0] == '_'; }
};

struct Macro {
  bool hasParams = false;
  std::vector<std::string> params;
  std::vector<Token> body;
};

// The macro that a token is of, and those that it is of: within its own expansion a macro is a plain name.
struct MacroOrigin;

// A macro's call may go on over lines, so tokens wait until what a macro stands for changes, or the text ends.
//
// Throws WorldError, "file:line: ...", where a call does not end or lacks arguments, or where there is more than a
// person writes: macros 200 deep within macros, or 200,000 words of all macros together.
class MacroExpansion {
 public:
  bool contains(const std::string& name) const { return macros_.contains(name); }
  // What was read until now is not changed by them.
  void set(const std::string& name, Macro macro);
  void remove(const std::string& name);

  void read(std::vector<Token>& tokens);
  // Of all that was read.
  std::vector<Token> takeExpanded();

 private:
  struct Waiting {
    Token token;
    std::shared_ptr<const MacroOrigin> origin;
  };

  void expandWaiting();
  static std::optional<std::vector<std::vector<Waiting>>> takeArguments(std::vector<Waiting>& from, const Macro& macro,
                                                                        std::string& after);
  std::vector<Waiting> expanded(const std::vector<Waiting>& argument);
  template <typename To>
  bool expand(std::vector<Waiting>& from, To& to);
  std::vector<Waiting> replacement(const Waiting& call, const Macro& macro,
                                   const std::vector<std::vector<Waiting>>& args, const std::string& after);

  static void put(Waiting&& one, std::vector<Token>& to) { to.push_back(std::move(one.token)); }
  static void put(Waiting&& one, std::vector<Waiting>& to) { to.push_back(std::move(one)); }

  std::map<std::string, Macro> macros_;
  std::vector<Token> out_;
  std::vector<Waiting> read_;     // since macros last changed
  std::vector<Waiting> waiting_;  // a call that did not end there, its name last
  int argumentDepth_ = 0;         // of calls within arguments
  size_t replacedCount_ = 0;
};

}  // namespace gnomon::code
