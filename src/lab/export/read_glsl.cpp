#include "lab/export/read_glsl.h"

#include "base/error.h"
#include "gpu/glsl_words.h"
#include "lab/export/preprocess_glsl.h"

#include <algorithm>
#include <cctype>
#include <iterator>

#include <fmt/format.h>

namespace gnomon::code {

namespace {

// Deeper trees exhaust the stack of what goes through them.
constexpr int kMostLevels = 1000;
constexpr int kMostOperators = 1000;  // of a statement: in a chain each is a level, too

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
  // Of what a reader knows by its name. `remedy`: what to write.
  [[noreturn]] void failConstruct(const std::string& name, const std::string& remedy) const {
    const Token& token = tokens_[std::min(at_, tokens_.size() - 1)];
    throw WorldError(fmt::format("{}:{}: export does not read {}; {}", token.file, token.line, name, remedy));
  }
  [[noreturn]] void failArray() const {
    failConstruct("arrays of constants", "write a function with a switch, or an array whose elements are assigned");
  }
  [[noreturn]] void failDeep() const {
    const Token& token = tokens_[std::min(at_, tokens_.size() - 1)];
    throw WorldError(fmt::format(
        "{}:{}: this is more than {} levels deep or operators long; write it as several functions or variables",
        token.file, token.line, kMostLevels));
  }
  void countOperator() {
    if (++operators_ > kMostOperators) failDeep();
  }
  // Counts what is within what, as long as it is parsed.
  class Level {
   public:
    explicit Level(Parser& parser) : levels_(parser.levels_) {
      if (levels_ >= kMostLevels) parser.failDeep();
      ++levels_;
    }
    ~Level() { --levels_; }
    Level(const Level&) = delete;
    Level& operator=(const Level&) = delete;

   private:
    int& levels_;
  };

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
      while (at_ < tokens_.size() && !is("const") && !is(";")) ++at_;
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
    operators_ = 0;
    want("const");
    decl.type = wantName();
    if (is("[")) failArray();
    decl.name = wantName();
    if (is("[")) failArray();
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
      while (is("in") || is("const")) takeText();
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

  // An empty statement is nothing; the comment behind it is of the last.
  void parseInto(std::vector<Stmt>& body) {
    if (!is(";")) return body.push_back(parseStmt());
    const std::string& trailing = take().after;
    if (!body.empty() && body.back().trailing.empty()) body.back().trailing = trailing;
  }

  std::vector<Stmt> parseUntilBrace() {
    std::vector<Stmt> body;
    while (!is("}")) parseInto(body);
    take();
    return body;
  }

  // One statement, or those of a block.
  std::vector<Stmt> parseBody() {
    if (is("{")) {
      take();
      return parseUntilBrace();
    }
    std::vector<Stmt> body;
    parseInto(body);
    return body;
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
    if (is("[")) failArray();
    for (;;) {
      Declarator declarator;
      declarator.name = wantName();
      if (is("[")) {
        want("[");
        if (is("]")) failArray();  // its values count it
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
    const Level level(*this);
    operators_ = 0;
    Stmt stmt;
    if (is("{")) {
      stmt.kind = Stmt::Kind::Block;
      stmt.body = parseBody();
      return stmt;
    }
    if (is("do")) failConstruct("do-while loops", "write a for or a while");
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
      bool isDefault = false;
      while (is("case") || is("default")) {
        one.line = lineHere();
        if (takeText() == "case")
          one.labels.push_back(parseTernary());
        else
          isDefault = true;
        want(":");
      }
      if (isDefault) one.labels.clear();
      while (!is("case") && !is("default") && !is("}")) parseInto(one.body);
      openBlock(one.body);
      stmt.cases.push_back(std::move(one));
    }
    if (!stmt.cases.empty() && stmt.cases.back().body.empty()) stmt.cases.back().body.push_back(breakStmt());
    want("}");
    inner_.clear();
    last_.clear();
  }

  // Of a last case of empty statements: a label has to have one.
  static Stmt breakStmt() {
    Stmt stmt;
    stmt.kind = Stmt::Kind::Break;
    return stmt;
  }

  // Of a case: its braces go where all but a break is within them.
  static void openBlock(std::vector<Stmt>& body) {
    const bool isAll = body.size() == 1 || (body.size() == 2 && body[1].kind == Stmt::Kind::Break);
    if (!isAll || body[0].kind != Stmt::Kind::Block) return;
    std::vector<Stmt> within = std::move(body[0].body);
    body.erase(body.begin());
    body.insert(body.begin(), std::make_move_iterator(within.begin()), std::make_move_iterator(within.end()));
  }

  static Expr made(Expr::Kind kind, std::string text, std::vector<Expr> kids, int line) {
    Expr expr;
    expr.kind = kind;
    expr.text = std::move(text);
    expr.kids = std::move(kids);
    expr.line = line;
    return expr;
  }

  // Of the next token.
  int lineHere() const { return at_ < tokens_.size() ? tokens_[at_].line : 0; }

  Expr parseExpr() {
    const Level level(*this);
    Expr left = parseTernary();
    Expr probe = made(Expr::Kind::Binary, at_ < tokens_.size() ? tokens_[at_].text : "", {}, lineHere());
    if (!probe.isAssignment()) return left;
    takeText();
    return made(Expr::Kind::Binary, probe.text, {std::move(left), parseExpr()}, probe.line);
  }

  Expr parseTernary() {
    const Level level(*this);
    Expr condition = parseBinary(0);
    if (!is("?")) return condition;
    const int line = lineHere();
    want("?");
    Expr yes = parseTernary();
    want(":");
    Expr no = parseTernary();
    return made(Expr::Kind::Ternary, "?", {std::move(condition), std::move(yes), std::move(no)}, line);
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
      countOperator();
      const int line = lineHere();
      const std::string text = takeText();
      left = made(Expr::Kind::Binary, text, {std::move(left), parseBinary(tight)}, line);
    }
    return left;
  }

  Expr parseUnary() {
    const Level level(*this);
    for (const char* prefix : {"-", "+", "!", "~", "++", "--"}) {
      if (!is(prefix)) continue;
      const int line = lineHere();
      takeText();
      return made(Expr::Kind::Prefix, prefix, {parseUnary()}, line);
    }
    return parsePostfix();
  }

  Expr parsePostfix() {
    Expr expr;
    const int begun = lineHere();
    if (is("(")) {
      want("(");
      expr = made(Expr::Kind::Paren, "", {parseExpr()}, begun);
      want(")");
      if (expr.kids[0].kind == Expr::Kind::Atom) expr = Expr(expr.kids[0]);
    } else {
      if (at_ >= tokens_.size() || (!gpu::isWordLetter(tokens_[at_].text[0]) && tokens_[at_].text[0] != '.'))
        is("{") ? failConstruct("values in braces", "assign each member or element") : fail("an expression");
      expr = made(Expr::Kind::Atom, takeText(), {}, begun);
    }
    for (;; countOperator()) {
      const int line = lineHere();
      if (is("(") && expr.kind == Expr::Kind::Atom) {
        expr.kind = Expr::Kind::Call;
        want("(");
        while (!is(")")) {
          expr.kids.push_back(parseTernary());
          if (!is(")")) want(",");
        }
        want(")");
      } else if (is("[")) {
        if (is("]", 1)) failArray();  // float[](...)
        want("[");
        expr = made(Expr::Kind::Index, "", {std::move(expr), parseTernary()}, line);
        want("]");
        if (is("(")) failArray();  // float[3](...)
      } else if (is(".")) {
        want(".");
        expr = made(Expr::Kind::Member, wantName(), {std::move(expr)}, line);
      } else if (is("++") || is("--")) {
        expr = made(Expr::Kind::Postfix, takeText(), {std::move(expr)}, line);
      } else {
        return expr;
      }
    }
  }

  std::vector<Token> tokens_;
  size_t at_ = 0;
  int levels_ = 0;
  int operators_ = 0;
  std::set<std::string> types_;
  std::vector<std::string> inner_;
  std::string last_;
};

}  // namespace

Program readGlsl(const gpu::ShaderSource& source, const ReadOptions& options) {
  Tokens read = preprocessGlsl(gpu::expandShader(source), options);
  Program program;
  program.heads = std::move(read.heads);
  program.decls = Parser(std::move(read.tokens)).parse();
  return program;
}

}  // namespace gnomon::code
