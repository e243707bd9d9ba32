#pragma once
// An array with one element a pixel that is written by many threads at once: std::vector but that growing it writes
// nothing and asks for large pages. What the system gives is zero; the pages of an array of 56 bytes a pixel, taken and
// cleared by one thread before the others begin, cost more than tracing the shadow of every pixel.

#include <sys/mman.h>

#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace gnomon {

template <typename T>
struct PixelAllocator {
  using value_type = T;
  static constexpr std::size_t kPageBytes = 2u << 20;

  PixelAllocator() = default;
  template <typename U>
  explicit PixelAllocator(const PixelAllocator<U>&) {}

  T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    if (bytes < kPageBytes) return std::allocator<T>().allocate(count);
    void* memory = std::aligned_alloc(kPageBytes, (bytes + kPageBytes - 1) / kPageBytes * kPageBytes);
    if (memory == nullptr) throw std::bad_alloc();
    ::madvise(memory, bytes, MADV_HUGEPAGE);  // a wish: without it the array is as good, and slower
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t count) {
    if (count * sizeof(T) < kPageBytes) return std::allocator<T>().deallocate(memory, count);
    std::free(memory);
  }
  // resize() leaves new elements as they are.
  template <typename U>
  void construct(U*) {
    static_assert(std::is_trivially_destructible_v<U>);
  }
  template <typename U, typename... Args>
  void construct(U* at, Args&&... args) {
    ::new (static_cast<void*>(at)) U(std::forward<Args>(args)...);
  }
  bool operator==(const PixelAllocator&) const = default;
};

template <typename T>
using PerPixel = std::vector<T, PixelAllocator<T>>;

}  // namespace gnomon
