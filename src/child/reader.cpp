// gnomon-reader: OpenVDB on a file that nobody vouches for (base/child.h).
#include "base/child.h"
#include "vsv/media/density_file.h"

int main(int argc, char** argv) {
  return gnomon::runAsChild(argc, argv, {{gnomon::kDensityWork, gnomon::packedDensity}});
}
