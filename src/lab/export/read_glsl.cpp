#include "lab/export/read_glsl.h"

#include "base/error.h"

#include <algorithm>
#include <cctype>
#include <string_view>

#include <fmt/format.h>

namespace gnomon::code {

namespace {

struct Token {
  std::string text;
  std::vector<std::string> before;  // comment lines right above
  std::string after;                // comment on the same line
  std::string file;
  int line = 0;

  bool isName() const { return std::isalpha(static_cast<unsigned char>(text[0])) != 0 || text[0] == '_'; }
};

bool isWordLetter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

// "// text" to " text", so that pictures keep their columns.
std::string commentText(std::string_view line) {
  line.remove_prefix(std::min<size_t>(line.find("//") + 2, line.size()));
  return std::string(line.substr(0, line.find_last_not_of(" \t\r") + 1));
}

size_t lengthOfOperator(std::string_view rest) {
  for (const char* three : {"<<=", ">>="})
    if (rest.starts_with(three)) return 3;
  for (const char* two :
       {"==", "!=", "<=", ">=", "&&", "||", "<<", ">>", "++", "--", "+=", "-=", "*=", "/=", "|=", "&=", "^="})
    if (rest.starts_with(two)) return 2;
  return 1;
}

struct Macro {
  bool hasParams = false;
  std::vector<std::string> params;
  std::vector<Token> body;
};

// Lines of an expanded shader to tokens, with directives obeyed and macros replaced.
class Preprocessor {
 public:
  explicit Preprocessor(const ReadOptions& options) {
    for (const char* name : {"GNOMON_FN", "GNOMON_SHARED_BEGIN", "GNOMON_SHARED_END"}) macros_[name] = {};
    setMacro("GNOMON_OUT", {"T"}, "out T");
    setMacro("GNOMON_INOUT", {"T"}, "inout T");
    setMacro("GNOMON_GLSL_ONLY", {"T"}, "T");
    setMacro("GNOMON_CPP_ONLY", {"T"}, "");
    setMacro("GNOMON_PUBLIC_ONLY", {"T"}, options.publicMembers ? "T" : "");
    setMacro("GNOMON_MEMBER_ARRAY", {"object", "array"}, "object.array");
    macros_["GNOMON_PRECISE"] = {.body = tokensOf("precise")};
    kept_ = {"GNOMON_FN",
             "GNOMON_SHARED_BEGIN",
             "GNOMON_SHARED_END",
             "GNOMON_OUT",
             "GNOMON_INOUT",
             "GNOMON_GLSL_ONLY",
             "GNOMON_CPP_ONLY",
             "GNOMON_PUBLIC_ONLY",
             "GNOMON_MEMBER_ARRAY",
             "GNOMON_PRECISE",
             "atan2"};
    for (const std::string& name : options.defined) macros_[name] = {};
    for (const auto& [name, text] : options.aliases) macros_[name] = {.body = tokensOf(text)};
    for (const auto& [name, text] : options.aliases) kept_.insert(name);
  }

  std::vector<Token> run(const std::string& text) {
    for (size_t begin = 0; begin < text.size();) {
      size_t end = std::min(text.find('\n', begin), text.size());
      std::string line = text.substr(begin, end - begin);
      begin = end + 1;
      while (line.ends_with('\\') && begin < text.size()) {
        end = std::min(text.find('\n', begin), text.size());
        line = line.substr(0, line.size() - 1) + text.substr(begin, end - begin);
        begin = end + 1;
        ++line_;
      }
      readLine(line);
      ++line_;
    }
    return std::move(out_);
  }

  std::vector<std::pair<std::string, std::vector<std::string>>> takeHeads() { return std::move(heads_); }

 private:
  void setMacro(const char* name, std::vector<std::string> params, const std::string& body) {
    macros_[name] = {.hasParams = true, .params = std::move(params), .body = tokensOf(body)};
  }

  std::vector<Token> tokensOf(const std::string& text) {
    std::vector<Token> tokens;
    tokenize(text, tokens);
    return tokens;
  }

  // Returns the comment behind the last one.
  std::string tokenize(std::string_view line, std::vector<Token>& tokens) {
    for (size_t i = 0; i < line.size();) {
      if (std::isspace(static_cast<unsigned char>(line[i])) != 0) {
        ++i;
        continue;
      }
      if (line.substr(i).starts_with("//")) return commentText(line.substr(i));
      size_t length = 1;
      if (isWordLetter(line[i]) ||
          (line[i] == '.' && i + 1 < line.size() && std::isdigit(static_cast<unsigned char>(line[i + 1])) != 0)) {
        const bool number = std::isdigit(static_cast<unsigned char>(line[i])) != 0 || line[i] == '.';
        while (i + length < line.size()) {
          const char c = line[i + length], last = line[i + length - 1];
          const bool exponentSign =
              number && (c == '+' || c == '-') && (last == 'e' || last == 'E') && !line.substr(i).starts_with("0x");
          if (!isWordLetter(c) && !(number && c == '.') && !exponentSign) break;
          ++length;
        }
      } else {
        length = lengthOfOperator(line.substr(i));
      }
      tokens.push_back({.text = std::string(line.substr(i, length)), .file = file_, .line = line_});
      i += length;
    }
    return {};
  }

  bool isActive() const {
    return std::ranges::all_of(conditions_, [](bool b) { return b; });
  }

  void readLine(const std::string& line) {
    const size_t first = line.find_first_not_of(" \t");
    if (first == std::string::npos) {
      endHead();
      pending_.clear();
      return;
    }
    if (line[first] == '#') {
      endHead();
      pending_.clear();
      readDirective(line.substr(first + 1));
      return;
    }
    if (!isActive()) return;
    std::vector<Token> tokens;
    const std::string comment = tokenize(line, tokens);
    if (tokens.empty()) {
      (inHead_ ? head_ : pending_).push_back(comment);
      return;
    }
    endHead();
    tokens.back().after = comment;
    if (tokens.front().text == "GNOMON_FN") tokens.erase(tokens.begin());
    if (tokens.empty()) return;
    tokens.front().before = std::move(pending_);
    pending_.clear();
    append(tokens);
  }

  void endHead() {
    if (inHead_ && !head_.empty()) heads_.emplace_back(file_, std::move(head_));
    head_.clear();
    inHead_ = false;
  }

  void readDirective(const std::string& text) {
    std::vector<Token> tokens;
    tokenize(text, tokens);
    if (tokens.empty()) return;
    const std::string& what = tokens[0].text;
    if (what == "line") {
      line_ = std::stoi(tokens.at(1).text) - 1;
      const size_t quote = text.find('"');
      file_ = text.substr(quote + 1, text.rfind('"') - quote - 1);
      inHead_ = line_ == 0;
      return;
    }
    if (what == "ifdef" || what == "ifndef") {
      conditions_.push_back((macros_.contains(tokens.at(1).text)) == (what == "ifdef"));
      return;
    }
    if (what == "else") conditions_.back() = !conditions_.back();
    if (what == "endif") conditions_.pop_back();
    if (what != "define" || !isActive()) return;
    const std::string name = tokens.at(1).text;
    if (kept_.contains(name)) return;
    Macro macro;
    size_t at = 2;
    const size_t place = text.find(name) + name.size();
    if (place < text.size() && text[place] == '(') {
      macro.hasParams = true;
      for (at = 3; tokens.at(at).text != ")"; ++at)
        if (tokens[at].text != ",") macro.params.push_back(tokens[at].text);
      ++at;
    }
    macro.body.assign(tokens.begin() + static_cast<std::ptrdiff_t>(at), tokens.end());
    macros_[name] = macro;
  }

  // A macro's call may go on over lines: tokens wait until it ends.
  void append(std::vector<Token>& tokens) {
    for (Token& token : tokens) waiting_.push_back(std::move(token));
    size_t used = 0;
    while (used < waiting_.size() && expand(waiting_, used, out_)) {
    }
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(used));
  }

  // One token, or one macro's call. False where the call does not end yet.
  bool expand(const std::vector<Token>& from, size_t& at, std::vector<Token>& to) {
    const Token& token = from[at];
    const auto found = macros_.find(token.text);
    if (found == macros_.end() || (found->second.hasParams && at + 1 < from.size() && from[at + 1].text != "(")) {
      to.push_back(token);
      ++at;
      return true;
    }
    const Macro& macro = found->second;
    std::vector<std::vector<Token>> args;
    size_t end = at + 1;
    if (macro.hasParams) {
      if (end >= from.size()) return false;
      args.emplace_back();
      int depth = 0;
      for (;; ++end) {
        if (end >= from.size()) return false;
        const std::string& text = from[end].text;
        if (text == "(" && depth++ == 0) continue;
        if (text == ")" && --depth == 0) break;
        if (text == "," && depth == 1 && macro.params.size() > 1) {
          args.emplace_back();
          continue;
        }
        args.back().push_back(from[end]);
      }
      ++end;
    }
    std::vector<Token> replaced;
    for (const Token& part : macro.body) {
      const auto param = std::ranges::find(macro.params, part.text);
      if (param == macro.params.end()) {
        replaced.push_back(part);
        replaced.back().file = token.file;
        replaced.back().line = token.line;
        continue;
      }
      const auto& arg = args[static_cast<size_t>(param - macro.params.begin())];
      replaced.insert(replaced.end(), arg.begin(), arg.end());
    }
    if (!replaced.empty()) {
      replaced.front().before.insert(replaced.front().before.begin(), token.before.begin(), token.before.end());
      if (replaced.back().after.empty()) replaced.back().after = from[end - 1].after;
    }
    at = end;
    std::vector<Token> expanded;
    for (size_t i = 0; i < replaced.size();)
      if (!expand(replaced, i, expanded))
        throw WorldError(fmt::format("{}:{}: the call of macro {} does not end", token.file, token.line, token.text));
    to.insert(to.end(), expanded.begin(), expanded.end());
    return true;
  }

  std::map<std::string, Macro> macros_;
  std::set<std::string> kept_;  // that a #define does not replace
  std::vector<bool> conditions_;
  std::vector<Token> out_, waiting_;
  std::vector<std::string> pending_, head_;
  std::vector<std::pair<std::string, std::vector<std::string>>> heads_;
  bool inHead_ = false;
  std::string file_;
  int line_ = 1;
};

class Parser {
 public:
  explicit Parser(std::vector<Token> tokens) : tokens_(std::move(tokens)) {}

  std::vector<Decl> parse() {
    std::vector<Decl> decls;
    while (at_ < tokens_.size()) {
      if (is(";")) {
        ++at_;
      } else if (is("layout") || is("uniform") || is("buffer")) {
        skipBound(decls);
      } else if (is("struct")) {
        decls.push_back(parseStruct());
      } else if (is("const")) {
        decls.push_back(parseConstant());
      } else {
        decls.push_back(parseFunction());
      }
    }
    return decls;
  }

 private:
  bool is(const char* text, size_t ahead = 0) const {
    return at_ + ahead < tokens_.size() && tokens_[at_ + ahead].text == text;
  }
  [[noreturn]] void fail(const std::string& wanted) const {
    const Token& token = tokens_[std::min(at_, tokens_.size() - 1)];
    throw WorldError(fmt::format(
        "{}:{}: '{}' is not understood here, {} was expected: export reads the dialect of docs/shared_glsl.md",
        token.file, token.line, token.text, wanted));
  }
  const Token& take() {
    if (at_ >= tokens_.size()) fail("more");
    return tokens_[at_++];
  }
  // Comments within what is parsed gather until a statement takes them.
  std::string takeText() {
    const Token& token = take();
    inner_.insert(inner_.end(), token.before.begin(), token.before.end());
    if (!token.after.empty()) last_ = token.after;
    return token.text;
  }
  void want(const char* text) {
    if (!is(text)) fail(fmt::format("'{}'", text));
    takeText();
  }
  std::string wantName() {
    if (at_ >= tokens_.size() || !tokens_[at_].isName()) fail("a name");
    return takeText();
  }

  void skipBound(std::vector<Decl>& decls) {
    if (is("layout") && is("constant_id", 2)) {
      while (!is("const")) ++at_;
      decls.push_back(parseConstant());
      return;
    }
    int depth = 0;
    for (; at_ < tokens_.size(); ++at_) {
      if (is("{") || is("(")) ++depth;
      if (is("}") || is(")")) --depth;
      if (is(";") && depth == 0) break;
    }
    want(";");
    inner_.clear();
    last_.clear();
  }

  template <typename T>
  void takeComments(T& to) {
    to.comments.insert(to.comments.begin(), inner_.begin(), inner_.end());
    to.trailing = last_;
    inner_.clear();
    last_.clear();
  }

  Decl begin(Decl::Kind kind) {
    inner_.clear();
    last_.clear();
    Decl decl;
    decl.kind = kind;
    decl.file = tokens_[at_].file;
    return decl;
  }

  Decl parseStruct() {
    Decl decl = begin(Decl::Kind::Struct);
    want("struct");
    decl.name = wantName();
    want("{");
    takeComments(decl);
    while (!is("}")) decl.members.push_back(parseDeclaration());
    want("}");
    if (is(";")) want(";");
    inner_.clear();
    last_.clear();
    types_.insert(decl.name);
    return decl;
  }

  Decl parseConstant() {
    Decl decl = begin(Decl::Kind::Constant);
    want("const");
    decl.type = wantName();
    decl.name = wantName();
    want("=");
    decl.value = parseTernary();
    want(";");
    takeComments(decl);
    return decl;
  }

  Decl parseFunction() {
    Decl decl = begin(Decl::Kind::Function);
    decl.type = wantName();
    decl.name = wantName();
    want("(");
    while (!is(")")) {
      Param param;
      if (is("out") || is("inout")) param.qualifier = takeText();
      param.type = wantName();
      param.name = wantName();
      decl.params.push_back(param);
      if (!is(")")) want(",");
    }
    want(")");
    if (is(";")) {
      want(";");
      takeComments(decl);
      return decl;
    }
    decl.hasBody = true;
    want("{");
    takeComments(decl);
    // A comment behind the brace is of what follows.
    if (!decl.trailing.empty()) {
      decl.comments.push_back(decl.trailing);
      decl.trailing.clear();
    }
    decl.body = parseUntilBrace();
    inner_.clear();
    last_.clear();
    return decl;
  }

  std::vector<Stmt> parseUntilBrace() {
    std::vector<Stmt> body;
    while (!is("}")) body.push_back(parseStmt());
    take();
    return body;
  }

  // One statement, or those of a block.
  std::vector<Stmt> parseBody() {
    if (is("{")) {
      take();
      return parseUntilBrace();
    }
    return {parseStmt()};
  }

  bool startsDeclaration() const {
    if (is("const") || is("precise")) return true;
    return at_ + 1 < tokens_.size() && tokens_[at_].isName() && tokens_[at_ + 1].isName() && !is("return") &&
           !is("else");
  }

  Stmt parseDeclaration() {
    Stmt stmt;
    stmt.kind = Stmt::Kind::Declaration;
    while (is("const") || is("precise")) stmt.qualifiers.push_back(takeText());
    stmt.type = wantName();
    for (;;) {
      Declarator declarator;
      declarator.name = wantName();
      if (is("[")) {
        want("[");
        declarator.count = parseTernary();
        want("]");
      }
      if (is("=")) {
        want("=");
        declarator.value = parseTernary();
      }
      stmt.names.push_back(std::move(declarator));
      if (is(";")) break;
      want(",");
    }
    want(";");
    takeComments(stmt);
    return stmt;
  }

  Stmt parseStmt() {
    Stmt stmt;
    if (is("{")) {
      stmt.kind = Stmt::Kind::Block;
      stmt.body = parseBody();
      return stmt;
    }
    if (is("if") || is("while") || is("for") || is("switch")) return parseControl();
    if (is("break") || is("continue")) {
      stmt.kind = is("break") ? Stmt::Kind::Break : Stmt::Kind::Continue;
      takeText();
    } else if (is("return")) {
      stmt.kind = Stmt::Kind::Return;
      takeText();
      if (!is(";")) stmt.expr = parseExpr();
    } else if (startsDeclaration()) {
      return parseDeclaration();
    } else {
      stmt.expr = parseExpr();
    }
    want(";");
    takeComments(stmt);
    return stmt;
  }

  Stmt parseControl() {
    Stmt stmt;
    const std::string word = takeText();
    want("(");
    if (word == "for") {
      stmt.kind = Stmt::Kind::For;
      if (is(";"))
        want(";");
      else
        stmt.other.push_back(parseStmt());
      if (!is(";")) stmt.expr = parseExpr();
      want(";");
      if (!is(")")) stmt.step = parseExpr();
    } else {
      stmt.kind = word == "if" ? Stmt::Kind::If : word == "while" ? Stmt::Kind::While : Stmt::Kind::Switch;
      stmt.expr = parseExpr();
    }
    want(")");
    takeComments(stmt);
    if (!stmt.trailing.empty()) stmt.comments.push_back(stmt.trailing);
    stmt.trailing.clear();
    if (word == "switch") {
      parseCases(stmt);
      return stmt;
    }
    stmt.body = parseBody();
    if (word == "if" && is("else")) {
      take();
      stmt.other = parseBody();
    }
    return stmt;
  }

  void parseCases(Stmt& stmt) {
    want("{");
    while (!is("}")) {
      Stmt::Case one;
      while (is("case") || is("default")) {
        if (takeText() == "case") one.labels.push_back(parseTernary());
        want(":");
      }
      while (!is("case") && !is("default") && !is("}")) {
        const bool block = is("{");
        for (Stmt& inner : block ? parseBody() : std::vector<Stmt>{parseStmt()}) one.body.push_back(std::move(inner));
      }
      stmt.cases.push_back(std::move(one));
    }
    want("}");
    inner_.clear();
    last_.clear();
  }

  static Expr made(Expr::Kind kind, std::string text, std::vector<Expr> kids) {
    Expr expr;
    expr.kind = kind;
    expr.text = std::move(text);
    expr.kids = std::move(kids);
    return expr;
  }

  Expr parseExpr() {
    Expr left = parseTernary();
    Expr probe = made(Expr::Kind::Binary, at_ < tokens_.size() ? tokens_[at_].text : "", {});
    if (!probe.isAssignment()) return left;
    const std::string text = takeText();
    return made(Expr::Kind::Binary, text, {std::move(left), parseExpr()});
  }

  Expr parseTernary() {
    Expr condition = parseBinary(0);
    if (!is("?")) return condition;
    want("?");
    Expr yes = parseTernary();
    want(":");
    Expr no = parseTernary();
    return made(Expr::Kind::Ternary, "?", {std::move(condition), std::move(yes), std::move(no)});
  }

  // How tightly a binary operator binds; 0: none.
  static int binding(const std::string& text) {
    static const std::map<std::string, int> kBinding = {
        {"||", 1}, {"&&", 3}, {"|", 4},  {"^", 5},  {"&", 6},  {"==", 7}, {"!=", 7}, {"<", 8},  {">", 8},
        {"<=", 8}, {">=", 8}, {"<<", 9}, {">>", 9}, {"+", 10}, {"-", 10}, {"*", 11}, {"/", 11}, {"%", 11}};
    const auto found = kBinding.find(text);
    return found == kBinding.end() ? 0 : found->second;
  }

  Expr parseBinary(int least) {
    Expr left = parseUnary();
    while (at_ < tokens_.size()) {
      const int tight = binding(tokens_[at_].text);
      if (tight == 0 || tight <= least) break;
      const std::string text = takeText();
      left = made(Expr::Kind::Binary, text, {std::move(left), parseBinary(tight)});
    }
    return left;
  }

  Expr parseUnary() {
    for (const char* prefix : {"-", "+", "!", "~", "++", "--"}) {
      if (!is(prefix)) continue;
      takeText();
      return made(Expr::Kind::Prefix, prefix, {parseUnary()});
    }
    return parsePostfix();
  }

  Expr parsePostfix() {
    Expr expr;
    if (is("(")) {
      want("(");
      expr = made(Expr::Kind::Paren, "", {parseExpr()});
      want(")");
      if (expr.kids[0].kind == Expr::Kind::Atom) expr = Expr(expr.kids[0]);
    } else {
      if (at_ >= tokens_.size() || (!isWordLetter(tokens_[at_].text[0]) && tokens_[at_].text[0] != '.'))
        fail("an expression");
      expr = atom(takeText());
    }
    for (;;) {
      if (is("(") && expr.kind == Expr::Kind::Atom) {
        expr.kind = Expr::Kind::Call;
        want("(");
        while (!is(")")) {
          expr.kids.push_back(parseTernary());
          if (!is(")")) want(",");
        }
        want(")");
      } else if (is("[")) {
        want("[");
        expr = made(Expr::Kind::Index, "", {std::move(expr), parseTernary()});
        want("]");
      } else if (is(".")) {
        want(".");
        expr = made(Expr::Kind::Member, wantName(), {std::move(expr)});
      } else if (is("++") || is("--")) {
        expr = made(Expr::Kind::Postfix, takeText(), {std::move(expr)});
      } else {
        return expr;
      }
    }
  }

  std::vector<Token> tokens_;
  size_t at_ = 0;
  std::set<std::string> types_;
  std::vector<std::string> inner_;
  std::string last_;
};

}  // namespace

Program readGlsl(const gpu::ShaderSource& source, const ReadOptions& options) {
  Preprocessor preprocessor(options);
  std::vector<Token> tokens = preprocessor.run(gpu::expandShader(source));
  Program program;
  program.heads = preprocessor.takeHeads();
  program.decls = Parser(std::move(tokens)).parse();
  return program;
}

}  // namespace gnomon::code
