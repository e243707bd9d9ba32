#include "lab/export/visibility_source.h"

#include "base/error.h"
#include "lab/export/read_glsl.h"

namespace gnomon::code {

namespace {

Program read(const UserBias* user, const std::map<std::string, std::string>& aliases) {
  ReadOptions options;
  options.aliases = aliases;
  options.publicMembers = true;
  gpu::ShaderSource source = shaderWith("shadow/unbound_visibility.glsl", user);
  // What the pass binds is left out.
  for (const char* bound :
       {"shadow/fetch_channels.glsl", "shadow/fetch_lookup_tables.glsl", "shadow/map_constants.glsl"})
    source.overrides[bound] = "";
  Program program = readGlsl(source, options);
  // Of a function that is declared and then defined, the definition.
  std::set<std::string> defined;
  for (const Decl& decl : program.decls)
    if (decl.hasBody) defined.insert(decl.name);
  std::erase_if(program.decls, [&](const Decl& decl) {
    return decl.kind == Decl::Kind::Function && !decl.hasBody && defined.contains(decl.name);
  });
  return program;
}

}  // namespace

const Program& readVisibility(const std::map<std::string, std::string>& aliases) {
  static std::map<std::map<std::string, std::string>, Program> known;
  const auto found = known.find(aliases);
  return found != known.end() ? found->second : known.emplace(aliases, read(nullptr, aliases)).first->second;
}

Program readVisibilityWith(const UserBias& user, const std::map<std::string, std::string>& aliases) {
  try {
    return read(&user, aliases);
  } catch (const WorldError& error) {
    throw WorldError(inUsersWords(error.what(), user));
  }
}

void passDown(Program& program, std::set<std::string> users, const Param& param) {
  for (size_t before = 0; before != users.size();) {
    before = users.size();
    for (Decl& decl : program.decls)
      eachExpr(decl, [&](Expr& expr) {
        if (expr.kind == Expr::Kind::Call && users.contains(expr.text)) users.insert(decl.name);
      });
  }
  for (Decl& decl : program.decls) {
    eachExpr(decl, [&](Expr& expr) {
      if (expr.kind == Expr::Kind::Call && users.contains(expr.text)) expr.kids.push_back(atom(param.name));
    });
    if (users.contains(decl.name)) decl.params.push_back(param);
  }
}

Decl constantDecl(const char* type, const char* name, const std::string& value, const std::string& says) {
  Decl decl;
  decl.kind = Decl::Kind::Constant;
  decl.file = "constants";
  decl.type = type;
  decl.name = name;
  decl.value = atom(value);
  decl.trailing = " " + says;
  return decl;
}

Stmt memberDecl(const std::string& type, const std::string& name, const std::string& count, const std::string& says) {
  Stmt stmt;
  stmt.kind = Stmt::Kind::Declaration;
  stmt.type = type;
  stmt.names.push_back({.name = name, .count = std::nullopt, .value = std::nullopt});
  if (!count.empty()) stmt.names[0].count = atom(count);
  stmt.trailing = " " + says;
  return stmt;
}

}  // namespace gnomon::code
