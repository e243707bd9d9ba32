#pragma once
// Densities that follow one another, a file each: "smoke.####.vdb", where #### is the number of the frame.

#include <optional>
#include <string>

namespace gnomon {

class DensitySequence {
 public:
  // Whether there is a # in it.
  static bool isOne(const std::string& fileAndGrid);

  // `first`: the number of the first frame; absent: the least that there is a file of. Throws UsageError where the #s
  // are not together, WorldError where a file of the frames is not there.
  DensitySequence(const std::string& fileAndGrid, std::optional<int> first, int frames);

  int first() const { return first_; }
  // The file of a frame, counted from 0, and its grid, as DensityGrid takes it.
  std::string file(int frame) const;

 private:
  std::string before_, after_;
  size_t digits_ = 0;
  int first_ = 0;
};

}  // namespace gnomon
