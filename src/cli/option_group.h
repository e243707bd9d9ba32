#pragma once
// The options that are added to a verb while one lives stand under its heading in --help and in the manual.

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

namespace gnomon {

class OptionGroup {
 public:
  OptionGroup(CLI::App& verb, std::string heading)
      : verb_(verb), heading_(std::move(heading)), before_(verb.get_options()) {}
  ~OptionGroup() {
    for (CLI::Option* option : verb_.get_options())
      if (option->get_lnames().size() + option->get_snames().size() > 0 &&
          std::find(before_.begin(), before_.end(), option) == before_.end())
        option->group(heading_);
  }
  OptionGroup(const OptionGroup&) = delete;
  OptionGroup& operator=(const OptionGroup&) = delete;

 private:
  CLI::App& verb_;
  std::string heading_;
  std::vector<CLI::Option*> before_;
};

}  // namespace gnomon
