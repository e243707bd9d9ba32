#pragma once
// The store of a sweep: a SQLite file in WAL mode, one row a case and method. docs/sweep.md documents its views.
//
// A case is a light on a map of one size, in one picture of a scene. A row's key is a hash of everything that can
// change its counts; its slot is a hash of what the plan calls it. Where a slot's contents change (a scene was edited,
// the program is another), the row under the old key stays, and is marked superseded.

#include "lab/results/row.h"
#include "lab/store/sql.h"
#include "lab/store/workers.h"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gnomon {

inline constexpr int kStoreVersion = 1;
// The note that has how many pictures of each method are kept.
inline constexpr const char* kWorstPicturesNote = "worst pictures";

// The process that measures.
struct Machine {
  std::string program;         // "0.1.0 (abc1234)": who measured, in no key
  std::string results;         // what of the program determines counts (lab/sweep/results_version.h)
  std::string device, driver;  // Vulkan's
  std::string host;            // and processor: what times belong to
};

struct StoredCase {
  std::string key;
  std::string scene, sceneHash, sceneSource;
  size_t triangles = 0;
  double diagonal = 0.0;  // metres
  std::string light, lightType, camera;
  int width = 0, height = 0;  // pixels
  std::string map, mapOptions;
  int mapSize = 0;
  size_t lit = 0, marginFlipsHalf = 0, marginFlipsDouble = 0;
  std::optional<double> texel;  // metres
};

struct StoredTimes {
  double gbufferMs = 0.0, buildMs = 0.0, shadeMs = 0.0;
  int rounds = 0;
};

// Of one worst place: a PNG.
struct StoredPicture {
  std::string kind;  // "acne", "leak"
  std::string png;
};

struct StoredRow {
  std::string key, slot;
  std::string method;  // the bias, and what tells it apart: "constant offset=0.02", "constant tuned"
  Row row;             // map, light and pictures of it are not read
  std::optional<StoredTimes> times;
  std::vector<StoredPicture> pictures;
};

struct StoredMedium {
  std::string key, slot;
  std::string integrator;
  std::optional<int> steps;
  std::string map, medium;  // "sigma_s=0.08, sigma_a=0, g=0.2"
  std::optional<double> relRmse, relRmse99;
  std::string command;
  std::optional<StoredTimes> times;  // build, and integration as shadeMs
};

class Store {
 public:
  // Throws WorldError: it cannot be made, is none, or of another version. An empty file is one that is yet to be made.
  Store(const std::filesystem::path& path, sql::Open how);
  ~Store();
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  sql::Database& database() { return database_; }
  const sql::Database& database() const { return database_; }

  // From now on this process measures for the store, and may claim.
  void startWork(const Machine& machine);

  // Whether a row of this key is there. What it superseded, or what superseded it, changes places with it.
  bool has(const std::string& key, const std::string& slot);
  // Whether the case is known to light nothing.
  bool isEmpty(const std::string& caseKey) const;

  // No other living process has claimed it, and none will while this one lives and does not release it.
  bool claim(const std::string& work);
  void release(const std::string& work);

  // A case's rows, whole or not at all.
  void put(const StoredCase& of, const std::vector<StoredRow>& rows, const std::vector<StoredMedium>& media = {});
  void putEmpty(const StoredCase& of, const std::string& reason);
  void putFailure(const StoredCase& of, const std::string& message);

  // Removes all pictures but those of each method's worst places, and what nothing refers to.
  void keepWorstPictures(int perMethod);
  // Of each method the largest bias errors there are, up to so many, the largest first.
  std::map<std::string, std::vector<double>> worstErrors(int perMethod) const;

  void setNote(const std::string& name, const std::string& value);
  std::optional<std::string> note(const std::string& name) const;

 private:
  int64_t placeOf(const std::string& table, const std::vector<std::string>& names,
                  const std::vector<std::string>& values);
  void supersede(const char* table, const std::string& key, const std::string& slot);

  sql::Database database_;
  std::unique_ptr<Workers> workers_;
  Machine machine_;
  int64_t worker_ = 0;
};

// What a merge found.
struct MergeReport {
  size_t rows = 0, added = 0, superseded = 0;
  // A line each. Conflicts: the same key with other counts, of which the first store's are kept. Replaced: places of
  // the plan with other contents than in the stores before, which the last store's supersede; no clock is asked.
  // Mixtures: what stores of one sweep should have in common and do not.
  std::vector<std::string> conflicts, replaced, mixtures;
};

// Whether there is something to read at the path, which may still be no store. An empty file is a store that is yet to
// be made, as after a kill at its start.
bool isStoreThere(const std::filesystem::path& path);

// What keeps a path from being a store, before SQLite opens it: a folder, a device, an empty file where there must be
// rows, a file of another kind. Throws WorldError.
void checkStorePath(const std::filesystem::path& path, sql::Open how);

// All rows of `parts` in one new store, aside and renamed to `out`, which may be one of them. Throws WorldError,
// also where somebody works on `out`.
MergeReport mergeStores(const std::vector<std::filesystem::path>& parts, const std::filesystem::path& out);

// "Intel(R) Xeon(R), 2 cores" and the host's name.
std::string machineName();

}  // namespace gnomon
