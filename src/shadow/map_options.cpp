#include "shadow/map_options.h"

#include "base/error.h"
#include "base/suggest.h"

#include <algorithm>
#include <charconv>
#include <string_view>

#include <fmt/format.h>

namespace gnomon {

namespace {

std::string writtenAs(const ChosenOption& choice) {
  return choice.option->textOf(choice.value);
}

}  // namespace

std::string MapOption::flag() const {
  std::string flag = std::string("--") + text_.name;
  std::ranges::replace(flag, '_', '-');
  return flag;
}

std::string MapOption::help() const {
  std::string help = text_.sentence;
  if (*text_.unit != '\0') help += fmt::format(" [{}]", text_.unit);
  const std::string values = valuesHelp();
  return values.empty() ? help : help + ". " + values;
}

std::string MapOption::told(const MapOptions& options) const {
  if (text_.told != nullptr) return text_.told(options);
  const ChosenOption* choice = options.find(*this);
  return choice == nullptr ? defaultText() : writtenAs(*choice);
}

void failChoice(const std::string& flag, const std::string& text, const std::string& names) {
  throw UsageError(fmt::format("{} {}: no such choice; {}", flag, text, chooseFrom(text, names)));
}

void checkRange(const std::string& flag, int value, int lower, int upper) {
  if (value < lower || value > upper)
    throw UsageError(fmt::format("{} {}: is outside {}..{}", flag, value, lower, upper));
}

int parseWholeNumber(const std::string& flag, const std::string& text, int lower, int upper) {
  int value = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc() || end != text.data() + text.size())
    throw UsageError(fmt::format("{} {}: write a whole number of {}..{}", flag, text, lower, upper));
  checkRange(flag, value, lower, upper);
  return value;
}

const ChosenOption* MapOptions::find(const MapOption& option) const {
  const auto found = std::ranges::find(choices_, &option, &ChosenOption::option);
  return found == choices_.end() ? nullptr : &*found;
}

void MapOptions::set(const ChosenOption& choice) {
  std::erase_if(choices_, [&](const ChosenOption& other) { return other.option == choice.option; });
  if (writtenAs(choice) == choice.option->defaultText()) return;
  const auto place =
      std::ranges::upper_bound(choices_, std::string_view(choice.option->name()), {},
                               [](const ChosenOption& other) { return std::string_view(other.option->name()); });
  choices_.insert(place, choice);
}

MapOptions MapOptions::with(const ChosenOption& choice) const {
  MapOptions changed = *this;
  changed.set(choice);
  return changed;
}

bool MapOptions::operator==(const MapOptions& other) const {
  return std::ranges::equal(choices_, other.choices_, [](const ChosenOption& a, const ChosenOption& b) {
    return a.option == b.option && writtenAs(a) == writtenAs(b);
  });
}

bool MapOptions::operator<(const MapOptions& other) const {
  const auto words = [](const ChosenOption& choice) {
    return std::pair(std::string_view(choice.option->name()), writtenAs(choice));
  };
  return std::ranges::lexicographical_compare(choices_, other.choices_, {}, words, words);
}

}  // namespace gnomon
