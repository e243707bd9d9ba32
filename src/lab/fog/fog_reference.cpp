#include "lab/fog/fog_reference.h"

#include "base/error.h"
#include "base/file.h"
#include "gpu/shader_compiler.h"

#include <cstdio>
#include <cstring>
#include <string>
#include <type_traits>

#include <fmt/format.h>

namespace gnomon {

namespace {

// Of the method: one more with every change that changes results.
constexpr uint32_t kMethodVersion = 2;
constexpr uint32_t kMagic = 0x524d4e47;  // "GNMR" in the file

struct Header {
  uint32_t magic = kMagic;
  uint32_t methodVersion = kMethodVersion;
  gpu::Hash128 key{};
  gpu::Hash128 checksum{};  // of what follows the header, with the numbers below
  int32_t width = 0, height = 0;
  double mean = 0.0, bound = 0.0, worstChange = 0.0, ms = 0.0;
  uint64_t atLimit = 0, rays = 0;
  int64_t doublings = 0;
};
static_assert(sizeof(Header) == 104 && std::is_trivially_copyable_v<Header>);

template <typename T>
void append(std::string& bytes, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

// Long arrays by their own hash, so that the whole needs no copy of the scene.
template <typename T>
void appendHash(std::string& bytes, std::span<const T> values) {
  append(bytes, values.size());
  append(bytes, gpu::hashText({reinterpret_cast<const char*>(values.data()), values.size_bytes()}));
}

// What rays can meet: shapes, and of materials what makes holes.
void appendScene(std::string& bytes, const Scene& scene) {
  for (const Mesh& mesh : scene.meshes) {
    appendHash(bytes, std::span<const glm::vec3>(mesh.positions));
    appendHash(bytes, std::span<const uint32_t>(mesh.indices));
    const Material& material = scene.materials[static_cast<size_t>(mesh.material)];
    append(bytes, material.alphaMode);
    if (material.alphaMode != AlphaMode::Mask) continue;
    appendHash(bytes, std::span<const glm::vec2>(mesh.uvs));
    append(bytes, material.alphaCutoff);
    append(bytes, material.baseColor);
    append(bytes, material.baseColorTexture);
    appendHash(bytes, std::span<const glsl::TextureInfo>(scene.textures));
    appendHash(bytes, std::span<const uint32_t>(scene.texels));
  }
  for (const Instance& instance : scene.instances) {
    append(bytes, instance.mesh);
    append(bytes, instance.worldFromMesh);
    append(bytes, instance.casts);
  }
}

gpu::Hash128 checksumOf(Header header, std::string_view body) {
  header.checksum = {};
  std::string bytes;
  append(bytes, header);
  append(bytes, gpu::hashText(body));
  return gpu::hashText(bytes);
}

std::optional<MediaReference> readReference(const std::filesystem::path& path, const gpu::Hash128& key,
                                            const glsl::CameraView& camera) {
  const std::string bytes = readFile(path);
  Header header;
  if (bytes.size() < sizeof(header)) return std::nullopt;
  std::memcpy(&header, bytes.data(), sizeof(header));
  const std::string_view body = std::string_view(bytes).substr(sizeof(header));
  if (header.magic != kMagic || header.methodVersion != kMethodVersion || header.key != key) return std::nullopt;
  if (header.width != camera.width || header.height != camera.height) return std::nullopt;
  if (header.checksum != checksumOf(header, body)) return std::nullopt;
  MediaReference reference{.inScattered = ImageF(header.width, header.height, 3),
                           .mean = header.mean,
                           .bound = header.bound,
                           .worstChange = header.worstChange,
                           .atLimit = header.atLimit,
                           .doublings = static_cast<int>(header.doublings),
                           .rays = header.rays,
                           .ms = header.ms};
  if (body.size() != reference.inScattered.values.size() * sizeof(float)) return std::nullopt;
  std::memcpy(reference.inScattered.values.data(), body.data(), body.size());
  return reference;
}

// A cache that cannot be written is passed over.
void writeReference(const std::filesystem::path& path, const gpu::Hash128& key, const MediaReference& reference) {
  Header header{.key = key,
                .width = reference.inScattered.width,
                .height = reference.inScattered.height,
                .mean = reference.mean,
                .bound = reference.bound,
                .worstChange = reference.worstChange,
                .ms = reference.ms,
                .atLimit = reference.atLimit,
                .rays = reference.rays,
                .doublings = reference.doublings};
  const std::string body(reinterpret_cast<const char*>(reference.inScattered.values.data()),
                         reference.inScattered.values.size() * sizeof(float));
  header.checksum = checksumOf(header, body);
  std::string bytes;
  append(bytes, header);
  try {
    writeTextFile(path, bytes + body);
  } catch (const WorldError& error) {
    std::fprintf(stderr, "gnomon: the reference could not be cached: %s\n", error.what());
  }
}

}  // namespace

gpu::Hash128 referenceKey(const SceneView& scene, const FogView& view, const MediaReferenceOptions& options) {
  std::string bytes = fmt::format("media reference, version {}", kMethodVersion);
  appendScene(bytes, scene.scene());
  for (const MediaLight& light : view.exactLights) {
    append(bytes, light.positionW);
    append(bytes, light.intensity);
    append(bytes, light.axisW);
    append(bytes, light.cosCone);
  }
  append(bytes, scene.view());
  appendHash(bytes, std::span<const double>(view.ends));
  append(bytes, view.model.sigmaS);
  append(bytes, view.model.sigmaA);
  append(bytes, view.model.g);
  if (view.density) {
    appendHash(bytes, view.density->nanoVdb());
    append(bytes, view.density->place());
  }
  append(bytes, options.bound);
  append(bytes, options.firstSamples);
  append(bytes, options.mostDoublings);
  return gpu::hashText(bytes);
}

std::filesystem::path referenceFile(const gpu::Hash128& key) {
  const std::filesystem::path folder = gpu::cacheDirectory();
  return folder.empty() ? folder : folder / "media" / fmt::format("{:016x}{:016x}.reference", key[0], key[1]);
}

KeptReference referenceFor(const SceneView& scene, const FogView& view, const MediaReferenceOptions& options,
                           bool cache) {
  const gpu::Hash128 key = referenceKey(scene, view, options);
  const std::filesystem::path path = cache ? referenceFile(key) : std::filesystem::path();
  std::error_code failure;
  if (!path.empty() && std::filesystem::is_regular_file(path, failure)) {
    if (std::optional<MediaReference> kept = readReference(path, key, scene.view()))
      return {.reference = std::move(*kept), .fromCache = true};
    std::fprintf(stderr, "gnomon: %s: the cached reference is damaged; tracing it again\n", path.string().c_str());
  }
  KeptReference made{.reference = computeMediaReference(scene.tracer(), view.exactLights, scene.view(), view.ends,
                                                        view.model, options)};
  if (!path.empty()) writeReference(path, key, made.reference);
  return made;
}

}  // namespace gnomon
