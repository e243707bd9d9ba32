#pragma once
// SPIR-V on disk under a 128-bit hash of everything that decides it. A file that is cut short, changed or of
// another version counts as absent.

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace gnomon::gpu {

// FNV-1a, 128 bits, as two words, the high one first (Fowler, Noll, Vo, Eastlake: "The FNV Non-Cryptographic Hash
// Algorithm", section 5). It tells sources apart; it does not keep out somebody who can write to the cache.
using Hash128 = std::array<uint64_t, 2>;
Hash128 hashText(std::string_view text);

std::optional<std::vector<uint32_t>> readCachedSpirv(const Hash128& key);

// A cache that cannot be written is passed over.
void writeCachedSpirv(const Hash128& key, const std::vector<uint32_t>& spirv);

}  // namespace gnomon::gpu
