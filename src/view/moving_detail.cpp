#include "view/moving_detail.h"

#include <array>

namespace gnomon {

namespace {

// Few, so that what is made for a size is made once.
constexpr std::array kShares = {1.0, 0.75, 0.5, 0.375, 0.25};
constexpr int kMostHalvings = 3;
// More is tried where it should take less than this share of the budget, less where a picture takes more than that.
constexpr double kRoomToGrow = 0.8, kTooLong = 1.15;
constexpr int kPatience = 60;

double ofPixels(double ms, double ratio) {
  return ms * ratio * ratio;
}

}  // namespace

double MovingDetail::share() const {
  return kShares[level_];
}

// Foretells the times of what is drawn next. False where there is no less.
bool MovingDetail::shrink(PictureTimes& times) {
  const bool hasLess = level_ + 1 < kShares.size();
  if (halvings_ < kMostHalvings && (times.maps > 0.5 * times.all || !hasLess)) {
    ++halvings_;
    times.all -= 0.75 * times.maps;
    times.maps *= 0.25;
    return true;
  }
  if (!hasLess) return false;
  times.all = times.maps + ofPixels(times.all - times.maps, kShares[level_ + 1] / kShares[level_]);
  ++level_;
  return true;
}

void MovingDetail::begin(double budgetMs, PictureTimes times) {
  level_ = 0;
  halvings_ = patience_ = 0;
  while (times.all > budgetMs && shrink(times)) {
  }
}

void MovingDetail::follow(double budgetMs, const PictureTimes& times) {
  if (patience_ > 0) --patience_;
  if (times.all > kTooLong * budgetMs) {
    PictureTimes next = times;
    while (next.all > budgetMs && shrink(next)) patience_ = kPatience;
    return;
  }
  if (patience_ > 0) return;
  const double room = kRoomToGrow * budgetMs, rest = times.all - times.maps;
  if (halvings_ > 0 && times.all + 3.0 * times.maps < room)
    --halvings_;
  else if (level_ > 0 && times.maps + ofPixels(rest, kShares[level_ - 1] / kShares[level_]) < room)
    --level_;
}

}  // namespace gnomon
