#pragma once
// XXH3 of 128 bits (https://xxhash.com), as 32 hexadecimal digits: what tells contents apart. It keeps out nobody.

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace gnomon {

class ContentHash {
 public:
  ContentHash();
  ~ContentHash();
  ContentHash(const ContentHash&) = delete;
  ContentHash& operator=(const ContentHash&) = delete;

  // Each is told from its neighbours: texts and lists go in with their lengths.
  void add(std::string_view text);
  void add(const std::string& text) { add(std::string_view(text)); }
  void add(const char* text) { add(std::string_view(text)); }
  template <typename T>
  requires std::is_arithmetic_v<T>
  void add(T value) { addBytes(&value, sizeof(value)); }
  // Of types without padding.
  template <typename T>
  void addValues(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    add(values.size());
    addBytes(values.data(), values.size_bytes());
  }

  std::string digits() const;

 private:
  void addBytes(const void* bytes, size_t size);
  struct State;
  std::unique_ptr<State> state_;
};

std::string hashOf(std::string_view bytes);

}  // namespace gnomon
