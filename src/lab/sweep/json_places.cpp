#include "lab/sweep/json_places.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

namespace gnomon {

namespace {

class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}

  JsonPlaces scan() {
    value("");
    return std::move(places_);
  }

 private:
  char at() const { return at_ < text_.size() ? text_[at_] : '\0'; }

  void skip() {
    if (at_ == 0 && text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
    while (at_ < text_.size()) {
      if (at() == ' ' || at() == '\t' || at() == '\n' || at() == '\r') {
        ++at_;
      } else if (text_.substr(at_, 2) == "//") {
        at_ = std::min(text_.find('\n', at_), text_.size());
      } else if (text_.substr(at_, 2) == "/*") {
        const size_t end = text_.find("*/", at_ + 2);
        at_ = end == std::string_view::npos ? text_.size() : end + 2;
      } else {
        break;
      }
    }
  }

  std::string_view string() {
    const size_t begin = ++at_;
    while (at_ < text_.size() && at() != '"') at_ += at() == '\\' ? 2 : 1;
    at_ = std::min(at_, text_.size());
    const std::string_view inside = text_.substr(begin, at_ - begin);
    if (at_ < text_.size()) ++at_;
    return inside;
  }

  void value(const std::string& path) {
    skip();
    places_.offsets.emplace_back(path, at_);
    if (at() == '"') {
      string();
    } else if (at() == '{') {
      object(path);
    } else if (at() == '[') {
      list(path);
    } else {
      while (at_ < text_.size() && std::string_view(",]} \t\r\n/").find(at()) == std::string_view::npos) ++at_;
    }
  }

  void object(const std::string& path) {
    ++at_;
    std::set<std::string_view> keys;
    for (skip(); at_ < text_.size() && at() != '}'; skip()) {
      if (at() != '"') {
        ++at_;  // a comma
        continue;
      }
      const std::string_view key = string();
      const std::string inner = path.empty() ? std::string(key) : path + "." + std::string(key);
      if (!keys.insert(key).second && places_.twice.empty()) places_.twice = inner;
      skip();
      if (at() == ':') ++at_;
      value(inner);
    }
    if (at_ < text_.size()) ++at_;
  }

  void list(const std::string& path) {
    ++at_;
    size_t count = 0;
    for (skip(); at_ < text_.size() && at() != ']'; skip()) {
      if (at() == ',') {
        ++at_;
        continue;
      }
      const size_t before = at_;
      value(fmt::format("{}[{}]", path, count++));
      if (at_ == before) ++at_;
    }
    if (at_ < text_.size()) ++at_;
  }

  std::string_view text_;
  size_t at_ = 0;
  JsonPlaces places_;
};

}  // namespace

JsonPlaces placesInJson(std::string_view text) {
  return Scanner(text).scan();
}

LineAndColumn lineAndColumn(std::string_view text, size_t offset) {
  const std::string_view before = text.substr(0, std::min(offset, text.size()));
  LineAndColumn place;
  place.line = 1 + static_cast<size_t>(std::ranges::count(before, '\n'));
  const size_t line = before.rfind('\n');
  for (const char c : before.substr(line == std::string_view::npos ? 0 : line + 1))
    place.column += (static_cast<unsigned char>(c) & 0xc0) != 0x80 ? 1 : 0;
  return place;
}

}  // namespace gnomon
