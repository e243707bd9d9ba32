#pragma once
// The list of biases: each has a name and parameters with unit, range, default and a sentence. Flags, --help, results
// and reports derive from it. The biases themselves are in shaders/shared/bias/.

#include "shadow/channel.h"
#include "shadow/knob.h"

#include "shared/bias_params.glsl"

#include <string>
#include <vector>

namespace gnomon {

struct UserBias;

// A user's bias, or none, in the key of a pipeline. Its address alone is not enough: when a file is read again, what it
// was before may make room for it.
struct UserBiasKey {
  UserBiasKey(const UserBias* of);
  const UserBias* bias;
  uint64_t number;  // UserBias::number; 0: none
  bool operator==(const UserBiasKey&) const = default;
};

// A choice among a few ways of a method, or of several: a whole number among BiasParams. Its flag and its line in
// results derive from it.
struct BiasChoice {
  const char* name;  // in results: "epsilon_at"; the flag has hyphens
  const char* sentence;
  int glsl::BiasParams::*member;
  std::vector<const char*> values;  // as they are written
  std::vector<int> numbers;         // what they stand for; the first is the default

  std::string flag() const;  // "--epsilon-at"
  const char* text(const glsl::BiasParams& params) const;
  int parse(const std::string& text) const;  // throws UsageError
};
extern const BiasChoice kEpsilonAt, kWitnessReach, kPriorityId;
const std::vector<const BiasChoice*>& biasChoices();

struct BiasMethod {
  int id;  // kBias*
  const char* name;
  const char* sentence;                       // what it does and where it comes from
  std::vector<Knob> knobs;                    // at most kMostKnobs; in the order of their places in BiasParams::knobs
  ChannelSet channels = glsl::kChannelDepth;  // what it reads of a texel
  const char* sharesKnobsWith = nullptr;      // the method whose knobs these are, too
  std::vector<const BiasChoice*> choices = {};
  bool onVolumes = false;          // means something on bits, too (shaders/shared/volume_lookup.glsl)
  const UserBias* user = nullptr;  // of --bias-file (user_bias.h)

  // Looks up more than its tap: shared/surface_bias.glsl, not shared/bias.glsl.
  bool knowsSurfaces() const { return id >= glsl::kFirstSurfaceBias && id != glsl::kBiasUser; }
};

// The best one that needs nobody to choose a parameter: what `gnomon render` draws with unless told otherwise.
inline constexpr const char* kDefaultBias = "witness";

// In the order they are listed and run.
const std::vector<BiasMethod>& biasMethods();

// A method's knobs, its own or those it shares.
const std::vector<Knob>& knobsOf(const BiasMethod& method);

// Throws UsageError that lists the names.
const BiasMethod& findBias(const std::string& name);

// "a,b,c" or "all". Throws UsageError.
std::vector<const BiasMethod*> parseBiases(const std::string& list);

// A method's knobs at their defaults for a scene of this diagonal (metres).
glsl::BiasParams defaultBiasParams(const BiasMethod& method, float sceneScale);

// Whether a knob is one of a method's, and what stands at its place; it must be.
bool hasKnob(const BiasMethod& method, const Knob& knob);
float& valueOf(glsl::BiasParams& params, const BiasMethod& method, const Knob& knob);
float valueOf(const glsl::BiasParams& params, const BiasMethod& method, const Knob& knob);

// All choices at their defaults, and all knobs 0.
glsl::BiasParams defaultChoices();

}  // namespace gnomon
