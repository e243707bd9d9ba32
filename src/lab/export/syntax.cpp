#include "lab/export/syntax.h"

#include <algorithm>

namespace gnomon::code {

bool Expr::isAssignment() const {
  static const char* const kOperators[] = {"=", "+=", "-=", "*=", "/=", "|=", "&=", "^="};
  return kind == Kind::Binary && std::ranges::find(kOperators, text) != std::end(kOperators);
}

Expr atom(std::string text) {
  Expr expr;
  expr.text = std::move(text);
  return expr;
}

Decl* Program::find(const std::string& name) {
  const auto found = std::ranges::find_if(decls, [&](const Decl& decl) { return decl.name == name; });
  return found == decls.end() ? nullptr : &*found;
}

const Decl* Program::find(const std::string& name) const {
  return const_cast<Program*>(this)->find(name);
}

}  // namespace gnomon::code
