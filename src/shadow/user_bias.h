#pragma once
// A user's own bias: a GLSL file that replaces shaders/shared/bias/user.glsl and defines
//
//   bool userLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap)
//
// It may declare, in lines that begin with "//!":
//
//   //! name: my-bias                          default: the file's name
//   //! sentence: What it does.
//   //! channels: depth, second-depth          what it reads of a texel (src/shadow/channel.cpp); default: depth
//   //! knob: offset metres 0 10 0.001 scene   name, unit (metres, texels, one), lower and upper bound, default
//                                              (with "scene": a fraction of the scene's diagonal); at most 4 lines
//
// The value of parameter `max-offset` is params.knobs[kUserMaxOffset].

#include "gpu/shader_compiler.h"
#include "shadow/bias.h"

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace gnomon {

inline constexpr std::string_view kUserBiasFile = "shared/bias/user.glsl";  // in whose place it is compiled
inline constexpr std::string_view kUserKnobsFile = "shared/bias/user_knobs.glsl";

struct UserBias {
  uint64_t number = 0;  // from 1 on, another for each that this process reads
  std::string path;     // as the user wrote it
  std::string name, sentence, knobSentence;
  std::array<std::string, glsl::kMostKnobs> knobNames;
  std::string source;     // GLSL
  std::string knobsGlsl;  // in place of kUserKnobsFile
  BiasMethod method;      // its strings are those above
};

// Throws WorldError: no such file, a "//!" line that is not understood, or a channel that is read and not declared
// ("file:line: ...").
std::unique_ptr<const UserBias> loadUserBias(const std::filesystem::path& path);
// The same of a text; `path` is what complaints name.
std::unique_ptr<const UserBias> readUserBias(const std::filesystem::path& path, const std::string& source);

inline constexpr const char* kVisibilityShader = "shadow/shade_visibility.comp.glsl";
// A shader of ours with the user's bias in its place; as it is where there is none.
gpu::ShaderSource shaderWith(const char* path, const UserBias* bias);
// What the compiler said of it, with the user's file named as the user wrote it.
std::string inUsersWords(std::string message, const UserBias& bias);

// "max-offset" -> "kUserMaxOffset".
std::string knobConstant(const std::string& knob);

}  // namespace gnomon
