// libFuzzer on results.json: a whole page, or a WorldError of one line.
//
//   fuzz_results -max_total_time=300 NEW_INPUTS CORPUS

#include "base/file.h"
#include "fuzzer.h"
#include "lab/page/report.h"

#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* bytes, size_t size) {
  using namespace gnomon;
  const std::filesystem::path& folder = test::scratchFolder();
  writeTextFile(folder / "results.json", {reinterpret_cast<const char*>(bytes), size});
  test::readOrRefuse(folder.string(),
                     [&] { test::require(reportHtml(folder).find("</html>") != std::string::npos, "a whole page"); });
  return 0;
}
