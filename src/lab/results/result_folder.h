#pragma once
// A folder of results while a run makes it. All is written aside, in a folder within it; when the run is done, the old
// results file goes, the files take their places, and the new results file comes last. So whatever ends a run early,
// the folder holds the old results whole, or (within the moment of moving) none; never those of two runs.

#include "base/file.h"
#include "lab/results/schema.h"

#include <filesystem>

namespace gnomon {

class ResultFolder {
 public:
  // No folder: nothing is made, and `aside` is empty. `index`: the results file. Throws WorldError where the folder
  // cannot be made or written, or another run writes there.
  ResultFolder(const std::filesystem::path& folder, const char* index);
  ~ResultFolder();
  ResultFolder(const ResultFolder&) = delete;
  ResultFolder& operator=(const ResultFolder&) = delete;

  // Where to write meanwhile; what is written below has its final place below the folder.
  const std::filesystem::path& aside() const { return aside_; }
  // Of all files written so far, in the order of paths.
  FileSums files() const;
  // What earlier runs left of files that their results file lists, and this run did not write again, is removed.
  void publish();

 private:
  void removeOldFiles(const FileSums& old, const FileSums& written) const;

  std::filesystem::path folder_, aside_, index_;
  bool isNew_ = false;  // the folder
  Descriptor lock_, asideLock_;
};

// Throws WorldError where a file is there, but has another checksum: it belongs to the results of another run.
void checkFiles(const std::filesystem::path& folder, const FileSums& files);

}  // namespace gnomon
