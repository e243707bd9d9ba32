// gnomon-reader: what gnomon has done in a process of its own (base/child.h), with files that nobody vouches for.
#include "base/child.h"
#include "shadow/user_bias_check.h"
#include "vsv/media/density_file.h"

int main(int argc, char** argv) {
  using namespace gnomon;
  return runAsChild(argc, argv, {{kUserBiasWork, compiledUserBias}, {kDensityWork, packedDensity}});
}
