// libFuzzer on a user's bias, up to the compiler, which is glslang's and runs in a process of its own: what its "//!"
// lines declare, and whether a loop of it ends.
//
//   fuzz_bias -max_total_time=300 NEW_INPUTS CORPUS

#include "base/error.h"
#include "fuzzer.h"
#include "shadow/user_bias_check.h"

#include <algorithm>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* bytes, size_t size) {
  using namespace gnomon;
  const std::string source(reinterpret_cast<const char*>(bytes), size);
  test::readOrRefuse("fuzz.glsl", [&] {
    const auto bias = readUserBias("fuzz.glsl", source);
    test::require(bias->method.knobs.size() <= bias->knobNames.size(), "as many parameters as there may be");
    try {
      test::require(!gpu::expandShader(shaderWith(kVisibilityShader, bias.get())).empty(), "a shader");
    } catch (const WorldError& error) {  // as checkUserBias does
      throw WorldError(inUsersWords(error.what(), *bias));
    }
    const int line = endlessLoop(source), lines = 1 + static_cast<int>(std::count(source.begin(), source.end(), '\n'));
    test::require(line >= 0 && line <= lines, "a line of the file");
  });
  return 0;
}
