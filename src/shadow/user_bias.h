#pragma once
// A user's own bias: a GLSL file that takes the place of shaders/shared/bias/user.glsl and defines
//
//   bool userLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap)
//
// It may say of itself, in lines of their own that begin with "//!":
//
//   //! name: my-bias                          default: the file's name
//   //! sentence: What it does.
//   //! layers: 2                              1 (default), 2 (tap.z2 holds the second), back (back faces of
//   solids)
//   //! knob: offset metres 0 10 0.001 scene   name, unit (metres, texels, one), lower and upper bound,
//   default,
//                                              which with "scene" is a share of the scene's diagonal
//
// The knob's value is params.userKnob.

#include "shadow/bias.h"

#include <filesystem>
#include <memory>

namespace gnomon {

struct UserBias {
  std::string path;  // as the user wrote it
  std::string name, sentence, knobName, knobSentence;
  std::string source;  // GLSL
  BiasMethod method;   // its strings are those above
};

// Throws WorldError: no such file, or a "//!" line that is not understood ("file:line: ...").
std::unique_ptr<const UserBias> loadUserBias(const std::filesystem::path& path);
// The same of a text; `path` is what complaints name.
std::unique_ptr<const UserBias> readUserBias(const std::filesystem::path& path, const std::string& source);

}  // namespace gnomon
