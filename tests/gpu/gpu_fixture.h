#pragma once
// The fixture of every test that needs a GPU: a device with validation on. Any message of the layers fails
// the test, those about objects that the test left alive included.

#include "base/file.h"
#include "gpu/commands.h"
#include "tests/base/places.h"
#include "tests/base/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace gnomon::gpu {

using test::TemporaryFolder;

class GpuTest : public ::testing::Test {
 protected:
  explicit GpuTest(DeviceOptions options = {}) {
    // A death test starts the program again instead of forking a process that has the driver's threads.
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    options.validation = true;
    options.messageSink = &messages_;
    device_ = Device::create(options);
  }

  // Here and not in TearDown: resources that a derived fixture holds go before the device does.
  ~GpuTest() override {
    device_.reset();
    for (const std::string& message : messages_) ADD_FAILURE() << message;
  }

  const Device& device() const { return *device_; }

  bool isLavapipe() const { return device_->info().driver.starts_with("llvmpipe"); }

  // In ulps, for what STYLE calls bit-exact on lavapipe; other devices may fuse multiply and add.
  int exactTolerance() const { return isLavapipe() ? 0 : 4; }

  // In texels, by how much a corner may have moved, in x and in y, when depth is interpolated: devices draw triangles
  // whose corners stand on a grid of 1/256. lavapipe covers texels by that grid too, but keeps depth on the plane.
  double cornerGrid() const { return isLavapipe() ? 0.0 : 1.0 / 256.0; }

  // How far two numbers are apart that are equal to the bit on lavapipe: there in ulps, so that any difference counts;
  // elsewhere in roundings (2^-24) of the larger of them or 1, since fused products leave another rest of large terms.
  int64_t apart(float a, float b) const;
  // What `apart` may be.
  int64_t apartAtMost() const { return isLavapipe() ? 0 : 256; }

 private:
  std::vector<std::string> messages_;
  std::unique_ptr<Device> device_;
};

// How many floats lie between the two; 0 for equal values and for two NaNs.
inline int64_t ulpDistance(float a, float b) {
  if (a == b || (a != a && b != b)) return 0;
  const auto ordered = [](float value) -> int64_t {
    const auto bits = std::bit_cast<int32_t>(value);
    return bits < 0 ? static_cast<int64_t>(INT32_MIN) - bits : bits;
  };
  const int64_t distance = ordered(a) - ordered(b);
  return distance < 0 ? -distance : distance;
}

inline int64_t GpuTest::apart(float a, float b) const {
  if (isLavapipe() || !std::isfinite(a) || !std::isfinite(b)) return ulpDistance(a, b);
  const double scale = std::max({1.0, std::abs(double(a)), std::abs(double(b))});
  return static_cast<int64_t>(std::abs(double(a) - double(b)) / scale * 16777216.0);
}

// A shader beside the test's source, as "tests/<name>"; it may include any .glsl beside it, and kernel.glsl.
inline ShaderSource testShader(const std::string& name, const std::filesystem::path& folder) {
  ShaderSource source{.path = "tests/" + name, .overrides = {}};
  for (const std::filesystem::path& from : {std::filesystem::path(test::inSource("tests/gpu")), folder})
    for (const auto& entry : std::filesystem::directory_iterator(from))
      if (entry.path().extension() == ".glsl")
        source.overrides["tests/" + entry.path().filename().string()] = readFile(entry.path());
  return source;
}
#define GNOMON_TEST_SHADER(name) ::gnomon::gpu::testShader(name, ::gnomon::test::inSource(GNOMON_TEST_FOLDER))

// A shader that is not in a file: for a test about the text itself.
inline ShaderSource inlineShader(const std::string& path, const std::string& text) {
  return {.path = path, .overrides = {{path, text}}};
}

}  // namespace gnomon::gpu
