#include "cli/bias_flags.h"

#include "base/error.h"
#include "base/suggest.h"
#include "cli/offers.h"
#include "cli/option_group.h"
#include "shadow/user_bias_check.h"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

namespace gnomon {

namespace {

std::string knobHelp(const char* owner, const Knob& knob) {
  const std::string unit = *unitName(knob.unit) != '\0' ? fmt::format(" [{}]", unitName(knob.unit)) : "";
  return fmt::format("{}: {}{}; default {:g}{}", owner, knob.sentence, unit, knob.defaultValue,
                     knob.defaultOfSceneScale ? " of the scene's diagonal" : "");
}

template <typename Function>
void forEachKnob(Function function) {
  for (const BiasMethod& method : biasMethods())
    for (const Knob& knob : method.knobs) function(method.name, knob);
  for (const Filter& filter : filters())
    for (const Knob& knob : filter.knobs) function(filter.name, knob);
}

float checkedKnob(const std::string& flag, const Knob& knob, float value) {
  if (!(value >= knob.lower && value <= knob.upper))
    throw UsageError(
        fmt::format("{} {:g} is outside {:g}..{:g} {}", flag, value, knob.lower, knob.upper, unitName(knob.unit)));
  return value;
}

// And all.
template <typename T>
std::vector<std::string> namesOf(const std::vector<T>& listed) {
  std::vector<std::string> names = {"all"};
  for (const T& one : listed) names.emplace_back(one.name);
  return names;
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

float parseKnobValue(const std::string& text, const std::string& number) {
  size_t used = 0;
  float value = 0.0f;
  try {
    value = std::stof(number, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used == 0 || used != number.size())
    throw UsageError(fmt::format("--bias-file-knob {}: '{}' is not a number; write NAME=VALUE or VALUE", text, number));
  return value;
}

std::string knobNames(const BiasMethod& method) {
  std::string names;
  for (const Knob& knob : method.knobs) names += (names.empty() ? "" : ", ") + std::string(knob.name);
  return names;
}

}  // namespace

void setUserKnob(const std::string& text, const std::vector<std::shared_ptr<const UserBias>>& users,
                 std::vector<KnobValue>& knobs) {
  const size_t equals = text.find('=');
  const bool named = equals != std::string::npos;
  const std::string name = named ? text.substr(0, equals) : "";
  const float value = parseKnobValue(text, named ? text.substr(equals + 1) : text);
  bool found = false;
  std::vector<std::string> known;
  for (const auto& user : users) {
    const BiasMethod& method = user->method;
    if (method.knobs.empty() && (!named || users.size() == 1))
      throw UsageError(
          fmt::format("--bias-file-knob {}: {} has no parameter; declare one in it with //! knob:", text, user->path));
    if (!named && method.knobs.size() > 1)
      throw UsageError(
          fmt::format("--bias-file-knob {}: {} has {} parameters; write NAME=VALUE, where NAME is one of {}", text,
                      user->path, method.knobs.size(), knobNames(method)));
    for (const Knob& knob : method.knobs) {
      if (std::ranges::find(known, knob.name) == known.end()) known.emplace_back(knob.name);
      if (named && name != knob.name) continue;
      knobs.push_back({&knob, checkedKnob("--bias-file-knob " + std::string(knob.name), knob, value)});
      found = true;
    }
  }
  if (!found)
    throw UsageError(fmt::format("--bias-file-knob {}: no such parameter; {}", text,
                                 chooseFrom(name, fmt::format("{}", fmt::join(known, ", ")))));
}

namespace {

// As --biases has them; a file that it does not name comes last.
void orderAsNamed(const BiasFlags& flags, CompareOptions& options) {
  std::vector<std::string> words;
  std::istringstream text(flags.biases);
  for (std::string word; std::getline(text, word, ',');) words.push_back(word);
  const auto place = [&](const BiasMethod* bias) {
    const auto named = std::ranges::find(words, bias->name);
    return bias->user != nullptr || named != words.end() ? named : std::ranges::find(words, "all");
  };
  std::ranges::stable_sort(options.biases, {}, place);
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
  }
  if (flags.biasFiles.empty() && !flags.biasFileKnobs.empty()) throw UsageError("--bias-file-knob needs a --bias-file");
  for (const std::string& text : flags.biasFileKnobs) setUserKnob(text, options.userBiases, options.knobs);
}

}  // namespace

void addBiasFlags(CLI::App& verb, BiasFlags& flags, const char* defaultBiases, const std::string& howMany) {
  flags.biases = defaultBiases;
  const OptionGroup group(verb, "Bias and filter");
  std::string biases;
  for (const BiasMethod& method : biasMethods()) biases += fmt::format("{}{}", biases.empty() ? "" : ", ", method.name);
  std::string sentences = "Biases:\n";
  for (const BiasMethod& method : biasMethods())
    sentences += fmt::format("  {:<17} {}\n", method.name, method.sentence);
  verb.footer(sentences);
  offersSomeOf(
      verb.add_option("--biases", flags.biases,
                      fmt::format("{}: {}. witness has no parameter, and render draws with it", howMany, biases))
          ->capture_default_str(),
      namesOf(biasMethods()));
  offersFiles(verb.add_option(
      "--bias-file", flags.biasFiles,
      "GLSL file with your own bias (docs/add_a_bias.md): compare scores it beside the others and takes several; "
      "render and view draw it in place of the default"));
  verb.add_option("--bias-file-knob", flags.biasFileKnobs,
                  "NAME=VALUE: a parameter of your bias, in its unit, in each file that has it "
                  "(VALUE alone if it has only one); default: the file's; may be repeated")
      ->allow_extra_args(false);
  offersSomeOf(verb.add_option("--filters", flags.filters, howMany + ": " + filterChoices())->capture_default_str(),
               namesOf(filters()));
  for (const BiasChoice* choice : biasChoices()) {
    const std::string flag = choice->flag();
    flags.choices[flag] = choice->values.front();
    offersOneOf(verb.add_option(flag, flags.choices[flag], choice->sentence)->capture_default_str(),
                {choice->values.begin(), choice->values.end()});
  }
  forEachKnob([&](const char* owner, const Knob& knob) {
    const std::string flag = knobFlag(owner, knob);
    verb.add_option_function<float>(
        flag, [&flags, flag](float value) { flags.knobs[flag] = value; }, knobHelp(owner, knob));
  });
}

void chooseBiases(const BiasFlags& flags, CompareOptions& options) {
  for (const std::string& path : flags.biasFiles) {
    options.userBiases.push_back(loadUserBias(path));
    checkUserBias(*options.userBiases.back());
  }
  addNamedBiases(flags, options);
  options.filters = parseFilters(flags.filters);
  for (const BiasChoice* choice : biasChoices())
    options.choices.*choice->member = choice->parse(flags.choices.at(choice->flag()));
  forEachKnob([&](const char* owner, const Knob& knob) {
    const auto found = flags.knobs.find(knobFlag(owner, knob));
    if (found != flags.knobs.end()) options.knobs.push_back({&knob, checkedKnob(found->first, knob, found->second)});
  });
  addUserBiases(flags, options);
  orderAsNamed(flags, options);
}

}  // namespace gnomon
