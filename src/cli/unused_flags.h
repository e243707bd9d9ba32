#pragma once
// Flags that were given and change nothing, because what they belong to is not chosen: told, or refused.

#include <string>

namespace CLI {
class App;
}

namespace gnomon {

class UnusedFlags {
 public:
  explicit UnusedFlags(const CLI::App& verb) : verb_(verb) {}
  // Says so on standard error where the verb has this flag, and it was given, and is not used.
  void tellUnless(bool isUsed, const std::string& flag, const std::string& why) const;
  // The same as a mistake: throws UsageError.
  void refuseUnless(bool isUsed, const std::string& flag, const std::string& why) const;

 private:
  bool isGiven(const std::string& flag) const;
  const CLI::App& verb_;
};

}  // namespace gnomon
