#pragma once
// A process that computes and does nothing else.

namespace gnomon {

#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool kHasSanitizers = true;
#elif defined(__has_feature)
inline constexpr bool kHasSanitizers = __has_feature(address_sanitizer);
#else
inline constexpr bool kHasSanitizers = false;
#endif

// From here on this process, and what it calls, has memory, time, the descriptors it may read, and writing into
// `result`, standard output and standard error. Whatever else it asks of the system (to open, start, signal, connect,
// or make memory executable) fails with EPERM (seccomp(2)). Memory that it shares with others it shares still. False
// where the system has no such filters.
bool enterSandbox(int result);

}  // namespace gnomon
