#pragma once
// What an expression of a shader is: its type, and whether it writes to a variable.

#include "lab/export/syntax.h"

#include <functional>
#include <string>
#include <unordered_map>
#include <vector>

namespace gnomon::code {

// Those that are seen from a place; of several with one name the last counts.
class Variables {
 public:
  // "vec3", of an array "vec3[]"; null where there is no variable of the name.
  const std::string* typeOf(const std::string& name) const;

  size_t count() const { return names_.size(); }
  void add(const std::string& name, const std::string& type);
  void dropFrom(size_t count);  // the last

 private:
  std::vector<std::string> names_;
  std::unordered_map<std::string, std::vector<std::string>> types_;  // by name
};

// "float", "vec3", "mat4", "Receiver", "float[]"; empty where it is not known. A built-in function's is that of its
// arguments' largest, or as many of what it makes of them: bvec3 of isnan(vec3).
// `known`: those that a walk has found, to which it adds; without, what is within is looked at again each time.
using ExprTypes = std::unordered_map<const Expr*, std::string>;
std::string typeOf(const Expr& expr, const Variables& variables, const Program& program, ExprTypes* known = nullptr);

bool isScalar(const std::string& type);
bool isVector(const std::string& type);  // "uvec2"
bool isMatrix(const std::string& type);  // "mat4", "mat2x3"
// Of a vector's type; 0 of any other.
int componentCount(const std::string& type);

// A number as it is written: "0.5f", "-1".
bool isNumber(const Expr& expr);

// Whether it assigns, counts up or down, or calls a function that writes to an argument.
bool writesVariable(const Expr& expr, const Program& program);

// Calls `visit` for each expression of a declaration, those within others after what they are in, with the variables
// that are seen from it.
void eachExprAndItsVariables(const Decl& decl, const std::function<void(const Expr&, const Variables&)>& visit);

}  // namespace gnomon::code
