#pragma once
// The visibility pass with nothing bound (shaders/shadow/unbound_visibility.glsl), read: what exported files
// (export_shader.h) and headers (public_headers.h) are made of.

#include "lab/export/syntax.h"
#include "shadow/user_bias.h"

#include <map>
#include <set>
#include <string>

namespace gnomon::code {

// `aliases`: what GNOMON_MAP_KIND and GNOMON_BIAS_METHOD stand for, if anything. Kept: read once a run, by one thread.
const Program& readVisibility(const std::map<std::string, std::string>& aliases);
// With a user's bias in its place, which must have passed checkUserBias(). Throws WorldError that names its file where
// it leaves the dialect of docs/shared_glsl.md.
Program readVisibilityWith(const UserBias& user, const std::map<std::string, std::string>& aliases);

// Gives the functions named, and all that call them, one more parameter, which they pass on by its name.
void passDown(Program& program, std::set<std::string> users, const Param& param);

// A constant, and a member of a structure, as declarations of their own.
Decl constantDecl(const char* type, const char* name, const std::string& value, const std::string& says);
Stmt memberDecl(const std::string& type, const std::string& name, const std::string& count, const std::string& says);

}  // namespace gnomon::code
