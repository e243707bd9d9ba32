// Macros that make one source both GLSL and C++: the only file with #ifdef __cplusplus. The dialect that all three
// compilers accept is in docs/shared_glsl.md.
#ifndef GNOMON_LANG_GLSL
#define GNOMON_LANG_GLSL

#ifdef __cplusplus

#include <bit>
#include <cmath>
#include <cstdint>

#include <glm/glm.hpp>

// In C++ every shared struct and function lives in gnomon::glsl.
#define GNOMON_SHARED_BEGIN \
  namespace gnomon::glsl {  \
  using namespace glm;
#define GNOMON_SHARED_END }
#define GNOMON_FN inline
#define GNOMON_OUT(T) T&
#define GNOMON_INOUT(T) T&
#define GNOMON_CPP_ONLY(text) text
#define GNOMON_GLSL_ONLY(text)
#define GNOMON_PRECISE
// An array that is a member of a struct in C++ and stands alone in a buffer in GLSL: a struct that is passed by
// value and indexed by a variable would be copied to memory by every shader invocation (measured: a visibility
// pass 3 to 5 times slower).
#define GNOMON_MEMBER_ARRAY(object, array) (object).array

GNOMON_SHARED_BEGIN
inline float uintBitsToFloat(uint bits) { return std::bit_cast<float>(bits); }
inline uint floatBitsToUint(float value) { return std::bit_cast<uint>(value); }
inline float atan2(float y, float x) { return std::atan2(y, x); }
GNOMON_SHARED_END

#else

#define GNOMON_SHARED_BEGIN
#define GNOMON_SHARED_END
#define GNOMON_FN
#define GNOMON_OUT(T) out T
#define GNOMON_INOUT(T) inout T
#define GNOMON_CPP_ONLY(text)
#define GNOMON_GLSL_ONLY(text) text
// Before a variable whose sums and products must be rounded one by one; C++ is built so that all are.
#define GNOMON_PRECISE precise
#define GNOMON_MEMBER_ARRAY(object, array) array
#define atan2(y, x) atan(y, x)

#endif

// What only the headers for other renderers have (docs/glsl.md): Gnomon's own shaders have one map each.
#define GNOMON_PUBLIC_ONLY(text)
#endif
