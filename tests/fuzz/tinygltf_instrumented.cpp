// tinygltf compiled with the fuzzer's instrumentation, so that its own reads are checked too. It stands in
// for the packaged shared library, which is not instrumented. Images never reach it, so it needs no decoder.
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>
