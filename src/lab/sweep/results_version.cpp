#include "lab/sweep/results_version.h"

#include "gpu/embedded_shaders.h"
#include "lab/store/content_hash.h"

#include <fmt/format.h>

namespace gnomon {

std::string withoutComments(std::string_view glsl) {
  std::string text;
  const auto blank = [&](char c) {
    if (text.empty() || text.back() == '\n') return;
    if (text.back() == ' ' && c == '\n') text.back() = '\n';
    if (text.back() != ' ' && text.back() != '\n') text += c;
  };
  for (size_t i = 0; i < glsl.size(); ++i) {
    const std::string_view rest = glsl.substr(i);
    if (rest.starts_with("//")) {
      i += std::min(rest.find('\n'), rest.size()) - 1;
    } else if (rest.starts_with("/*")) {
      i += std::min(rest.find("*/", 2), rest.size() - 2) + 1;
      blank(' ');
    } else if (rest[0] == ' ' || rest[0] == '\t' || rest[0] == '\r') {
      blank(' ');
    } else if (rest[0] == '\n') {
      blank('\n');
    } else {
      text += rest[0];
    }
  }
  return text;
}

std::string resultsVersion() {
  static const std::string shaders = [] {
    ContentHash hash;
    for (size_t i = 0; i < gpu::kEmbeddedShaderCount; ++i) {
      const std::string_view path = gpu::kEmbeddedShaders[i].path;
      if (path.starts_with("bench/")) continue;
      hash.add(path);
      hash.add(withoutComments(gpu::kEmbeddedShaders[i].text));
    }
    return hash.digits().substr(0, 16);
  }();
  return fmt::format("{}-{}", kCountsVersion, shaders);
}

}  // namespace gnomon
