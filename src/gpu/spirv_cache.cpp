#include "gpu/spirv_cache.h"

#include "base/error.h"
#include "base/file.h"
#include "gpu/shader_compiler.h"

#include <atomic>
#include <cstring>
#include <string>

#include <fmt/format.h>

namespace gnomon::gpu {

namespace {

constexpr uint32_t kMagic = 0x53564e47;  // "GNVS" in the file
constexpr uint32_t kFormatVersion = 1;

struct Header {
  uint32_t magic = kMagic;
  uint32_t formatVersion = kFormatVersion;
  Hash128 key{};
  Hash128 checksum{};  // of the words
  uint64_t wordCount = 0;
};
static_assert(sizeof(Header) == 48);

std::filesystem::path cacheFile(const Hash128& key) {
  const std::filesystem::path folder = cacheDirectory();
  return folder.empty() ? folder : folder / "spirv" / fmt::format("{:016x}{:016x}.spv", key[0], key[1]);
}

std::string_view bytesOf(const std::vector<uint32_t>& words) {
  return {reinterpret_cast<const char*>(words.data()), words.size() * sizeof(uint32_t)};
}

}  // namespace

Hash128 hashText(std::string_view text) {
  __extension__ using Wide = unsigned __int128;
  Wide hash = (static_cast<Wide>(0x6c62272e07bb0142) << 64) | 0x62b821756295c58d;
  const Wide prime = (static_cast<Wide>(1) << 88) | 0x13b;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * prime;
  return {static_cast<uint64_t>(hash >> 64), static_cast<uint64_t>(hash)};
}

std::optional<std::vector<uint32_t>> readCachedSpirv(const Hash128& key) {
  const std::filesystem::path path = cacheFile(key);
  std::error_code failure;
  if (path.empty() || !std::filesystem::is_regular_file(path, failure)) return std::nullopt;
  std::string bytes;
  try {
    bytes = readFile(path);
  } catch (const WorldError&) {
    return std::nullopt;
  }
  Header header;
  if (bytes.size() < sizeof(header)) return std::nullopt;
  std::memcpy(&header, bytes.data(), sizeof(header));
  const std::string_view body = std::string_view(bytes).substr(sizeof(header));
  if (header.magic != kMagic || header.formatVersion != kFormatVersion || header.key != key) return std::nullopt;
  if (body.empty() || body.size() % sizeof(uint32_t) != 0) return std::nullopt;
  if (header.wordCount != body.size() / sizeof(uint32_t) || header.checksum != hashText(body)) return std::nullopt;
  std::vector<uint32_t> spirv(header.wordCount);
  std::memcpy(spirv.data(), body.data(), body.size());
  return spirv;
}

void writeCachedSpirv(const Hash128& key, const std::vector<uint32_t>& spirv) {
  const std::filesystem::path path = cacheFile(key);
  if (path.empty()) return;
  Header header;
  header.key = key;
  header.checksum = hashText(bytesOf(spirv));
  header.wordCount = spirv.size();
  std::string bytes(reinterpret_cast<const char*>(&header), sizeof(header));
  bytes += bytesOf(spirv);
  try {
    writeTextFile(path, bytes);
  } catch (const WorldError&) {
    // Without the cache the next start compiles again, which is slower and not wrong.
  }
}

}  // namespace gnomon::gpu
