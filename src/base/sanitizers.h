#pragma once
// Whether AddressSanitizer is in: g++ tells it by a macro, clang++ by a feature.

namespace gnomon {

#if defined(__SANITIZE_ADDRESS__)
#define GNOMON_HAS_SANITIZERS 1
#elif defined(__has_feature)
#define GNOMON_HAS_SANITIZERS __has_feature(address_sanitizer)
#else
#define GNOMON_HAS_SANITIZERS 0
#endif

inline constexpr bool kHasSanitizers = GNOMON_HAS_SANITIZERS;

}  // namespace gnomon
