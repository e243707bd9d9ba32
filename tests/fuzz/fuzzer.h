#pragma once
// What the libFuzzer targets have in common: whatever the bytes, what a reader promises, or a WorldError of one line.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string_view>

namespace gnomon::test {

// Aborts, which the fuzzer reports with the input.
void require(bool holds, const char* what);

// Calls `read`; a WorldError it may throw, of one line that names `name`. Any other exception ends the program.
void readOrRefuse(std::string_view name, const std::function<void()>& read);

// Until the program ends.
const std::filesystem::path& scratchFolder();

}  // namespace gnomon::test
