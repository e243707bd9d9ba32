#pragma once
// Tests of whole pictures compare numbers in several scenes. Sanitizers look for mistakes of code, for which one scene
// does, and take several times as long: they see the first.

#include "base/sanitizers.h"

#include <initializer_list>
#include <vector>

namespace gnomon::test {

inline std::vector<const char*> scenesToTest(std::initializer_list<const char*> all) {
  std::vector<const char*> scenes = all;
  if (kHasSanitizers) scenes.resize(1);
  return scenes;
}

}  // namespace gnomon::test
