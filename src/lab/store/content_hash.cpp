#include "lab/store/content_hash.h"

#include <xxhash.h>

#include <fmt/format.h>

namespace gnomon {

struct ContentHash::State {
  struct Free {
    void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
  };
  std::unique_ptr<XXH3_state_t, Free> xxh{XXH3_createState()};
};

ContentHash::ContentHash() : state_(std::make_unique<State>()) {
  XXH3_128bits_reset(state_->xxh.get());
}

ContentHash::~ContentHash() = default;

void ContentHash::add(std::string_view text) {
  add(text.size());
  addBytes(text.data(), text.size());
}

void ContentHash::addBytes(const void* bytes, size_t size) {
  if (size > 0) XXH3_128bits_update(state_->xxh.get(), bytes, size);
}

std::string ContentHash::digits() const {
  const XXH128_hash_t hash = XXH3_128bits_digest(state_->xxh.get());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

std::string hashOf(std::string_view bytes) {
  ContentHash hash;
  hash.add(bytes);
  return hash.digits();
}

}  // namespace gnomon
