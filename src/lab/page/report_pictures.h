#pragma once
// A report's pictures as data URIs, each embedded once however often it is used.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace gnomon {

struct EmbeddedPicture {
  std::string id;       // of the one <img> that holds it
  std::string dataUri;  // empty when an earlier call embedded it
  int width = 0, height = 0;
};

class ReportPictureShelf {
 public:
  explicit ReportPictureShelf(std::filesystem::path folder) : folder_(std::move(folder)) {}

  // PNG files as they are; where `asJpeg`, encoded again as JPEG, which takes a fifth of the room. Nothing
  // where `path` leaves the folder, names no PNG or cannot be read; it is then listed in `missing`.
  std::optional<EmbeddedPicture> embed(const std::string& path, bool asJpeg);

  const std::vector<std::string>& missing() const { return missing_; }

 private:
  std::filesystem::path folder_;
  std::map<std::string, EmbeddedPicture> embedded_;  // by path; without the data
  std::vector<std::string> missing_;
};

}  // namespace gnomon
