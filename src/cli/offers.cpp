#include "cli/offers.h"

#include <map>
#include <utility>

namespace gnomon {

namespace {

std::map<const CLI::Option*, Offers>& declared() {
  static std::map<const CLI::Option*, Offers> all;
  return all;
}

CLI::Option* declare(CLI::Option* option, Offers::Kind kind, std::vector<std::string> values) {
  declared()[option] = {.kind = kind, .values = std::move(values), .isFolder = nullptr};
  return option;
}

}  // namespace

CLI::Option* offersOneOf(CLI::Option* option, std::vector<std::string> values) {
  return declare(option, Offers::Kind::OneOf, std::move(values));
}

CLI::Option* offersSomeOf(CLI::Option* option, std::vector<std::string> values) {
  return declare(option, Offers::Kind::SomeOf, std::move(values));
}

CLI::Option* offersFiles(CLI::Option* option, std::vector<std::string> besides) {
  return declare(option, Offers::Kind::Files, std::move(besides));
}

CLI::Option* offersFolders(CLI::Option* option) {
  return declare(option, Offers::Kind::Folders, {});
}

CLI::Option* offersFilesOrFolder(CLI::Option* option, bool (*isFolder)(const std::string& value)) {
  declared()[option] = {.kind = Offers::Kind::Files, .values = {}, .isFolder = isFolder};
  return option;
}

const Offers& offersOf(const CLI::Option* option) {
  static const Offers kNone;
  const auto found = declared().find(option);
  return found == declared().end() ? kNone : found->second;
}

}  // namespace gnomon
