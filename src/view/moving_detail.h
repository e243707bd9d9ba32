#pragma once
// How much of a picture is drawn while something moves, so that it takes no longer than a time budget: fewer pixels, or
// maps of fewer texels, of whichever takes more.

#include <cstddef>

namespace gnomon {

// What a picture took, wall clock, milliseconds.
struct PictureTimes {
  double all = 0.0;
  double maps = 0.0;  // of it: what fewer texels make shorter, not fewer pixels
};

class MovingDetail {
 public:
  double share() const;                       // of the picture's side
  int halvings() const { return halvings_; }  // of the maps' sides

  // From a picture in full: a guess.
  void begin(double budgetMs, PictureTimes times);
  // From a picture of this detail. What turned out to take too long is not tried again soon.
  void follow(double budgetMs, const PictureTimes& times);
  void forgetPatience() { patience_ = 0; }

 private:
  bool shrink(PictureTimes& times);

  size_t level_ = 0;
  int halvings_ = 0;
  int patience_ = 0;  // pictures until more is tried
};

}  // namespace gnomon
