#include "lab/export/expressions.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <string_view>

namespace gnomon::code {

namespace {

constexpr std::string_view kArray = "[]";

// Of a vector's components.
std::string componentOf(const std::string& vector) {
  switch (vector.empty() ? ' ' : vector[0]) {
    case 'i':
      return "int";
    case 'u':
      return "uint";
    case 'b':
      return "bool";
    case 'd':
      return "double";
    default:
      return "float";
  }
}

// `type`: of what the swizzle is of; where it is not known, it is taken for a vector of floats.
std::string typeOfSwizzle(const std::string& type, const std::string& letters) {
  if (letters.size() > 4 || !(type.empty() || isVector(type))) return "";
  const bool isSwizzle = std::ranges::any_of(std::vector<std::string_view>{"xyzw", "rgba", "stpq"}, [&](auto set) {
    return letters.find_first_not_of(set) == std::string::npos;
  });
  if (!isSwizzle) return "";
  if (letters.size() == 1) return componentOf(type);
  const std::string stem = type.empty() ? "vec" : type.substr(0, type.size() - 1);
  return stem + std::to_string(letters.size());
}

// Of an operator, or of a function whose result is as large as its largest argument.
std::string largest(const std::vector<std::string>& types) {
  const auto first = [&](const auto& isIt) {
    const auto found = std::ranges::find_if(types, isIt);
    return found == types.end() ? std::string() : *found;
  };
  for (const auto& isIt : {isVector, isMatrix})
    if (const std::string type = first(isIt); !type.empty()) return type;
  for (const char* scalar : {"double", "float", "uint"})
    if (std::ranges::find(types, scalar) != types.end()) return scalar;
  return types.empty() ? "" : types.front();
}

class Types {
 public:
  Types(const Variables& variables, const Program& program, ExprTypes* known)
      : variables_(variables), program_(program), known_(known) {}

  std::string of(const Expr& e) const {
    if (known_ == nullptr) return compute(e);
    if (const auto found = known_->find(&e); found != known_->end()) return found->second;
    const std::string type = compute(e);
    known_->emplace(&e, type);
    return type;
  }

 private:
  std::string compute(const Expr& e) const {
    switch (e.kind) {
      case Expr::Kind::Atom:
        return ofAtom(e.text);
      case Expr::Kind::Member:
        return ofMember(of(e.kids[0]), e.text);
      case Expr::Kind::Index:
        return ofElement(of(e.kids[0]));
      case Expr::Kind::Call:
        return ofCall(e);
      case Expr::Kind::Prefix:
        return e.text == "!" ? "bool" : of(e.kids[0]);
      case Expr::Kind::Postfix:
      case Expr::Kind::Paren:
        return of(e.kids[0]);
      case Expr::Kind::Binary:
        return ofBinary(e);
      case Expr::Kind::Ternary:
        return largest({of(e.kids[1]), of(e.kids[2])});
    }
    return "";
  }

  std::string ofAtom(const std::string& text) const {
    if (isNumber(atom(text))) {
      const bool isHexadecimal = text.starts_with("0x") || text.starts_with("0X");
      if (text.ends_with("lf") || text.ends_with("LF")) return "double";
      if (text.ends_with('u') || text.ends_with('U')) return "uint";
      return isHexadecimal || text.find_first_of(".eEfF") == std::string::npos ? "int" : "float";
    }
    if (text == "true" || text == "false") return "bool";
    if (const std::string* type = variables_.typeOf(text)) return *type;
    const Decl* decl = program_.find(text);
    return decl != nullptr && decl->kind == Decl::Kind::Constant ? decl->type : "";
  }

  std::string ofMember(const std::string& type, const std::string& name) const {
    if (const std::string swizzle = typeOfSwizzle(type, name); !swizzle.empty()) return swizzle;
    // Of what is not known, as a buffer's members are not, that of any structure's member of the name.
    for (const Decl& decl : program_.decls)
      if (type.empty() || decl.name == type)
        for (const Stmt& member : decl.members)
          for (const Declarator& declared : member.names)
            if (declared.name == name) return member.type + std::string(declared.count ? kArray : "");
    return "";
  }

  static std::string ofElement(const std::string& type) {
    if (type.ends_with(kArray)) return type.substr(0, type.size() - kArray.size());
    if (isMatrix(type)) return (type[0] == 'd' ? "dvec" : "vec") + type.substr(type.size() - 1);
    return isVector(type) ? componentOf(type) : "";
  }

  std::string ofCall(const Expr& e) const {
    static const std::set<std::string> toNumber = {"dot", "length", "distance", "determinant"};
    if (isScalar(e.text) || isVector(e.text) || isMatrix(e.text)) return e.text;
    if (const Decl* decl = program_.find(e.text)) return decl->kind == Decl::Kind::Struct ? decl->name : decl->type;
    if (toNumber.contains(e.text)) return "float";
    if (e.text == "all" || e.text == "any") return "bool";
    std::vector<std::string> types;
    for (const Expr& kid : e.kids) types.push_back(of(kid));
    return ofOtherKind(e.text, largest(types));
  }

  // Of uintBitsToFloat, isnan and such: as many of another kind.
  static std::string ofOtherKind(const std::string& function, const std::string& type) {
    const int count = componentCount(type);
    if (function == "isnan" || function == "isinf") return count == 0 ? "bool" : "bvec" + std::to_string(count);
    const bool toFloat = function == "uintBitsToFloat" || function == "intBitsToFloat";
    const bool toUint = function == "floatBitsToUint";
    if (!toFloat && !toUint && function != "floatBitsToInt" && function != "findLSB") return type;
    if (count == 0) return toFloat ? "float" : toUint ? "uint" : "int";
    return (toFloat ? "vec" : toUint ? "uvec" : "ivec") + std::to_string(count);
  }

  std::string ofBinary(const Expr& e) const {
    static const std::set<std::string> toBool = {"==", "!=", "<", ">", "<=", ">=", "&&", "||"};
    if (toBool.contains(e.text)) return "bool";
    if (e.isAssignment() || e.text == "<<" || e.text == ">>") return of(e.kids[0]);
    return largest({of(e.kids[0]), of(e.kids[1])});
  }

  const Variables& variables_;
  const Program& program_;
  ExprTypes* known_;
};

class Walk {
 public:
  explicit Walk(const std::function<void(const Expr&, const Variables&)>& visit) : visit_(visit) {}

  void through(const Decl& decl) {
    for (const Param& param : decl.params) variables_.add(param.name, param.type);
    expr(decl.value);
    for (const Stmt& member : decl.members)
      for (const Declarator& declared : member.names) expr(declared.count);
    scope(decl.body);
  }

 private:
  void expr(const Expr& e) {
    visit_(e, variables_);
    for (const Expr& kid : e.kids) expr(kid);
  }
  void expr(const std::optional<Expr>& e) {
    if (e) expr(*e);
  }

  void scope(const std::vector<Stmt>& body) {
    const size_t outside = variables_.count();
    statements(body);
    variables_.dropFrom(outside);
  }

  void statements(const std::vector<Stmt>& body) {
    for (const Stmt& stmt : body) statement(stmt);
  }

  void statement(const Stmt& stmt) {
    for (const Declarator& declared : stmt.names) {
      expr(declared.count);
      expr(declared.value);
      variables_.add(declared.name, stmt.type + std::string(declared.count ? kArray : ""));
    }
    const size_t outside = variables_.count();
    const bool isLoop = stmt.kind == Stmt::Kind::For;
    if (isLoop) statements(stmt.other);
    expr(stmt.expr);
    expr(stmt.step);
    scope(stmt.body);
    if (!isLoop) scope(stmt.other);
    for (const Stmt::Case& one : stmt.cases) {
      for (const Expr& label : one.labels) expr(label);
      statements(one.body);
    }
    variables_.dropFrom(outside);
  }

  const std::function<void(const Expr&, const Variables&)>& visit_;
  Variables variables_;
};

}  // namespace

const std::string* Variables::typeOf(const std::string& name) const {
  const auto found = types_.find(name);
  return found == types_.end() ? nullptr : &found->second.back();
}

void Variables::add(const std::string& name, const std::string& type) {
  names_.push_back(name);
  types_[name].push_back(type);
}

void Variables::dropFrom(size_t count) {
  for (; names_.size() > count; names_.pop_back()) {
    const auto last = types_.find(names_.back());
    last->second.pop_back();
    if (last->second.empty()) types_.erase(last);
  }
}

std::string typeOf(const Expr& expr, const Variables& variables, const Program& program, ExprTypes* known) {
  return Types(variables, program, known).of(expr);
}

bool isScalar(const std::string& type) {
  return type == "float" || type == "int" || type == "uint" || type == "bool" || type == "double";
}

bool isVector(const std::string& type) {
  return componentCount(type) > 0;
}

bool isMatrix(const std::string& type) {
  const size_t at = type.starts_with("dmat") ? 4 : type.starts_with("mat") ? 3 : 0;
  return at > 0 && type.size() > at && type.find_first_not_of("234x", at) == std::string::npos;
}

int componentCount(const std::string& type) {
  for (const char* stem : {"vec", "ivec", "uvec", "bvec", "dvec"}) {
    const size_t length = std::string_view(stem).size();
    if (type.size() == length + 1 && type.starts_with(stem) && type[length] >= '2' && type[length] <= '4')
      return type[length] - '0';
  }
  return 0;
}

bool isNumber(const Expr& expr) {
  if (expr.kind == Expr::Kind::Prefix) return (expr.text == "-" || expr.text == "+") && isNumber(expr.kids[0]);
  if (expr.kind != Expr::Kind::Atom || expr.text.empty()) return false;
  return std::isdigit(static_cast<unsigned char>(expr.text[0])) != 0 || expr.text[0] == '.';
}

bool writesVariable(const Expr& expr, const Program& program) {
  const bool counts = expr.kind == Expr::Kind::Prefix || expr.kind == Expr::Kind::Postfix;
  if (expr.isAssignment() || (counts && (expr.text == "++" || expr.text == "--"))) return true;
  const Decl* called = expr.kind == Expr::Kind::Call ? program.find(expr.text) : nullptr;
  if (called != nullptr &&
      std::ranges::any_of(called->params, [](const Param& param) { return !param.qualifier.empty(); }))
    return true;
  return std::ranges::any_of(expr.kids, [&](const Expr& kid) { return writesVariable(kid, program); });
}

void eachExprAndItsVariables(const Decl& decl, const std::function<void(const Expr&, const Variables&)>& visit) {
  Walk(visit).through(decl);
}

}  // namespace gnomon::code
