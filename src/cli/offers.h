#pragma once
// What a shell may offer after a flag, declared where the flag is. Completion is made of it (completion.h).

#include <string>
#include <vector>

namespace CLI {
class Option;
}

namespace gnomon {

struct Offers {
  enum class Kind { Nothing, Files, Folders, OneOf, SomeOf };  // SomeOf: "a,b"
  Kind kind = Kind::Nothing;
  std::vector<std::string> values;  // of the last two; beside files where they are Files
  // Of Files: whether a value names a folder; null: none does.
  bool (*isFolder)(const std::string& value) = nullptr;
};

// Returns the option, so that it can stand where the option is made.
CLI::Option* offersOneOf(CLI::Option* option, std::vector<std::string> values);
CLI::Option* offersSomeOf(CLI::Option* option, std::vector<std::string> values);
CLI::Option* offersFiles(CLI::Option* option, std::vector<std::string> besides = {});
CLI::Option* offersFolders(CLI::Option* option);
// Files, or a folder where `isFolder` says so of the value.
CLI::Option* offersFilesOrFolder(CLI::Option* option, bool (*isFolder)(const std::string& value));

// Nothing where nothing was declared.
const Offers& offersOf(const CLI::Option* option);

}  // namespace gnomon
