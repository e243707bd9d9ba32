#pragma once
// Prints programs (syntax.h) as GLSL, GLSL ES 3.00, HLSL or the Metal shading language, indented, with their comments.

#include "lab/export/syntax.h"

#include <map>
#include <set>

namespace gnomon::code {

enum class Language { Glsl, GlslEs, Hlsl, Msl };

// In the order of the enumeration: "glsl", "glsl-es", "hlsl", "msl".
const std::vector<std::string>& languageNames();

struct PrintOptions {
  Language language = Language::Glsl;
  std::map<std::string, std::string> names;        // what declarations are called: usually prefixedNames()
  std::map<std::string, std::string> definitions;  // of functions that are only declared; whole, in the language
  std::set<std::string> withoutHead;               // files whose head comment is not printed
};

std::string printDecl(const Decl& decl, const PrintOptions& options);
// All declarations, each file's after its head.
std::string printProgram(const Program& program, const PrintOptions& options);

// "gnomonCubeProject", "GnomonShadowMap", "kGnomonMapCube": what a renderer of its own names does not clash with.
std::map<std::string, std::string> prefixedNames(const Program& program);
std::string prefixedName(const Decl& decl);

// A type's or a built-in function's name in the language.
std::string nameIn(Language language, const std::string& glslName);

// A variable's or member's name in the language: with "_" behind it where it is a word of its own.
std::string variableNameIn(Language language, const std::string& name);

// Lines of comments, wrapped to the width of the page.
std::string commentLines(const std::vector<std::string>& lines, int indent = 0);

// A comment without the sentences that are of Gnomon alone: how it is extended, measured and checked.
std::vector<std::string> publicComment(const std::vector<std::string>& lines);

// A line broken where it is longer than the page is wide.
std::string wrappedCode(const std::string& line, int indent);

}  // namespace gnomon::code
