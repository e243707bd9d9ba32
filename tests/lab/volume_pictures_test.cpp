// Slices show the voxels they cut, and the volume's coordinates over a picture meet at the light.
#include "lab/volume/volume_pictures.h"

#include "scene/gbuffer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace gnomon {
namespace {

constexpr glsl::EpipolarGrid kGrid = {.eyeDistance = 4.0f,
                                      .alphaLower = 0.0f,
                                      .alphaStep = 0.02f,
                                      .thetaLower = -1.0f,
                                      .thetaStep = 0.02f,
                                      .phiLower = 0.0f,
                                      .phiStep = 0.02f,
                                      .alphaCount = 90,
                                      .thetaCount = 72,
                                      .phiCount = 128};

// Shadow from voxel 20 on where theta < 36, from 50 on elsewhere; nothing at phi >= 100.
ColumnBoundaries steps() {
  ColumnBoundaries boundaries{kGrid, std::vector<int>(columnCount(kGrid), kGrid.alphaCount)};
  for (int phi = 0; phi < 100; ++phi)
    for (int theta = 0; theta < kGrid.thetaCount; ++theta)
      boundaries.first[columnIndex(kGrid, theta, phi)] = theta < 36 ? 20 : 50;
  return boundaries;
}

int grey(const Image8& image, int x, int y) {
  const uint8_t* p = image.at(x, y);
  const bool isGrey = std::max({p[0], p[1], p[2]}) - std::min({p[0], p[1], p[2]}) < 16;
  return isGrey ? p[0] : -1;  // -1: a coloured line
}

TEST(VolumePictures, ASliceShowsItsVoxelsAndTheExactBoundary) {
  const ColumnBoundaries exact = steps();
  DenseVolume volume = volumeOf(exact);
  volume.flip(5, 10, 60);
  const Image8 theta = slicePicture(volume, exact, SliceAxis::Theta, 10);
  EXPECT_EQ(theta.width, kGrid.alphaCount);
  EXPECT_GT(theta.height, kGrid.phiCount);  // and the caption
  EXPECT_GT(grey(theta, 10, 50), 200);      // lit
  EXPECT_EQ(grey(theta, 20, 50), -1);       // the boundary
  EXPECT_LT(grey(theta, 30, 50), 100);      // shadowed
  EXPECT_GE(grey(theta, 30, 50), 0);
  EXPECT_EQ(grey(theta, 30, 99), -1);  // the boundary towards phi 100
  EXPECT_GT(grey(theta, 30, 110), 200);
  EXPECT_LT(grey(theta, 5, 60), 100);  // the flipped bit, which the exact boundary knows nothing of
  EXPECT_GT(grey(slicePicture(volume, exact, SliceAxis::Theta, 40), 30, 50), 200);

  const Image8 alpha = slicePicture(volume, exact, SliceAxis::Alpha, 30);
  EXPECT_EQ(alpha.width, kGrid.thetaCount);
  EXPECT_LT(grey(alpha, 10, 50), 100);
  EXPECT_GT(grey(alpha, 50, 50), 200);
  const Image8 phi = slicePicture(volume, exact, SliceAxis::Phi, 50);
  EXPECT_EQ(phi.width, kGrid.alphaCount);
  EXPECT_LT(grey(phi, 30, 10), 100);
  EXPECT_GT(grey(phi, 30, 50), 200);
}

TEST(VolumePictures, TheBusiestSliceIsTheOneWhereTheBoundaryMovesMost) {
  ColumnBoundaries exact = steps();
  EXPECT_EQ(busiestSlice(exact, SliceAxis::Alpha), 50);
  for (int phi = 0; phi < kGrid.phiCount; phi += 2) exact.first[columnIndex(kGrid, 33, phi)] = 30;
  EXPECT_EQ(busiestSlice(exact, SliceAxis::Theta), 33);
  for (int theta = 0; theta < kGrid.thetaCount; theta += 2) exact.first[columnIndex(kGrid, theta, 77)] = 60;
  EXPECT_EQ(busiestSlice(exact, SliceAxis::Phi), 77);
}

// The camera looks straight at the light: planes meet and shells are round in the picture's middle.
TEST(VolumePictures, CoordinatesMeetAtTheLight) {
  const glm::vec3 lightW(0.0f, 0.0f, -4.0f);
  const glsl::CameraView view = cameraView(lookAt("", {0, 0, 0}, lightW, 1.0f), 201, 201);
  const glsl::LightFrame frame{.originW = lightW, .rightW = {1, 0, 0}, .upW = {0, 1, 0}, .backW = {0, 0, 1}};
  const Image8 black(201, 201, 3, 0);
  const Image8 image = coordinatePicture(black, view, frame, kGrid);
  EXPECT_GT(image.height, 201);
  const auto isBlue = [&](int x, int y) { return image.at(x, y)[2] > 200; };
  const auto isYellow = [&](int x, int y) { return image.at(x, y)[0] > 200 && image.at(x, y)[1] > 200; };
  // 36 planes cut a circle of 80 pixels; one shell every 5 degrees from the middle outwards.
  int planes = 0, shells = 0;
  bool before = isBlue(100 + 80, 100);
  for (int i = 1; i <= 3600; ++i) {
    const double angle = i * glm::radians(0.1);
    const bool blue = isBlue(100 + static_cast<int>(std::lround(80 * std::cos(angle))),
                             100 + static_cast<int>(std::lround(80 * std::sin(angle))));
    planes += blue && !before;
    before = blue;
  }
  for (int x = 101; x < 201; ++x) shells += isYellow(x, 103) && !isYellow(x - 1, 103);
  EXPECT_NEAR(planes, 36, 2);
  // The picture's half width is tan(0.5 rad), 28.6 degrees.
  EXPECT_NEAR(shells, 5, 1);
  EXPECT_EQ(coordinatePicture(black, view, frame, kGrid).values, image.values);
}

}  // namespace
}  // namespace gnomon
