#include "cli/bias_flags.h"

#include "base/error.h"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace gnomon {

namespace {

std::string knobHelp(const BiasMethod& method, const BiasKnob& knob) {
  const std::string unit = *unitName(knob.unit) != '\0' ? fmt::format(" [{}]", unitName(knob.unit)) : "";
  return fmt::format("{}: {}{}; default {:g}{}", method.name, knob.sentence, unit, knob.defaultValue,
                     knob.defaultOfSceneScale ? " of the scene's diagonal" : "");
}

float checkedKnob(const std::string& flag, const BiasKnob& knob, float value) {
  if (!(value >= knob.lower && value <= knob.upper))
    throw UsageError(
        fmt::format("{} {:g} is outside {:g}..{:g} {}", flag, value, knob.lower, knob.upper, unitName(knob.unit)));
  return value;
}

std::string filterChoices() {
  std::string choices;
  for (const Filter& filter : filters())
    choices += fmt::format("{}{} ({})", choices.empty() ? "" : ", ", filter.name, filter.sentence);
  return choices;
}

// Those that --biases names, of the list or of a --bias-file by its name.
void addNamedBiases(const BiasFlags& flags, CompareOptions& options) {
  std::string listed;
  const auto isListed = [](const std::string& word) {
    return std::ranges::any_of(biasMethods(), [&](const BiasMethod& method) { return method.name == word; });
  };
  std::istringstream words(flags.biases);
  for (std::string word; std::getline(words, word, ',');)
    if (isListed(word) ||
        std::ranges::none_of(options.userBiases, [&](const auto& user) { return user->name == word; }))
      listed += (listed.empty() ? "" : ",") + word;
  if (!listed.empty() || flags.biases.empty()) options.biases = parseBiases(listed);
}

// Those of all --bias-file, after the others.
void addUserBiases(const BiasFlags& flags, CompareOptions& options) {
  for (const std::shared_ptr<const UserBias>& user : options.userBiases) {
    const BiasMethod& method = user->method;
    for (const BiasMethod* other : options.biases)
      if (std::string_view(other->name) == method.name)
        throw UsageError(fmt::format("--bias-file {}: two biases are named '{}'; write //! name: in one of them",
                                     user->path, method.name));
    options.biases.push_back(&method);
    if (!flags.biasFileKnob) continue;
    if (method.knobs.empty())
      throw UsageError(fmt::format("--bias-file-knob: {} has no knob; write //! knob: in it", user->path));
    options.knobs.push_back(
        {&method.knobs.front(), checkedKnob("--bias-file-knob", method.knobs.front(), *flags.biasFileKnob)});
  }
  if (flags.biasFiles.empty() && flags.biasFileKnob) throw UsageError("--bias-file-knob needs a --bias-file");
}

}  // namespace

void addBiasFlags(CLI::App& verb, BiasFlags& flags, const char* defaultBiases) {
  flags.biases = defaultBiases;
  std::string biases;
  for (const BiasMethod& method : biasMethods()) biases += fmt::format("{}{}", biases.empty() ? "" : ", ", method.name);
  std::string sentences = "Biases:\n";
  for (const BiasMethod& method : biasMethods())
    sentences += fmt::format("  {:<17} {}\n", method.name, method.sentence);
  verb.footer(sentences);
  verb.add_option("--biases", flags.biases, fmt::format("comma-separated, or all: {}", biases))->capture_default_str();
  verb.add_option("--bias-file", flags.biasFiles,
                  "GLSL file with a bias of your own, scored as one more row (docs/add_a_bias.md); may be repeated");
  verb.add_option("--bias-file-knob", flags.biasFileKnob,
                  "value of your bias's knob, in its unit; default: as the file says");
  verb.add_option("--filters", flags.filters, "comma-separated, or all: " + filterChoices())->capture_default_str();
  verb.add_option("--epsilon-at", flags.epsilonAt, "where adaptive takes its epsilon: fragment, occluder or stored")
      ->capture_default_str();
  for (const BiasMethod& method : biasMethods())
    for (const BiasKnob& knob : method.knobs)
      verb.add_option_function<float>(
          knobFlag(method, knob), [&flags, flag = knobFlag(method, knob)](float value) { flags.knobs[flag] = value; },
          knobHelp(method, knob));
}

void chooseBiases(const BiasFlags& flags, CompareOptions& options) {
  for (const std::string& path : flags.biasFiles) options.userBiases.push_back(loadUserBias(path));
  addNamedBiases(flags, options);
  options.filters = parseFilters(flags.filters);
  options.epsilonAt = parseEpsilonAt(flags.epsilonAt);
  for (const BiasMethod& method : biasMethods()) {
    for (const BiasKnob& knob : method.knobs) {
      const auto found = flags.knobs.find(knobFlag(method, knob));
      if (found == flags.knobs.end()) continue;
      options.knobs.push_back({&knob, checkedKnob(found->first, knob, found->second)});
    }
  }
  addUserBiases(flags, options);
}

}  // namespace gnomon
