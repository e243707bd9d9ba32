#pragma once
// Stores with rows of which only the names matter, for store_test.cpp and the processes that it starts.

#include "lab/store/store.h"

#include <filesystem>
#include <string>
#include <vector>

namespace gnomon::test {

inline const Machine kMachine{
    .program = "test", .results = "1-a", .device = "device", .driver = "driver", .host = "host"};

inline StoredCase caseOf(const std::string& key) {
  return {.key = key,
          .scene = "scene",
          .sceneHash = "h",
          .sceneSource = "s",
          .light = "l",
          .lightType = "point",
          .camera = "c",
          .width = 8,
          .height = 8,
          .map = "cube",
          .mapSize = 64};
}

inline StoredRow rowOf(const std::string& key, const std::string& slot, size_t acne = 1) {
  StoredRow stored{.key = key, .slot = slot, .method = "none"};
  stored.row.bias = "none";
  stored.row.scored = 100;
  stored.row.agree = 100 - acne;
  stored.row.acne = acne;
  stored.times = StoredTimes{.gbufferMs = 1, .buildMs = 2, .shadeMs = 3, .rounds = 4};
  return stored;
}

inline void fill(const std::filesystem::path& path, const std::vector<StoredRow>& rows) {
  Store store(path, sql::Open::Create);
  store.startWork(kMachine);
  store.put(caseOf("case"), rows);
}

}  // namespace gnomon::test
