// Heterogeneous media: OpenVDB grids read and placed, sampled on the GPU, and marched.
#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "media_fixture.h"
#include "shadow/visibility_pass.h"
#include "shared/march_steps.glsl"
#include "tests/run_kernel.h"
#include "vsv/media/generate_density.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <random>

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using test::MediaSetup;
using test::MediaWorld;
using test::relativeRmse;
using test::TemporaryFolder;

openvdb::FloatGrid::Ptr gridOf(const openvdb::CoordBBox& box, const std::function<float(const openvdb::Coord&)>& at,
                               const openvdb::math::Transform::Ptr& transform) {
  openvdb::initialize();
  const auto grid = openvdb::FloatGrid::create(0.0f);
  grid->setName("density");
  grid->setTransform(transform);
  for (auto it = box.begin(); it; ++it) grid->tree().setValueOn(*it, at(*it));
  return grid;
}

void write(const fs::path& path, const openvdb::GridCPtrVec& grids) {
  openvdb::io::File(path.string()).write(grids);
}

// Turned, of voxels with three lengths, away from the origin.
openvdb::math::Transform::Ptr awkwardTransform() {
  const auto transform = openvdb::math::Transform::createLinearTransform(1.0);
  transform->preScale(openvdb::Vec3d(0.2, 0.3, 0.5));
  transform->postRotate(0.7, openvdb::math::Y_AXIS);
  transform->postRotate(-0.4, openvdb::math::X_AXIS);
  transform->postTranslate(openvdb::Vec3d(3.0, -2.0, 5.0));
  return transform;
}

class DensityGridTest : public ::testing::Test {
 protected:
  const TemporaryFolder folder_;
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  std::string mistake(const std::string& fileAndGrid) const {
    try {
      const DensityGrid grid(fileAndGrid, {});
    } catch (const WorldError& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      EXPECT_NE(message.find(fileAndGrid.substr(0, fileAndGrid.find(".vdb"))), std::string::npos) << message;
      return message;
    }
    return "";
  }
};

// Trilinear interpolation gives a linear field back exactly, wherever the file puts it.
TEST_F(DensityGridTest, ValuesAreWhereTheFileHasThem) {
  const auto transform = awkwardTransform();
  const auto linear = [](const openvdb::Vec3d& at) { return 10.0 + 0.5 * at.x() - 0.25 * at.y() + 0.125 * at.z(); };
  write(path("a.vdb"),
        {gridOf(
            openvdb::CoordBBox({-5, -4, -9}, {6, 14, 7}),
            [&](const openvdb::Coord& at) { return static_cast<float>(linear(at.asVec3d())); }, transform)});
  const DensityGrid grid(path("a.vdb"), {});
  EXPECT_NEAR(grid.voxelMetres(), 0.2, 1e-9);
  EXPECT_EQ(grid.activeVoxels(), 12u * 19u * 17u);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int n = 0; n < 5000; ++n) {
    const openvdb::Vec3d index(-5 + 11 * unit(random), -4 + 18 * unit(random), -9 + 16 * unit(random));
    const openvdb::Vec3d world = transform->indexToWorld(index);
    ASSERT_NEAR(grid.at({world.x(), world.y(), world.z()}), linear(index), 1e-5);
    const Bounds bounds = grid.boundsW();
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_GT(world[axis], bounds.lower[axis]);
      ASSERT_LT(world[axis], bounds.upper[axis]);
    }
  }
  EXPECT_EQ(grid.at({100, 0, 0}), 0.0);
}

TEST_F(DensityGridTest, IsScaledAboutItsCentreAndThenMoved) {
  const auto transform = openvdb::math::Transform::createLinearTransform(0.5);
  write(path("a.vdb"), {gridOf(
                           openvdb::CoordBBox({0, 0, 0}, {9, 9, 9}),
                           [&](const openvdb::Coord& at) { return static_cast<float>(at.x()); }, transform)});
  const DensityGrid still(path("a.vdb"), {}), scaled(path("a.vdb"), {.scale = 3.0}),
      moved(path("a.vdb"), {.scale = 3.0, .centerW = glm::dvec3(10, 20, 30)});
  EXPECT_NEAR(glm::length(still.boundsW().center() - scaled.boundsW().center()), 0.0, 1e-6);
  EXPECT_NEAR(scaled.boundsW().diagonal(), 3.0 * still.boundsW().diagonal(), 1e-5);
  EXPECT_NEAR(glm::length(moved.boundsW().center() - glm::vec3(10, 20, 30)), 0.0, 1e-6);
  EXPECT_NEAR(moved.voxelMetres(), 1.5, 1e-9);
  const glm::dvec3 center(still.boundsW().center());
  for (const glm::dvec3& offset : {glm::dvec3(0.3, 0.1, -0.4), glm::dvec3(-1.2, 0.5, 0.7)}) {
    EXPECT_NEAR(still.at(center + offset), scaled.at(center + 3.0 * offset), 1e-6);
    EXPECT_NEAR(still.at(center + offset), moved.at(glm::dvec3(10, 20, 30) + 3.0 * offset), 1e-6);
    EXPECT_NEAR(still.at(center + offset), 4.5 + offset.x / 0.5, 1e-6);
  }
}

TEST_F(DensityGridTest, WhatIsBelowNothingIsNothing) {
  write(path("a.vdb"), {gridOf(
                           openvdb::CoordBBox({0, 0, 0}, {7, 7, 7}), [](const openvdb::Coord&) { return -1.0f; },
                           openvdb::math::Transform::createLinearTransform(1.0))});
  EXPECT_EQ(DensityGrid(path("a.vdb"), {}).at({3, 3, 3}), 0.0);
}

TEST_F(DensityGridTest, WhatCannotBeReadIsSaidInOneLine) {
  const auto transform = openvdb::math::Transform::createLinearTransform(1.0);
  const openvdb::CoordBBox box({0, 0, 0}, {15, 15, 15});
  const auto ones = gridOf(
      box, [](const openvdb::Coord&) { return 1.0f; }, transform);
  const auto named = [](const openvdb::GridBase::Ptr& grid, const char* name) {
    grid->setName(name);
    return grid;
  };
  EXPECT_NE(mistake(path("nowhere.vdb")).find("no such file"), std::string::npos);
  EXPECT_NE(mistake(path(".")).find("is no regular file; name one"), std::string::npos);
  {
    std::FILE* file = std::fopen(path("text.vdb").c_str(), "w");
    std::fputs("this is no grid\n", file);
    std::fclose(file);
  }
  EXPECT_NE(mistake(path("text.vdb")).find("cannot be read as OpenVDB"), std::string::npos);

  write(path("two.vdb"), {ones, named(ones->deepCopy(), "heat")});
  EXPECT_NE(mistake(path("two.vdb")).find("several grids"), std::string::npos);
  EXPECT_NE(mistake(path("two.vdb")).find("density, heat"), std::string::npos);
  EXPECT_NE(mistake(path("two.vdb:smoke")).find("no grid 'smoke'"), std::string::npos);
  EXPECT_NE(mistake(path("two.vdb:smoke")).find("density, heat"), std::string::npos);
  EXPECT_EQ(DensityGrid(path("two.vdb:heat"), {}).gridName(), "heat");

  const size_t whole = fs::file_size(path("two.vdb"));
  for (const size_t bytes : {size_t{5}, size_t{40}, size_t{200}, size_t{2000}, whole / 2, whole - 64}) {
    fs::copy_file(path("two.vdb"), path("cut.vdb"), fs::copy_options::overwrite_existing);
    fs::resize_file(path("cut.vdb"), bytes);
    EXPECT_NE(mistake(path("cut.vdb")), "") << bytes;
  }
  const auto vectors = openvdb::Vec3SGrid::create();
  vectors->tree().setValueOn({0, 0, 0}, {1, 2, 3});
  write(path("vectors.vdb"), {named(vectors, "velocity")});
  EXPECT_NE(mistake(path("vectors.vdb")).find("holds vec3s"), std::string::npos);
  write(path("empty.vdb"), {named(openvdb::FloatGrid::create(), "nothing")});
  EXPECT_NE(mistake(path("empty.vdb")).find("is empty"), std::string::npos);
  const auto level = ones->deepCopy();
  level->setGridClass(openvdb::GRID_LEVEL_SET);
  write(path("level.vdb"), {level});
  EXPECT_NE(mistake(path("level.vdb")).find("level set"), std::string::npos);
  for (const float bad : {NAN, INFINITY, -INFINITY}) {
    const auto grid = ones->deepCopy();
    grid->tree().setValueOn({3, 4, 5}, bad);
    write(path("bad.vdb"), {grid});
    EXPECT_NE(mistake(path("bad.vdb")).find("not finite"), std::string::npos);
  }
  const auto frustum = ones->deepCopy();
  frustum->setTransform(openvdb::math::Transform::createFrustumTransform(
      openvdb::BBoxd(openvdb::Vec3d(0), openvdb::Vec3d(15)), 0.5, 2.0));
  write(path("frustum.vdb"), {frustum});
  EXPECT_NE(mistake(path("frustum.vdb")).find("not affine"), std::string::npos);
}

// Counts and lengths that promise more than the file has, at every place of a file: an error of one line, or the grid.
TEST_F(DensityGridTest, WhateverAFileSaysOfItsSizesIsReadOrRefusedInOneLine) {
  const auto transform = openvdb::math::Transform::createLinearTransform(1.0);
  write(path("whole.vdb"),
        {gridOf(
            openvdb::CoordBBox({0, 0, 0}, {1, 1, 1}), [](const openvdb::Coord&) { return 1.0f; }, transform)});
  const std::string whole = readFile(path("whole.vdb"));
  ASSERT_EQ(mistake(path("whole.vdb")), "");
  size_t refused = 0;
  testing::internal::CaptureStderr();
  for (size_t at = 0; at + 4 <= std::min<size_t>(whole.size(), 1600); at += 8) {
    std::string bytes = whole;
    const uint32_t promise = at % 16 == 0 ? 0x7fffffffu : 0xfffffff0u;
    std::memcpy(bytes.data() + at, &promise, sizeof(promise));
    writeTextFile(path("hostile.vdb"), bytes);
    const std::string message = mistake(path("hostile.vdb"));
    EXPECT_LE(message.size(), kLongestMessage) << message;
    EXPECT_EQ(printable(message), message);
    if (!message.empty()) ++refused;
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_GT(refused, 20u);
}

TEST_F(DensityGridTest, AFileWithoutOffsetsAndOneOfInstancesAreReadToo) {
  const auto transform = openvdb::math::Transform::createLinearTransform(1.0);
  const openvdb::CoordBBox box({0, 0, 0}, {3, 4, 5});
  const auto first = gridOf(
      box, [](const openvdb::Coord&) { return 1.0f; }, transform);
  std::ofstream stream(path("stream.vdb"), std::ios::binary);
  openvdb::io::Stream(stream).write(openvdb::GridCPtrVec{first});
  stream.close();
  EXPECT_EQ(DensityGrid(path("stream.vdb"), {}).activeVoxels(), 4u * 5u * 6u);
  const auto second = first->copy();
  second->setName("again");
  openvdb::io::File file(path("instances.vdb"));
  file.setInstancingEnabled(true);
  file.write(openvdb::GridCPtrVec{first, second});
  for (const char* name : {"density", "again"})
    EXPECT_EQ(DensityGrid(path("instances.vdb:") + name, {}).activeVoxels(), 4u * 5u * 6u) << name;
}

TEST_F(DensityGridTest, GeneratedOnesAreTheSameEachTimeAndFillTheBounds) {
  const Bounds bounds{{-2, 0, 1}, {6, 3, 5}};
  for (const GeneratedDensity& kind : generatedDensities()) {
    const DensitySummary first = writeGeneratedDensity(kind.name, bounds, 7, path("a.vdb"));
    EXPECT_EQ(writeGeneratedDensity(kind.name, bounds, 7, path("b.vdb")).voxels, first.voxels);
    writeGeneratedDensity(kind.name, bounds, 8, path("c.vdb"));
    EXPECT_NEAR(first.voxelMetres, 8.0 / 128, 1e-12);
    const DensityGrid a(path("a.vdb"), {}), b(path("b.vdb"), {}), c(path("c.vdb"), {});
    std::mt19937 random(4);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    double sum = 0.0, most = 0.0, otherSeed = 0.0;
    for (int n = 0; n < 20000; ++n) {
      const glm::dvec3 at = glm::mix(glm::dvec3(bounds.lower), glm::dvec3(bounds.upper),
                                     glm::dvec3(unit(random), unit(random), unit(random)));
      const double value = a.at(at);
      ASSERT_EQ(value, b.at(at));
      sum += value;
      most = std::max(most, value);
      otherSeed += std::abs(value - c.at(at));
    }
    EXPECT_GT(sum, 200.0) << kind.name;
    EXPECT_GT(most, 0.5) << kind.name;
    EXPECT_LE(most, 2.0 + 1e-6) << kind.name;
    if (kind.name == std::string("turbulence"))
      EXPECT_GT(otherSeed, 0.3 * sum);
    else
      EXPECT_EQ(otherSeed, 0.0);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GT(a.boundsW().lower[axis], bounds.lower[axis] - 3.0 * first.voxelMetres);
      EXPECT_LT(a.boundsW().upper[axis], bounds.upper[axis] + 3.0 * first.voxelMetres);
    }
  }
  EXPECT_THROW(writeGeneratedDensity("steam", bounds, 1, path("d.vdb")), UsageError);
  EXPECT_THROW(writeGeneratedDensity("puff", Bounds{}, 1, path("d.vdb")), WorldError);
}

class DensityOnTheGpu : public gpu::GpuTest {
 protected:
  const TemporaryFolder folder_;
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
};

struct DensityQuery {
  glm::vec3 posI;
};

// Leaves of noise beside tiles of one value, and nothing between.
TEST_F(DensityOnTheGpu, IsThatOfTheCpu) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  const auto grid = gridOf(
      openvdb::CoordBBox({-20, -20, -20}, {20, 20, 20}), [&](const openvdb::Coord&) { return unit(random) - 0.2f; },
      openvdb::math::Transform::createLinearTransform(1.0));
  grid->tree().addTile(1, openvdb::Coord(8, 8, 8), 0.75f, true);
  grid->tree().addTile(2, openvdb::Coord(128, 0, 0), 0.5f, true);
  write(path("noise.vdb"), {grid});
  const DensityGrid density(path("noise.vdb"), {});
  const DensityBuffers buffers = createDensityBuffers(device(), density);
  std::vector<DensityQuery> queries(gpu::kKernelInputCount);
  const Bounds bounds = density.boundsW();
  for (size_t n = 0; n < queries.size(); ++n) {
    const glm::vec3 at(unit(random), unit(random), unit(random));
    queries[n].posI = n % 4 == 0 ? glm::mix(bounds.lower, bounds.upper, at) : (at - 0.5f) * 42.0f;
    if (n % 16 == 1) queries[n].posI = glm::floor(queries[n].posI);  // on voxels
  }
  const auto answers = gpu::runKernel<DensityQuery, float>(device(), GNOMON_TEST_SHADER("evaluate_density.comp.glsl"),
                                                           queries, {{glsl::kBindDensity, buffers.words}});
  size_t some = 0;
  for (size_t n = 0; n < queries.size(); ++n) {
    const double expected = density.at(glm::dvec3(queries[n].posI));
    ASSERT_NEAR(answers[n], expected, 1e-6) << n;  // eight products and sums of floats up to 1
    some += expected > 0.0 ? 1 : 0;
  }
  EXPECT_GT(some, queries.size() / 3);
}

// In a grid of ones that holds every view ray and the light, marching is marching the homogeneous medium, whose samples
// stand at equal distances, and where the way to light and eye is not summed and interpolated.
TEST_F(DensityOnTheGpu, AConstantGridIsTheHomogeneousMedium) {
  write(path("ones.vdb"),
        {gridOf(
            openvdb::CoordBBox({-22, -22, -22}, {22, 22, 22}), [](const openvdb::Coord&) { return 1.0f; },
            openvdb::math::Transform::createLinearTransform(1.0))});
  for (const char* scene : {"grate", "atrium"}) {
    MediaSetup setup = test::mediaSetup(scene);
    setup.medium.sigmaS *= 2.0f;
    setup.medium.sigmaA = setup.medium.sigmaS * glm::vec3(0.1f, 0.5f, 0.0f);
    setup.pictureSide = 64;
    MediaWorld homogeneous(device(), setup);
    setup.density = path("ones.vdb");
    MediaWorld dense(device(), setup);
    const double samples =
        relativeRmse(dense.scattered(mediaMethod("march", 1024)), homogeneous.scattered(mediaMethod("march", 4096)));
    const double runs =
        relativeRmse(dense.scattered(mediaMethod("runs", 1024)), homogeneous.scattered(mediaMethod("runs")));
    EXPECT_LT(samples, 3e-3);  // shadow edges fall between other samples
    EXPECT_LT(runs, 0.05);
  }
}

// Against the light's and the eye's depths summed anew for every sample, in double.
glm::dvec3 marched(const MediaWorld& world, const glm::dvec3& endW, int steps) {
  const glsl::Medium& medium = world.setup.medium;
  const MediaLightSource& light = world.setup.light;
  const glm::dvec3 eye(world.view.eyeW), sigmaT = glm::dvec3(medium.sigmaS) + glm::dvec3(medium.sigmaA);
  const double length = glm::length(endW - eye);
  const glm::dvec3 dir = (endW - eye) / length;
  const glm::vec2 within =
      glsl::rayWithinBounds(world.density->place(), world.view.eyeW, glm::vec3(dir), static_cast<float>(length));
  if (within.x >= within.y) return glm::dvec3(0.0);
  const double foot = glm::dot(light.positionW - eye, dir);
  const double aside = glm::length(light.positionW - eye - dir * foot);
  glsl::MarchSteps march =
      glsl::marchSteps(within.x, within.y, static_cast<float>(foot), static_cast<float>(aside), steps);
  double begin = within.x;
  double passed = 0.0;
  glm::dvec3 sum(0.0);
  for (int n = 0; n < steps; ++n) {
    const double end = glsl::nextStepEnd(march);
    const double s = foot + glsl::middleByAngle(static_cast<float>(begin - foot), static_cast<float>(end - foot),
                                                static_cast<float>(aside));
    const glm::dvec3 at = eye + dir * s, fromLight = at - light.positionW;
    const double density = world.density->at(at), here = density * (end - begin), r = glm::length(fromLight);
    const double inverseSquare = (std::atan((end - foot) / aside) - std::atan((begin - foot) / aside)) / aside;
    double toLight = 0.0;
    constexpr int kFine = 256;
    for (int i = 0; i < kFine && here > 0.0; ++i)
      toLight += world.density->at(light.positionW + fromLight * ((i + 0.5) / kFine)) * r / kFine;
    const double phase = glsl::phaseFunction(medium.g, static_cast<float>(-glm::dot(fromLight, dir) / r));
    sum += glm::dvec3(medium.sigmaS) * glm::exp(-sigmaT * (passed + 0.5 * here + toLight)) *
           (phase * inverseSquare * density);
    passed += here;
    begin = end;
  }
  return sum * glm::dvec3(light.intensity);
}

// A ray's steps follow one another from its begin to its end, and none is longer than the ray over half their number.
TEST(MarchSteps, CutTheRayWithoutGapsAndNoneIsLong) {
  std::mt19937 random(23);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  for (int i = 0; i < 20000; ++i) {
    const float begin = 3.0f * unit(random), end = begin + std::pow(10.0f, 4.0f * unit(random) - 2.0f);
    const float foot = begin + (end - begin) * (3.0f * unit(random) - 1.0f);
    const float aside = i % 4 == 0 ? 1e-6f : (end - begin) * unit(random);
    const int steps = 1 + static_cast<int>(random() % 100);
    glsl::MarchSteps march = glsl::marchSteps(begin, end, foot, aside, steps);
    float at = begin;
    for (int n = 0; n < steps; ++n) {
      const float next = glsl::nextStepEnd(march);
      ASSERT_GE(next, at);
      ASSERT_LE(next - at, (end - begin) / (0.5f * static_cast<float>(steps)) * 1.001f) << steps;
      const float middle = foot + glsl::middleByAngle(at - foot, next - foot, aside);
      ASSERT_GE(middle, at - 1e-5f * end);
      ASSERT_LE(middle, next + 1e-5f * end);
      at = next;
    }
    ASSERT_EQ(at, end);
  }
}

TEST(MarchSteps, TheInverseSquareIsIntegratedExactly) {
  std::mt19937 random(29);
  std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
  for (int i = 0; i < 100000; ++i) {
    const float aside = std::pow(10.0f, 3.0f * unit(random) - 2.0f), a = 5.0f * unit(random);
    const float b = a + std::pow(10.0f, 2.0f * unit(random) - 2.0f);
    const double exact = (std::atan2(static_cast<double>(b), static_cast<double>(aside)) -
                          std::atan2(static_cast<double>(a), static_cast<double>(aside))) /
                         static_cast<double>(aside);
    // The difference of a and b is off by an ulp of either; the rest by a few 2^-24 of the whole.
    ASSERT_NEAR(glsl::inverseSquareBetween(a, b, aside) / exact, 1.0, 2e-6 + 2.4e-7 * std::abs(a) / (b - a));
  }
}

// Of 1 / r^2 alone, with the lamp 3 mm from a ray of 12 m, 64 steps leave no error where 64 equal ones lose most of it.
TEST(MarchSteps, ALampBesideTheRayCostsNothing) {
  const double begin = 0.0, end = 12.0, foot = 5.0, aside = 0.003;
  const double exact = (std::atan((end - foot) / aside) - std::atan((begin - foot) / aside)) / aside;
  glsl::MarchSteps march = glsl::marchSteps(0.0f, 12.0f, 5.0f, 0.003f, 64);
  double sum = 0.0, equal = 0.0, at = begin;
  for (int n = 0; n < 64; ++n) {
    const double next = glsl::nextStepEnd(march);
    sum += glsl::inverseSquareBetween(static_cast<float>(at - foot), static_cast<float>(next - foot), 0.003f);
    at = next;
    const double t = begin + (n + 0.5) * (end - begin) / 64.0 - foot;
    equal += (end - begin) / 64.0 / (t * t + aside * aside);
  }
  EXPECT_NEAR(sum / exact, 1.0, 1e-4);
  EXPECT_GT(std::abs(equal / exact - 1.0), 0.5);
}

TEST_F(DensityOnTheGpu, TheTableOfDepthsToTheLightIsGoodToTwoPercentOfTheMean) {
  const Bounds bounds{{-4, -3, -4}, {4, 3, 4}};
  writeGeneratedDensity("turbulence", bounds, 3, path("t.vdb"));
  for (const glm::dvec3& lightW : {glm::dvec3(0.5, 1.0, -0.7), glm::dvec3(0, 9, 1), glm::dvec3(4.3, 0, 0)}) {
    MediaSetup setup = test::emptyMediaSetup({0, 1, 11}, {0.2f, 0.3f, 0}, lightW);
    setup.medium = {.sigmaS = {0.3f, 0.5f, 0.8f}, .sigmaA = {0.1f, 0.2f, 0.0f}, .g = 0.3f, .reach = 25.0f};
    setup.density = path("t.vdb");
    setup.pictureSide = 24;  // each sample of each pixel has a way to the light of its own
    MediaWorld world(device(), setup);
    const std::vector<glm::vec3> measured = world.scattered(mediaMethod("runs", 64));
    std::vector<glm::vec3> expected;
    for (size_t i = 0; i + 1 < world.endsW.size(); ++i) expected.emplace_back(marched(world, world.endsW[i], 64));
    const double error = relativeRmse(measured, expected);
    EXPECT_LT(error, 0.02) << lightW.x;  // 0.0103 with the lamp amid the density, whose surroundings weigh most
    EXPECT_LT(relativeRmse(world.scattered(mediaMethod("march", 64)), expected), 0.02);
  }
}

// Surfaces in a grid of ones are those of the homogeneous medium.
TEST_F(DensityOnTheGpu, SurfacesAreAttenuatedByWhatTheTablesSay) {
  write(path("ones.vdb"),
        {gridOf(
            openvdb::CoordBBox({-22, -22, -22}, {22, 22, 22}), [](const openvdb::Coord&) { return 1.0f; },
            openvdb::math::Transform::createLinearTransform(1.0))});
  MediaSetup setup = test::mediaSetup("contact");
  setup.density = path("ones.vdb");
  MediaWorld world(device(), setup);
  VisibilityPass visibility(device(), world.view.width, world.view.height);
  glsl::ShadeUniforms shade =
      shadeUniforms(world.view, {.type = LightType::Point, .positionW = setup.light.positionW}, {});
  shade.lightColor = setup.light.intensity / glsl::kPi;
  visibility.setUniforms(shade);
  const auto surfaces = [&](const DensityBuffers* density) {
    world.pass.setMedium(world.view, world.setup.medium, density);
    gpu::Commands commands(device(), "surfaces");
    visibility.record(commands, world.buffers, world.gbuffer, *world.cube, {.bias = findBias("adaptive")});
    world.pass.recordTable(commands, *world.volume, setup.light);
    commands.barrier("visibility and table are written -> surfaces and pixels read them");
    world.pass.record(commands, world.buffers, world.gbuffer, *world.volume, setup.light, mediaMethod("runs", 128),
                      false);
    commands.barrier("depths to the eye are written -> surfaces read them");
    world.pass.recordSurfaces(commands, world.buffers, world.gbuffer, setup.light, visibility.uniforms(),
                              visibility.visibility(), false);
    commands.submitAndWait();
    return gpu::downloadAs<glm::vec3>(device(), world.pass.surfaces());
  };
  const std::vector<glm::vec3> homogeneous = surfaces(nullptr), dense = surfaces(world.densityBuffers.get());
  EXPECT_LT(relativeRmse(dense, homogeneous), 1e-3);
  EXPECT_GT(relativeRmse(homogeneous, std::vector<glm::vec3>(homogeneous.size(), glm::vec3(0.01f))), 0.1);
}

}  // namespace
}  // namespace gnomon
