// Where the program limits the memory of a process (base/child.h), this one's `new` throws.

#include <cstddef>
#include <cstdlib>
#include <new>

#include <sanitizer/allocator_interface.h>

namespace {

constexpr size_t kMostBytes = size_t{1} << 30;

void* allocate(size_t bytes) {
  if (bytes > kMostBytes || __sanitizer_get_current_allocated_bytes() + bytes > kMostBytes) throw std::bad_alloc();
  if (void* memory = std::malloc(bytes == 0 ? 1 : bytes)) return memory;
  throw std::bad_alloc();
}

}  // namespace

void* operator new(size_t bytes) {
  return allocate(bytes);
}
void* operator new[](size_t bytes) {
  return allocate(bytes);
}
void* operator new(size_t bytes, const std::nothrow_t&) noexcept {
  return std::malloc(bytes);
}
void* operator new[](size_t bytes, const std::nothrow_t&) noexcept {
  return std::malloc(bytes);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, size_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, size_t) noexcept {
  std::free(memory);
}
