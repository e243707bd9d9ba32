#pragma once
// Checks for programming errors: enabled in every build; a failed one prints both values and aborts.
//   GNOMON_CHECK(ptr != nullptr);
//   GNOMON_CHECK_EQ(size, expectedSize);

#include <fmt/format.h>

#include <string>

namespace gnomon::detail {

[[noreturn]] void checkFailed(const char* file, int line, const char* expression, const std::string& values);

template <typename A, typename B>
std::string showBoth(const A& a, const B& b) {
  return fmt::format("{} against {}", a, b);
}

}  // namespace gnomon::detail

#define GNOMON_CHECK(condition)                                                          \
  do {                                                                                   \
    if (!(condition)) ::gnomon::detail::checkFailed(__FILE__, __LINE__, #condition, ""); \
  } while (false)

#define GNOMON_CHECK_OP(op, a, b)                                                  \
  do {                                                                             \
    const auto& gnomonA = (a);                                                     \
    const auto& gnomonB = (b);                                                     \
    if (!(gnomonA op gnomonB))                                                     \
      ::gnomon::detail::checkFailed(__FILE__, __LINE__, #a " " #op " " #b,         \
                                    ::gnomon::detail::showBoth(gnomonA, gnomonB)); \
  } while (false)

#define GNOMON_CHECK_EQ(a, b) GNOMON_CHECK_OP(==, a, b)
#define GNOMON_CHECK_LT(a, b) GNOMON_CHECK_OP(<, a, b)
#define GNOMON_CHECK_LE(a, b) GNOMON_CHECK_OP(<=, a, b)
