#pragma once
// The first stage of loading glTF: unpacks the container, checks the JSON, removes what Gnomon does not read, and only
// then calls tinygltf. Internal to the loader.

#include "scene/gltf.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace tinygltf {
class Model;
}

namespace gnomon {

// An entry of "images". tinygltf never sees these: only those that a base colour uses are fetched and decoded.
struct GltfImage {
  std::string name;
  std::string uri;  // relative to the file, or a data: URI; empty where bufferView is given
  int bufferView = -1;
};

class GltfDocument {
 public:
  // Throws WorldError. `folder` is where relative URIs lead; empty: there are no other files.
  GltfDocument(std::string_view bytes, std::string name, std::filesystem::path folder, GltfOptions options);
  ~GltfDocument();
  GltfDocument(const GltfDocument&) = delete;
  GltfDocument& operator=(const GltfDocument&) = delete;

  const std::string& name() const { return name_; }
  const GltfOptions& options() const { return options_; }
  const tinygltf::Model& model() const { return *model_; }
  const std::vector<GltfImage>& images() const { return images_; }
  // What a person should know about the file, a line each; the loader's later stages add theirs.
  std::vector<std::string> notes, harmlessNotes;

  // The bytes of a bufferView, decompressed where it is compressed. Throws WorldError.
  std::span<const unsigned char> viewBytes(int bufferView);

  // The bytes of an encoded image. Throws WorldError.
  std::string imageBytes(int image);

  // "what; remedy" about this file, as an exception.
  [[noreturn]] void refuse(const std::string& what, const std::string& remedy) const;

  // To be called before memory for the scene is asked for: refuses a file whose accessors are shared so often
  // that they unfold to a great multiple of its own size.
  void spend(uint64_t bytes);

 private:
  void readBuffers(const nlohmann::json& buffers, std::optional<std::string_view> binary);

  std::string name_;
  std::filesystem::path folder_;
  GltfOptions options_;
  std::unique_ptr<tinygltf::Model> model_;
  std::vector<GltfImage> images_;
  std::map<int, std::vector<unsigned char>> unpackedViews_;
  uint64_t budget_ = 0;  // bytes
};

}  // namespace gnomon
