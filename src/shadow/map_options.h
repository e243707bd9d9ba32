#pragma once
// The user's options for fitting and drawing maps. A parameterization declares its options beside the code that reads
// them; flags, --help, results.json and the command lines in reports follow from the declaration.
//
//   constinit const ChoiceOption<CubeDepth> kCubeDepth({.name = "cube_depth", ...}, CubeDepth::Hyperbolic, {...});
//
//   input.options.get(kCubeDepth)                        what was chosen, a CubeDepth
//   MapOptions{kWarp(Warp::Psm), kSnap(false)}           these two, everything else at defaults
//   given.with(kCubeDepth(CubeDepth::Radial))            those given, but this one changed

#include <any>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

namespace gnomon {

class MapOptions;

// Which rows of results.json name an option.
enum class InResults {
  EveryRow,      // of all maps
  OwnRows,       // of the maps that declare it
  WhereChanged,  // of those, where it is not at its default
};

// What is said of an option, whatever its values are.
struct OptionText {
  const char* name;      // in results.json; on the command line with dashes: cube_depth is --cube-depth
  const char* sentence;  // for --help; the values follow
  const char* unit = "";
  InResults results = InResults::WhereChanged;
  // What results.json says where that is not the value as it was chosen.
  std::string (*told)(const MapOptions&) = nullptr;
};

class MapOption {
 public:
  const char* name() const { return text_.name; }
  InResults results() const { return text_.results; }
  std::string flag() const;
  std::string help() const;  // sentence, unit and values; the default is told apart
  std::string told(const MapOptions& options) const;
  virtual bool isNumber() const { return false; }               // in results.json
  virtual std::any parsed(const std::string& text) const = 0;   // throws UsageError that names the flag
  virtual std::string textOf(const std::any& value) const = 0;  // `parsed` takes it back
  virtual std::string defaultText() const = 0;
  virtual std::vector<std::string> valueNames() const { return {}; }  // of a choice

 protected:
  explicit constexpr MapOption(const OptionText& text) : text_(text) {}
  ~MapOption() = default;  // options are constants, never deleted
  virtual std::string valuesHelp() const { return ""; }

 private:
  OptionText text_;
};

// An option with the value chosen for it.
struct ChosenOption {
  const MapOption* option;
  std::any value;
};

// By values of one type.
template <typename T>
class MapOptionOf : public MapOption {
 public:
  ChosenOption operator()(T value) const { return {this, std::move(value)}; }
  const T& defaultValue() const { return default_; }
  virtual T parse(const std::string& text) const = 0;
  virtual std::string text(const T& value) const = 0;

  std::any parsed(const std::string& text) const final { return parse(text); }
  std::string textOf(const std::any& value) const final { return text(std::any_cast<const T&>(value)); }
  std::string defaultText() const final { return text(default_); }

 protected:
  constexpr MapOptionOf(const OptionText& text, T defaultValue) : MapOption(text), default_(std::move(defaultValue)) {}
  ~MapOptionOf() = default;

 private:
  T default_;
};

// "--cube-depth cubic: no such choice; choose from hyperbolic, radial", as a UsageError.
[[noreturn]] void failChoice(const std::string& flag, const std::string& text, const std::string& names);
// The whole number that `text` is. Throws UsageError.
int parseWholeNumber(const std::string& flag, const std::string& text, int lower, int upper);
void checkRange(const std::string& flag, int value, int lower, int upper);

// One of several named values.
template <typename T>
class ChoiceOption final : public MapOptionOf<T> {
 public:
  struct Value {
    T value;
    const char* name;
    const char* sentence = "";
  };
  static constexpr size_t kMostValues = 8;

  constexpr ChoiceOption(const OptionText& text, T defaultValue, std::initializer_list<Value> values)
      : MapOptionOf<T>(text, defaultValue) {
    for (const Value& value : values) values_[count_++] = value;
  }
  T parse(const std::string& text) const override {
    std::string names;
    for (size_t i = 0; i < count_; ++i) {
      if (text == values_[i].name) return values_[i].value;
      names += (i == 0 ? "" : ", ") + std::string(values_[i].name);
    }
    failChoice(this->flag(), text, names);
  }
  std::vector<std::string> valueNames() const override {
    std::vector<std::string> names;
    for (size_t i = 0; i < count_; ++i) names.emplace_back(values_[i].name);
    return names;
  }
  std::string text(const T& value) const override {
    for (size_t i = 0; i < count_; ++i)
      if (values_[i].value == value) return values_[i].name;
    return "?";
  }

 protected:
  std::string valuesHelp() const override {
    std::string help;
    for (size_t i = 0; i < count_; ++i)
      help += (i == 0 ? "" : "; ") + std::string(values_[i].name) + ": " + values_[i].sentence;
    return help;
  }

 private:
  std::array<Value, kMostValues> values_{};
  size_t count_ = 0;
};

// A whole number within a range.
class NumberOption final : public MapOptionOf<int> {
 public:
  constexpr NumberOption(const OptionText& text, int defaultValue, int lower, int upper)
      : MapOptionOf(text, defaultValue), lower_(lower), upper_(upper) {}
  int parse(const std::string& text) const override { return parseWholeNumber(flag(), text, lower_, upper_); }
  std::string text(const int& value) const override { return std::to_string(value); }
  bool isNumber() const override { return true; }
  void check(int value) const { checkRange(flag(), value, lower_, upper_); }  // throws UsageError

 protected:
  std::string valuesHelp() const override { return std::to_string(lower_) + ".." + std::to_string(upper_); }

 private:
  int lower_, upper_;
};

// Values that are written in a way of their own.
template <typename T>
class WrittenOption final : public MapOptionOf<T> {
 public:
  using Parse = T (*)(const std::string& flag, const std::string& text);  // throws UsageError
  using Write = std::string (*)(const T&);
  constexpr WrittenOption(const OptionText& text, T defaultValue, Parse read, Write write)
      : MapOptionOf<T>(text, std::move(defaultValue)), parse_(read), write_(write) {}
  T parse(const std::string& text) const override { return parse_(this->flag(), text); }
  std::string text(const T& value) const override { return write_(value); }

 private:
  Parse parse_;
  Write write_;
};

// What was chosen; options that are not named are at their defaults. A value: two are equal where all choices are.
class MapOptions {
 public:
  MapOptions() = default;
  MapOptions(std::initializer_list<ChosenOption> choices) {
    for (const ChosenOption& choice : choices) set(choice);
  }

  template <typename T>
  const T& get(const MapOptionOf<T>& option) const {
    const ChosenOption* choice = find(option);
    return choice == nullptr ? option.defaultValue() : std::any_cast<const T&>(choice->value);
  }
  template <typename T>
  std::string text(const MapOptionOf<T>& option) const {
    return option.text(get(option));
  }
  void set(const ChosenOption& choice);
  MapOptions with(const ChosenOption& choice) const;

  // Those that are not at their defaults, by name.
  const std::vector<ChosenOption>& choices() const { return choices_; }
  const ChosenOption* find(const MapOption& option) const;  // nullptr: at its default
  bool operator==(const MapOptions& other) const;
  bool operator<(const MapOptions& other) const;

 private:
  std::vector<ChosenOption> choices_;
};

}  // namespace gnomon
