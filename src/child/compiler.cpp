// gnomon-compiler: glslang on a bias that nobody vouches for (base/child.h).
#include "base/child.h"
#include "shadow/user_bias_check.h"

int main(int argc, char** argv) {
  return gnomon::runAsChild(argc, argv, {{gnomon::kUserBiasWork, gnomon::compiledUserBias}});
}
