#include "lab/compare/compare_command.h"

#include "base/check.h"
#include "base/parse.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

namespace gnomon {

namespace {

class Words {
 public:
  explicit Words(std::string first) : line_(std::move(first)) {}
  void word(const std::string& text) { line_ += " " + shellWord(text); }
  void flag(const std::string& name, const std::string& value) {
    word(name);
    word(value);
  }
  const std::string& line() const { return line_; }

 private:
  std::string line_;
};

template <typename T>
std::string namesOf(const std::vector<T>& things, const auto& nameOf) {
  std::string names;
  for (const T& thing : things) names += (names.empty() ? "" : ",") + std::string(nameOf(thing));
  return names;
}

void addMaps(Words& words, const CompareOptions& options) {
  const CompareOptions defaults;
  words.flag("--maps", namesOf(options.maps, [](const Parameterization* map) { return map->name(); }));
  if (options.mapTexels != 0)
    words.flag("--map-texels", fmt::format("{}", options.mapTexels));
  else if (options.mapSide != defaults.mapSide)
    words.flag("--map-size", fmt::format("{}", options.mapSide));
  for (const ChosenOption& choice : options.mapOptions.choices())
    words.flag(choice.option->flag(), choice.option->textOf(choice.value));
  if (options.exposure) words.flag("--exposure", fmt::format("{}", *options.exposure));
  if (options.cull != defaults.cull) words.flag("--cull", cullModeName(options.cull));
}

bool has(const std::vector<Knob>& knobs, const Knob* knob) {
  return std::ranges::any_of(knobs, [&](const Knob& other) { return &other == knob; });
}

bool usesKnob(const CompareOptions& options, const Knob* knob) {
  return std::ranges::any_of(options.biases, [&](const BiasMethod* bias) { return has(knobsOf(*bias), knob); }) ||
         std::ranges::any_of(options.filters, [&](const Filter* filter) { return has(filter->knobs, knob); });
}

// A knob that several methods share is named by the one that lists it.
void addKnob(Words& words, const KnobValue& value) {
  const std::string text = fmt::format("{}", value.value);
  for (const BiasMethod& method : biasMethods())
    if (has(method.knobs, value.knob)) return words.flag(knobFlag(method.name, *value.knob), text);
  for (const Filter& filter : filters())
    if (has(filter.knobs, value.knob)) return words.flag(knobFlag(filter.name, *value.knob), text);
  words.flag("--bias-file-knob", fmt::format("{}={}", value.knob->name, text));
}

void addBiases(Words& words, const CompareOptions& options) {
  for (const std::shared_ptr<const UserBias>& user : options.userBiases) words.flag("--bias-file", user->path);
  words.flag("--biases", namesOf(options.biases, [](const BiasMethod* bias) { return bias->name; }));
  for (const KnobValue& value : options.knobs)
    if (usesKnob(options, value.knob)) addKnob(words, value);
  for (const BiasChoice* choice : biasChoices())
    if (options.choices.*choice->member != choice->numbers.front())
      words.flag(choice->flag(), choice->text(options.choices));
  if (options.tune) words.word("--tune");
  const std::string filters = namesOf(options.filters, [](const Filter* filter) { return filter->name; });
  if (filters != "none") words.flag("--filters", filters);
}

// The one of this name, which must be there.
template <typename T>
std::vector<T> only(const std::vector<T>& things, const std::string& name, const auto& nameOf) {
  const auto found = std::ranges::find_if(things, [&](const T& thing) { return name == nameOf(thing); });
  GNOMON_CHECK(found != things.end());
  return {*found};
}

}  // namespace

std::string compareCommand(const SetupOptions& setup, const CompareOptions& options) {
  Words words("gnomon compare");
  for (const std::string& word : setupWords(setup)) words.word(word);
  addMaps(words, options);
  addBiases(words, options);
  return words.line();
}

std::string renderCommand(const SetupOptions& setup, const CompareOptions& options, const std::string& show,
                          const std::string& file) {
  Words words("gnomon render");
  for (const std::string& word : setupWords(setup)) words.word(word);
  addMaps(words, options);
  addBiases(words, options);
  if (show != "beauty") words.flag("--show", show);
  words.flag("-o", file);
  return words.line();
}

std::string rowCommand(const SetupOptions& setup, const CompareOptions& options, const Row& row) {
  CompareOptions own = options;
  own.maps = only(options.maps, row.map, [](const Parameterization* map) { return map->name(); });
  own.biases = only(options.biases, row.bias, [](const BiasMethod* bias) { return bias->name; });
  if (!row.flip || row.filter != "none")
    own.filters = only(options.filters, row.filter, [](const Filter* filter) { return filter->name; });
  const BiasMethod& bias = *own.biases.front();
  std::erase_if(own.userBiases, [&](const auto& user) { return &user->method != &bias; });
  own.tune = row.tuning.has_value() && row.isSum;
  if (row.tuning && !row.isSum) {
    std::erase_if(own.knobs, [&](const KnobValue& value) { return has(knobsOf(bias), value.knob); });
    for (const Knob& knob : knobsOf(bias))
      for (const Param& param : row.params)
        if (param.name == knob.name && row.isKnob(param))
          own.knobs.push_back({&knob, static_cast<float>(std::get<double>(param.value))});
  }
  SetupOptions light = setup;
  if (setup.light == "all" && !row.isSum) light.light = row.light;
  return compareCommand(light, own);
}

}  // namespace gnomon
