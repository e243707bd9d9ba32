#pragma once
// Shaders as trees, in the dialect of shaders/shared/ (docs/shared_glsl.md) and a little beyond: what is read
// (read_glsl.h), simplified (simplify.h) and printed in other languages (print_code.h). Comments stay with what they
// precede.

#include <optional>
#include <string>
#include <vector>

namespace gnomon::code {

struct Expr {
  enum class Kind {
    Atom,     // text: a name or a number
    Member,   // kids[0] . text
    Index,    // kids[0] [ kids[1] ]
    Call,     // text ( kids )
    Prefix,   // text kids[0]
    Postfix,  // kids[0] text
    Binary,   // kids[0] text kids[1]; assignments, too
    Ternary,  // kids[0] ? kids[1] : kids[2]
    Paren,    // ( kids[0] )
  };
  Kind kind = Kind::Atom;
  std::string text;
  std::vector<Expr> kids;
  int line = 0;  // of its file, where its operator, name or number stands; 0: made here

  bool isAtom(const std::string& name) const { return kind == Kind::Atom && text == name; }
  bool isAssignment() const;  // "=", "+=" and so on
};

Expr atom(std::string text);

struct Declarator {
  std::string name;
  std::optional<Expr> count;  // of an array
  std::optional<Expr> value;
};

struct Stmt {
  enum class Kind { Expression, Declaration, Return, If, Switch, For, While, Block, Break, Continue };
  Kind kind = Kind::Expression;
  std::vector<std::string> comments;  // lines before it, without "//"
  std::string trailing;               // comment behind it
  // Of a declaration: "precise", "const"; type; names.
  std::vector<std::string> qualifiers;
  std::string type;
  std::vector<Declarator> names;
  std::optional<Expr> expr;       // the expression, value or condition
  std::vector<Stmt> body, other;  // `other`: of else; of a loop its first statement
  std::optional<Expr> step;       // of a loop
  struct Case {
    std::vector<Expr> labels;  // none: default
    std::vector<Stmt> body;
    int line = 0;  // of its last label
  };
  std::vector<Case> cases;
};

struct Param {
  std::string qualifier;  // "", "out", "inout"
  std::string type;
  std::string name;
};

struct Decl {
  enum class Kind { Struct, Constant, Function };
  Kind kind = Kind::Function;
  std::string file;  // "shared/map.glsl"
  std::string name;
  std::string type;  // of a constant, or what a function returns
  std::vector<std::string> comments;
  std::string trailing;
  std::vector<Stmt> members;  // of a struct: declarations
  std::optional<Expr> value;  // of a constant
  std::vector<Param> params;
  bool hasBody = false;
  std::vector<Stmt> body;
};

struct Program {
  std::vector<Decl> decls;
  // The comment at the head of each file, line by line.
  std::vector<std::pair<std::string, std::vector<std::string>>> heads;

  Decl* find(const std::string& name);
  const Decl* find(const std::string& name) const;
};

// Calls `visit` for each expression of a statement, those within others after what they are in.
template <typename Visit>
void eachExpr(Expr& expr, const Visit& visit) {
  visit(expr);
  for (Expr& kid : expr.kids) eachExpr(kid, visit);
}
template <typename Stmts, typename Visit>  // std::vector<Stmt>, const or not
void eachStmt(Stmts& body, const Visit& visit) {
  for (auto& stmt : body) {
    visit(stmt);
    eachStmt(stmt.other, visit);
    eachStmt(stmt.body, visit);
    for (auto& one : stmt.cases) eachStmt(one.body, visit);
  }
}
template <typename Visit>
void eachExpr(std::vector<Stmt>& body, const Visit& visit) {
  eachStmt(body, [&](Stmt& stmt) {
    for (Declarator& name : stmt.names) {
      if (name.count) eachExpr(*name.count, visit);
      if (name.value) eachExpr(*name.value, visit);
    }
    if (stmt.expr) eachExpr(*stmt.expr, visit);
    if (stmt.step) eachExpr(*stmt.step, visit);
    for (Stmt::Case& one : stmt.cases)
      for (Expr& label : one.labels) eachExpr(label, visit);
  });
}
template <typename Visit>
void eachExpr(Decl& decl, const Visit& visit) {
  eachExpr(decl.members, visit);
  if (decl.value) eachExpr(*decl.value, visit);
  eachExpr(decl.body, visit);
}

}  // namespace gnomon::code
