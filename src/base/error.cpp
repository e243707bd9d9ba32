#include "base/error.h"

#include "base/message.h"

#include <fmt/format.h>

namespace gnomon {

WorldError fileError(const std::string& path, const std::string& what, const std::string& remedy) {
  return WorldError(fmt::format("{}: {}; {}", printable(path), what, remedy));
}

}  // namespace gnomon
