#pragma once
// Flags that choose biases, filters and their parameters; they come from the lists in shadow/bias.h and
// shadow/filter.h.

#include "lab/compare/compare.h"

#include <map>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace gnomon {

struct BiasFlags {
  std::string biases;
  std::vector<std::string> biasFiles;
  std::vector<std::string> biasFileKnobs;  // NAME=VALUE or VALUE
  std::string filters = "none";
  std::map<std::string, std::string> choices;  // by flag
  std::map<std::string, float> knobs;          // flag -> value
};
// --biases, --bias-file, --bias-file-knob, --filters, --epsilon-at, and a flag for each knob.
// `howMany`: how many of them the verb takes, "one of".
void addBiasFlags(CLI::App& verb, BiasFlags& flags, const char* defaultBiases, const std::string& howMany);

// A word of --bias-file-knob. NAME=VALUE: of every bias that has such a parameter; VALUE alone: of every one, each of
// which must have one parameter. Throws UsageError.
void setUserKnob(const std::string& text, const std::vector<std::shared_ptr<const UserBias>>& users,
                 std::vector<KnobValue>& knobs);

// Sets the options' biases, knobs and filters. Throws UsageError.
void chooseBiases(const BiasFlags& flags, CompareOptions& options);

}  // namespace gnomon
