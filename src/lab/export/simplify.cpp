#include "lab/export/simplify.h"

#include "base/check.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace gnomon::code {

namespace {

// "a.b" of names and members, "params.knobs[kOffset]" of an index by a name; empty for other expressions.
std::string pathOf(const Expr& expr) {
  if (expr.kind == Expr::Kind::Atom) return expr.text;
  if (expr.kind == Expr::Kind::Member) {
    const std::string object = pathOf(expr.kids[0]);
    return object.empty() ? "" : object + "." + expr.text;
  }
  if (expr.kind == Expr::Kind::Index && expr.kids[1].kind == Expr::Kind::Atom) {
    const std::string object = pathOf(expr.kids[0]);
    return object.empty() ? "" : object + "[" + expr.kids[1].text + "]";
  }
  return "";
}

// The variable that an assignment's left side is of.
const Expr& rootOf(const Expr& expr) {
  const Expr* at = &expr;
  while (at->kind == Expr::Kind::Member || at->kind == Expr::Kind::Index) at = &at->kids[0];
  return *at;
}

std::optional<double> numberOf(const std::string& text) {
  if (text == "true") return 1.0;
  if (text == "false") return 0.0;
  if (text.empty() || (std::isdigit(static_cast<unsigned char>(text[0])) == 0 && text[0] != '.')) return std::nullopt;
  if (text.starts_with("0x")) return static_cast<double>(std::stoull(text, nullptr, 16));
  return std::stod(text);
}

class Simplifier {
 public:
  Simplifier(Program& program, const Known& known) : program_(program), known_(known) {}

  void run() {
    for (Decl& decl : program_.decls)
      if (decl.kind == Decl::Kind::Constant && !isUsers(decl) && !known_.values.contains(decl.name) && decl.value)
        if (const auto value = evaluate(*decl.value)) constants_[decl.name] = *value;
    for (size_t before = 0, now = size(); before != now; before = now, now = size()) {
      for (Decl& decl : program_.decls) {
        if (isUsers(decl)) {
          eachExpr(decl, [&](Expr& expr) { replace(expr), replaceByNumber(expr); });
          continue;
        }
        foldBody(decl.body);
        if (decl.hasBody && decl.body.size() == 1 && decl.body[0].kind == Stmt::Kind::Return && decl.body[0].expr)
          if (const auto value = evaluate(*decl.body[0].expr)) constantFunctions_[decl.name] = *value;
        dropDeadVariables(decl);
      }
      dropForwarders();
      dropUnusedParams();
      dropUnreadMembers();
      dropUnreachable();
    }
  }

 private:
  bool isUsers(const Decl& decl) const { return decl.file == known_.userFile; }

  // Of the program, so that a pass that changes nothing shows.
  size_t size() {
    size_t count = 0;
    for (Decl& decl : program_.decls) {
      count += 1 + decl.params.size() + decl.members.size();
      eachStmt(decl.body, [&](Stmt&) { ++count; });
      eachExpr(decl.body, [&](Expr&) { ++count; });
    }
    return count;
  }

  std::optional<double> evaluate(const Expr& expr) const {
    const std::string path = pathOf(expr);
    if (!path.empty()) {
      if (const auto found = known_.values.find(path); found != known_.values.end()) return found->second;
      if (const auto found = constants_.find(path); found != constants_.end()) return found->second;
      return expr.kind == Expr::Kind::Atom ? numberOf(expr.text) : std::nullopt;
    }
    switch (expr.kind) {
      case Expr::Kind::Paren:
        return evaluate(expr.kids[0]);
      case Expr::Kind::Call:
        if (const auto found = constantFunctions_.find(expr.text); found != constantFunctions_.end())
          return found->second;
        return std::nullopt;
      case Expr::Kind::Prefix: {
        const auto value = evaluate(expr.kids[0]);
        if (!value) return std::nullopt;
        if (expr.text == "!") return *value == 0.0 ? 1.0 : 0.0;
        if (expr.text == "-") return -*value;
        return std::nullopt;
      }
      case Expr::Kind::Binary:
        return evaluateBinary(expr);
      default:
        return std::nullopt;
    }
  }

  std::optional<double> evaluateBinary(const Expr& expr) const {
    const auto a = evaluate(expr.kids[0]), b = evaluate(expr.kids[1]);
    const std::string& op = expr.text;
    if (op == "&&" && ((a && *a == 0.0) || (b && *b == 0.0))) return 0.0;
    if (op == "||" && ((a && *a != 0.0) || (b && *b != 0.0))) return 1.0;
    if (!a || !b) return std::nullopt;
    const auto truth = [](bool value) { return std::optional(value ? 1.0 : 0.0); };
    if (op == "&&" || op == "||") return truth(op == "&&" ? *a != 0.0 && *b != 0.0 : *a != 0.0 || *b != 0.0);
    if (op == "==") return truth(*a == *b);
    if (op == "!=") return truth(*a != *b);
    if (op == "<") return truth(*a < *b);
    if (op == "<=") return truth(*a <= *b);
    if (op == ">") return truth(*a > *b);
    if (op == ">=") return truth(*a >= *b);
    if (op == "&") return static_cast<double>(static_cast<int64_t>(*a) & static_cast<int64_t>(*b));
    if (op == "|") return static_cast<double>(static_cast<int64_t>(*a) | static_cast<int64_t>(*b));
    return std::nullopt;
  }

  void fold(Expr& expr) const {
    for (Expr& kid : expr.kids) fold(kid);
    replace(expr);
    if (expr.kind == Expr::Kind::Ternary) {
      if (const auto value = evaluate(expr.kids[0])) expr = Expr(expr.kids[*value != 0.0 ? 1 : 2]);
    } else if (expr.kind == Expr::Kind::Binary && (expr.text == "&&" || expr.text == "||")) {
      if (const auto whole = evaluate(expr)) {
        expr = atom(*whole != 0.0 ? "true" : "false");
      } else if (evaluate(expr.kids[0])) {
        expr = Expr(expr.kids[1]);
      } else if (evaluate(expr.kids[1])) {
        expr = Expr(expr.kids[0]);
      }
    } else if (expr.kind == Expr::Kind::Binary && (expr.text == "==" || expr.text == "!=")) {
      if (const auto whole = evaluate(expr)) expr = atom(*whole != 0.0 ? "true" : "false");
    } else if (expr.kind == Expr::Kind::Paren &&
               (expr.kids[0].kind == Expr::Kind::Atom || expr.kids[0].kind == Expr::Kind::Member ||
                expr.kids[0].kind == Expr::Kind::Paren)) {
      expr = Expr(expr.kids[0]);
    } else if (expr.kind == Expr::Kind::Call && constantFunctions_.contains(expr.text)) {
      const double value = constantFunctions_.at(expr.text);
      const Decl* decl = program_.find(expr.text);
      if (decl != nullptr && decl->type == "bool") expr = atom(value != 0.0 ? "true" : "false");
    }
  }

  void replace(Expr& expr) const {
    if (const std::string path = pathOf(expr); !path.empty())
      if (const auto found = known_.replacements.find(path); found != known_.replacements.end())
        expr = pathExpr(found->second);
  }

  // Constants and choices that exported code has no names for, all of them whole.
  void replaceByNumber(Expr& expr) const {
    const std::string path = pathOf(expr);
    if (!path.starts_with("k") && !path.starts_with("params.")) return;
    if (const auto found = known_.values.find(path); found != known_.values.end())
      expr = atom(std::to_string(static_cast<int64_t>(found->second)));
  }

  static Expr pathExpr(const std::string& path) {
    const size_t dot = path.rfind('.');
    if (dot == std::string::npos || numberOf(path)) return atom(path);
    Expr expr;
    expr.kind = Expr::Kind::Member;
    expr.text = path.substr(dot + 1);
    expr.kids = {pathExpr(path.substr(0, dot))};
    return expr;
  }

  static bool leaves(const std::vector<Stmt>& body) {
    if (body.empty()) return false;
    const Stmt& last = body.back();
    if (last.kind == Stmt::Kind::If) return !last.other.empty() && leaves(last.body) && leaves(last.other);
    return last.kind == Stmt::Kind::Return || last.kind == Stmt::Kind::Break || last.kind == Stmt::Kind::Continue;
  }

  bool isUnread(const Stmt& stmt) const {
    if (stmt.kind == Stmt::Kind::Declaration)
      return stmt.names.size() == 1 && known_.unread.contains(stmt.names[0].name);
    if (stmt.kind != Stmt::Kind::Expression || !stmt.expr->isAssignment()) return false;
    const Expr& left = stmt.expr->kids[0];
    return known_.unread.contains(rootOf(left).text) || known_.replacements.contains(pathOf(left));
  }

  // "x = x;"
  static bool isIdle(const Stmt& stmt) {
    if (stmt.kind != Stmt::Kind::Expression || stmt.expr->kind != Expr::Kind::Binary || stmt.expr->text != "=")
      return false;
    const Expr& left = stmt.expr->kids[0];
    return left.kind == Expr::Kind::Atom && stmt.expr->kids[1].isAtom(left.text);
  }

  // The comments of a branch that is decided go on to what is left of it, but not to what stands for another branch.
  static void splice(std::vector<Stmt>& out, std::vector<Stmt> body, const Stmt& from, bool keepComments) {
    if (keepComments && !body.empty())
      body.front().comments.insert(body.front().comments.begin(), from.comments.begin(), from.comments.end());
    for (Stmt& stmt : body) out.push_back(std::move(stmt));
  }

  void foldBody(std::vector<Stmt>& body) const {
    std::vector<Stmt> out;
    for (Stmt& stmt : body) {
      if (isUnread(stmt) || isIdle(stmt)) continue;
      for (Declarator& name : stmt.names)
        if (name.value) fold(*name.value);
      if (stmt.expr) fold(*stmt.expr);
      if (stmt.step) fold(*stmt.step);
      foldBody(stmt.other);
      foldBody(stmt.body);
      for (Stmt::Case& one : stmt.cases) {
        for (Expr& label : one.labels) fold(label);
        foldBody(one.body);
      }
      if (stmt.kind == Stmt::Kind::If) {
        if (const auto value = evaluate(*stmt.expr)) {
          splice(out, *value != 0.0 ? std::move(stmt.body) : std::move(stmt.other), stmt, *value != 0.0);
          if (leaves(out)) break;
          continue;
        }
        if (stmt.body.empty() && stmt.other.empty()) continue;
        if (stmt.body.empty()) {
          Expr negated;
          negated.kind = Expr::Kind::Prefix;
          negated.text = "!";
          Expr inner;
          inner.kind = Expr::Kind::Paren;
          inner.kids = {*stmt.expr};
          negated.kids = {stmt.expr->kind == Expr::Kind::Binary || stmt.expr->kind == Expr::Kind::Ternary ? inner
                                                                                                          : *stmt.expr};
          stmt.expr = negated;
          stmt.body = std::move(stmt.other);
          stmt.other.clear();
        }
      }
      if ((stmt.kind == Stmt::Kind::While || stmt.kind == Stmt::Kind::For) && !stmt.body.empty() &&
          stmt.body.back().kind == Stmt::Kind::Continue)
        stmt.body.pop_back();
      if (stmt.kind == Stmt::Kind::While && evaluate(*stmt.expr) == 0.0) continue;
      if (stmt.kind == Stmt::Kind::Switch) {
        if (const auto value = evaluate(*stmt.expr)) {
          splice(out, chosenCase(stmt, *value), stmt, false);
          if (leaves(out)) break;
          continue;
        }
      }
      if (stmt.kind == Stmt::Kind::For && runsOnce(stmt)) {
        splice(out, std::move(stmt.body), stmt, true);
        continue;
      }
      if (!out.empty() && isValueOf(out.back(), stmt)) {
        out.back().names[0].value = Expr(stmt.expr->kids[1]);
        continue;
      }
      out.push_back(std::move(stmt));
      if (leaves({out.back()})) break;
    }
    body = std::move(out);
  }

  // `for (int i = 0; i < 1; ++i)` without a jump; i becomes 0.
  bool runsOnce(Stmt& loop) const {
    if (loop.other.size() != 1 || loop.other[0].kind != Stmt::Kind::Declaration || !loop.expr) return false;
    const Declarator& counter = loop.other[0].names[0];
    if (loop.expr->kind != Expr::Kind::Binary || loop.expr->text != "<" || !loop.expr->kids[0].isAtom(counter.name))
      return false;
    if (!counter.value || evaluate(*counter.value) != 0.0 || evaluate(loop.expr->kids[1]) != 1.0) return false;
    bool jumps = false;
    eachStmt(loop.body,
             [&](Stmt& stmt) { jumps = jumps || stmt.kind == Stmt::Kind::Break || stmt.kind == Stmt::Kind::Continue; });
    if (jumps) return false;
    eachExpr(loop.body, [&](Expr& expr) {
      if (expr.isAtom(counter.name)) expr.text = "0";
    });
    return true;
  }

  // "T x;" and then "x = value;".
  static bool isValueOf(const Stmt& declared, const Stmt& stmt) {
    if (declared.kind != Stmt::Kind::Declaration || declared.names.size() != 1 || declared.names[0].value ||
        declared.names[0].count)
      return false;
    if (stmt.kind != Stmt::Kind::Expression || stmt.expr->kind != Expr::Kind::Binary || stmt.expr->text != "=" ||
        !stmt.comments.empty())
      return false;
    return stmt.expr->kids[0].isAtom(declared.names[0].name);
  }

  // Functions that only call another with the same arguments, or return one of them.
  void dropForwarders() {
    for (Decl& decl : program_.decls) {
      if (isUsers(decl) || std::ranges::find(known_.roots, decl.name) != known_.roots.end()) continue;
      if (decl.body.size() != 1 || decl.body[0].kind != Stmt::Kind::Return || !decl.body[0].expr) continue;
      const Expr& value = *decl.body[0].expr;
      if (value.kind == Expr::Kind::Atom && decl.params.size() == 1 && value.text == decl.params[0].name) {
        replaceCalls(decl.name, [](Expr& call) { call = Expr(call.kids[0]); });
        continue;
      }
      if (value.kind != Expr::Kind::Call || value.kids.size() != decl.params.size()) continue;
      Decl* target = program_.find(value.text);
      if (target == nullptr || target->kind != Decl::Kind::Function) continue;
      bool same = true;
      for (size_t i = 0; i < value.kids.size(); ++i) same = same && value.kids[i].isAtom(decl.params[i].name);
      if (!same) continue;
      if (target->comments.empty()) target->comments = decl.comments;
      const std::string name = value.text;
      replaceCalls(decl.name, [&](Expr& call) { call.text = name; });
    }
  }

  template <typename Replace>
  void replaceCalls(const std::string& name, const Replace& replace) {
    for (Decl& caller : program_.decls)
      if (!isUsers(caller))
        eachExpr(caller, [&](Expr& expr) {
          if (expr.kind == Expr::Kind::Call && expr.text == name) replace(expr);
        });
  }

  // A case's statements, without the break that ends them.
  std::vector<Stmt> chosenCase(Stmt& stmt, double value) const {
    for (Stmt::Case& one : stmt.cases) {
      const bool hit = one.labels.empty() ||
                       std::ranges::any_of(one.labels, [&](const Expr& label) { return evaluate(label) == value; });
      if (!hit) continue;
      if (!one.body.empty() && one.body.back().kind == Stmt::Kind::Break) one.body.pop_back();
      return std::move(one.body);
    }
    return {};
  }

  static size_t mentions(Decl& decl, const std::string& name) {
    size_t count = 0;
    eachExpr(decl.body, [&](Expr& expr) { count += expr.isAtom(name) ? 1 : 0; });
    return count;
  }

  // Variables that no expression reads: they, and what is assigned to them. Nothing in the dialect has a side effect
  // but out arguments, and a call with one is a statement or a value of a variable that is read.
  void dropDeadVariables(Decl& decl) const {
    std::vector<std::string> names;
    eachStmt(decl.body, [&](Stmt& stmt) {
      if (stmt.kind == Stmt::Kind::Declaration && stmt.names.size() == 1) names.push_back(stmt.names[0].name);
    });
    for (const std::string& name : names) {
      size_t assigned = 0;
      bool computed = false;
      eachStmt(decl.body, [&](Stmt& stmt) {
        if (stmt.kind == Stmt::Kind::Expression && stmt.expr->isAssignment() &&
            rootOf(stmt.expr->kids[0]).isAtom(name)) {
          ++assigned;
          eachExpr(stmt.expr->kids[1], [&](Expr& expr) { assigned += expr.isAtom(name) ? 1 : 0; });
          eachExpr(*stmt.expr, [&](Expr& expr) { computed = computed || hasOutput(expr); });
        }
        if (stmt.kind == Stmt::Kind::Declaration && stmt.names[0].name == name && stmt.names[0].value)
          eachExpr(*stmt.names[0].value, [&](Expr& expr) { computed = computed || hasOutput(expr); });
      });
      if (!computed && mentions(decl, name) == assigned) dropVariable(decl.body, name);
    }
  }

  bool hasOutput(const Expr& expr) const {
    if (expr.kind != Expr::Kind::Call) return false;
    const Decl* decl = program_.find(expr.text);
    return decl != nullptr &&
           std::ranges::any_of(decl->params, [](const Param& param) { return !param.qualifier.empty(); });
  }

  static void dropVariable(std::vector<Stmt>& body, const std::string& name) {
    std::erase_if(body, [&](const Stmt& stmt) {
      if (stmt.kind == Stmt::Kind::Declaration) return stmt.names.size() == 1 && stmt.names[0].name == name;
      return stmt.kind == Stmt::Kind::Expression && stmt.expr->isAssignment() &&
             rootOf(stmt.expr->kids[0]).isAtom(name);
    });
    for (Stmt& stmt : body) {
      dropVariable(stmt.body, name);
      if (stmt.kind != Stmt::Kind::For) dropVariable(stmt.other, name);
      for (Stmt::Case& one : stmt.cases) dropVariable(one.body, name);
    }
  }

  void dropUnusedParams() {
    for (Decl& decl : program_.decls) {
      if (decl.kind != Decl::Kind::Function) continue;
      const bool isRoot = std::ranges::find(known_.roots, decl.name) != known_.roots.end();
      for (size_t i = decl.params.size(); i-- > 0;) {
        const Param& param = decl.params[i];
        if (isRoot && !known_.unread.contains(param.name)) continue;
        if (isUsers(decl) && !isGnomonStruct(param.type)) continue;
        // What is only declared takes what every language has: places.
        const bool used = decl.hasBody ? mentions(decl, param.name) > 0 : param.type != "LookupTables";
        if (used && !known_.unread.contains(param.name)) continue;
        if (!param.qualifier.empty() && !known_.unread.contains(param.name)) continue;
        decl.params.erase(decl.params.begin() + static_cast<std::ptrdiff_t>(i));
        for (Decl& caller : program_.decls)
          eachExpr(caller, [&](Expr& expr) {
            if (expr.kind == Expr::Kind::Call && expr.text == decl.name)
              expr.kids.erase(expr.kids.begin() + static_cast<std::ptrdiff_t>(i));
          });
      }
    }
  }

  bool isGnomonStruct(const std::string& type) const {
    const Decl* decl = program_.find(type);
    return decl != nullptr && decl->kind == Decl::Kind::Struct && !isUsers(*decl);
  }

  static bool assigns(const Expr& left, const std::string& member) {
    for (const Expr* at = &left; at->kind == Expr::Kind::Member || at->kind == Expr::Kind::Index; at = &at->kids[0])
      if (at->kind == Expr::Kind::Member && at->text == member) return true;
    return false;
  }

  static void insertMembers(const Decl& decl, std::set<std::string>& names) {
    for (const Stmt& member : decl.members)
      for (const Declarator& name : member.names) names.insert(name.name);
  }

  // Members that are read only to be assigned to themselves.
  void dropUnreadMembers() {
    std::set<std::string> read, declared;
    for (Decl& decl : program_.decls) {
      if (isUsers(decl)) {
        // Written to as well as read; and what makes a whole structure names each.
        eachExpr(decl, [&](Expr& expr) {
          if (expr.kind == Expr::Kind::Member) read.insert(expr.text);
          if (expr.kind == Expr::Kind::Call && isGnomonStruct(expr.text))
            insertMembers(*program_.find(expr.text), read);
        });
        continue;
      }
      insertMembers(decl, declared);
      eachStmt(decl.body, [&](Stmt& stmt) {
        std::vector<Expr*> parts;
        for (Declarator& name : stmt.names)
          if (name.value) parts.push_back(&*name.value);
        if (stmt.step) parts.push_back(&*stmt.step);
        const Expr* left = nullptr;
        if (stmt.expr && stmt.kind == Stmt::Kind::Expression && stmt.expr->isAssignment()) {
          left = &stmt.expr->kids[0];
          parts.push_back(&stmt.expr->kids[1]);
          for (const Expr* at = left; at->kind == Expr::Kind::Member || at->kind == Expr::Kind::Index;
               at = &at->kids[0])
            if (at->kind == Expr::Kind::Index) parts.push_back(const_cast<Expr*>(&at->kids[1]));
        } else if (stmt.expr) {
          parts.push_back(&*stmt.expr);
        }
        for (Expr* part : parts)
          eachExpr(*part, [&](Expr& expr) {
            if (expr.kind == Expr::Kind::Member && (left == nullptr || !assigns(*left, expr.text)))
              read.insert(expr.text);
          });
      });
    }
    std::set<std::string> dead;
    for (const std::string& name : declared)
      if (!read.contains(name) && name.size() > 1) dead.insert(name);
    for (Decl& decl : program_.decls) {
      if (isUsers(decl)) continue;
      for (Stmt& member : decl.members)
        std::erase_if(member.names, [&](const Declarator& name) { return dead.contains(name.name); });
      std::erase_if(decl.members, [](const Stmt& member) { return member.names.empty(); });
      dropAssignments(decl.body, dead);
    }
  }

  static void dropAssignments(std::vector<Stmt>& body, const std::set<std::string>& members) {
    std::erase_if(body, [&](const Stmt& stmt) {
      return stmt.kind == Stmt::Kind::Expression && stmt.expr->isAssignment() &&
             std::ranges::any_of(members,
                                 [&](const std::string& member) { return assigns(stmt.expr->kids[0], member); });
    });
    for (Stmt& stmt : body) {
      dropAssignments(stmt.body, members);
      dropAssignments(stmt.other, members);
      for (Stmt::Case& one : stmt.cases) dropAssignments(one.body, members);
    }
  }

  void dropUnreachable() {
    std::set<std::string> reached;
    std::vector<std::string> waiting = known_.roots;
    while (!waiting.empty()) {
      const std::string name = waiting.back();
      waiting.pop_back();
      Decl* decl = program_.find(name);
      if (decl == nullptr || !reached.insert(name).second) continue;
      waiting.push_back(decl->type);
      for (const Param& param : decl->params) waiting.push_back(param.type);
      for (const Stmt& member : decl->members) waiting.push_back(member.type);
      eachStmt(decl->body, [&](Stmt& stmt) { waiting.push_back(stmt.type); });
      eachExpr(*decl, [&](Expr& expr) {
        if (expr.kind == Expr::Kind::Atom || expr.kind == Expr::Kind::Call) waiting.push_back(expr.text);
      });
    }
    std::erase_if(program_.decls, [&](const Decl& decl) { return !reached.contains(decl.name); });
  }

  Program& program_;
  const Known& known_;
  std::map<std::string, double> constants_, constantFunctions_;
};

}  // namespace

void simplify(Program& program, const Known& known) {
  Simplifier(program, known).run();
}

}  // namespace gnomon::code
