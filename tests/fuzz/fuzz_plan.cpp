// libFuzzer on plans of gnomon sweep: the axes that they name, or a WorldError of one line.
//
//   fuzz_plan -max_total_time=300 NEW_INPUTS CORPUS

#include "base/file.h"
#include "fuzzer.h"
#include "lab/sweep/axes.h"

#include <string>

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* bytes, size_t size) {
  using namespace gnomon;
  // A plan may name a bias beside it, as samples/sweep.json does.
  static const std::filesystem::path path = [] {
    writeTextFile(test::scratchFolder() / "my_bias.glsl",
                  "bool userLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap) { return true; }\n");
    return test::scratchFolder() / "m.json";
  }();
  const std::string text(reinterpret_cast<const char*>(bytes), size);
  test::readOrRefuse(path.string(), [&] {
    const Plan plan = parsePlan(path, text);
    test::require(!axesOf(plan).scenes.empty(), "a plan has a scene");
  });
  return 0;
}
