#pragma once
// JSON that nobody vouches for. What is nested deep would overflow the stack of whoever walks it; ordered_json looks
// each member up from the beginning, so an object of many takes a time that grows with their square. Both are counted
// in a pass of its own (SAX): nlohmann's parser with a callback goes through the whole of a list after each of its
// objects. For files that include nlohmann's header anyway.

#include "base/error.h"

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace gnomon {

struct JsonLimits {
  size_t depth = 64;
  size_t members = std::numeric_limits<size_t>::max();  // of an object
  bool comments = false;                                // are passed over: // to the line's end, and /* */
};

namespace detail {

// Counts, and keeps nothing. What is no JSON is for the parser to say.
class JsonCounter final : public nlohmann::json_sax<nlohmann::json> {
 public:
  explicit JsonCounter(const JsonLimits& limits) : limits_(limits) {}

  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_object(size_t) override { return open(); }
  bool key(string_t&) override {
    if (++members_.back() > limits_.members)
      throw WorldError(fmt::format("an object has more than {} members", limits_.members));
    return true;
  }
  bool end_object() override { return close(); }
  bool start_array(size_t) override { return open(); }
  bool end_array() override { return close(); }
  bool parse_error(size_t, const std::string&, const nlohmann::detail::exception&) override { return false; }

 private:
  bool open() {
    if (members_.size() >= limits_.depth)
      throw WorldError(fmt::format("the JSON is nested more than {} deep", limits_.depth));
    members_.push_back(0);
    return true;
  }
  bool close() {
    members_.pop_back();
    return true;
  }

  JsonLimits limits_;
  std::vector<size_t> members_;  // of what is open
};

}  // namespace detail

// `Json`: nlohmann::json or ordered_json. Throws its exceptions where it is no JSON, and WorldError of the bare
// complaint where a limit is passed.
template <typename Json>
Json parseJson(std::string_view text, const JsonLimits& limits) {
  detail::JsonCounter counter(limits);
  nlohmann::json::sax_parse(text.begin(), text.end(), &counter, nlohmann::json::input_format_t::json, true,
                            limits.comments);
  return Json::parse(text.begin(), text.end(), nullptr, true, limits.comments);
}

}  // namespace gnomon
