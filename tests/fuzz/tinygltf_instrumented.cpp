// tinygltf compiled with the fuzzer's instrumentation, so that its own reads are checked too. It stands in
// for the packaged shared library, which is not instrumented. Images never reach it, so it is built without
// its decoders (CMakeLists.txt says so for all files alike).
#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
