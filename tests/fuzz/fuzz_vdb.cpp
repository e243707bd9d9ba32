// libFuzzer on densities: a grid that can be looked into, or a WorldError of one line. In this process, where the
// program reads in one of its own: what would crash that one is found here.
//
//   fuzz_vdb -max_total_time=300 -rss_limit_mb=3000 NEW_INPUTS CORPUS

#include "fuzzer.h"
#include "vsv/media/density_file.h"

#include <cmath>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* bytes, size_t size) {
  using gnomon::test::require;
  gnomon::test::readOrRefuse("fuzz.vdb: ", [&] {
    const char* named = size % 4 == 0 ? "fuzz.vdb" : "fuzz.vdb:density";
    const std::string text(reinterpret_cast<const char*>(bytes), size);
    const gnomon::DensityFile file = gnomon::readDensityBytes(named, text);
    require(file.facts.activeVoxels > 0, "it has voxels");
    require(!file.nanoVdb.empty(), "it has a grid");
    for (int axis = 0; axis < 3; ++axis)
      require(file.facts.lowerI[axis] <= file.facts.upperI[axis], "first before last");
  });
  return 0;
}
