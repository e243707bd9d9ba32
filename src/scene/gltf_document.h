#pragma once
// The first stage of loading glTF: unpacks the container, checks the JSON, removes what Gnomon does not read, and only
// then calls tinygltf. Internal to the loader.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

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
  GltfDocument(std::string_view bytes, std::string name, std::filesystem::path folder);
  ~GltfDocument();
  GltfDocument(const GltfDocument&) = delete;
  GltfDocument& operator=(const GltfDocument&) = delete;

  const std::string& name() const { return name_; }
  const tinygltf::Model& model() const { return *model_; }
  const std::vector<GltfImage>& images() const { return images_; }

  // The bytes of an encoded image. Throws WorldError.
  std::string imageBytes(int image) const;

  // "what; remedy" about this file, as an exception.
  [[noreturn]] void refuse(const std::string& what, const std::string& remedy) const;

  // To be called before memory for the scene is asked for: refuses a file whose accessors are shared so often
  // that they unfold to a great multiple of its own size.
  void spend(uint64_t bytes);

 private:
  std::string name_;
  std::filesystem::path folder_;
  std::unique_ptr<tinygltf::Model> model_;
  std::vector<GltfImage> images_;
  uint64_t budget_ = 0;  // bytes
};

}  // namespace gnomon
