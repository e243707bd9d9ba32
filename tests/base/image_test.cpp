// Images come back as they were written.
#include "base/image.h"
#include "base/error.h"
#include "base/file.h"
#include "base/image_png.h"
#include "tests/base/file_limit.h"
#include "tests/base/temporary_folder.h"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>
#include <zlib.h>

namespace gnomon {
namespace {

namespace fs = std::filesystem;

class ImageTest : public ::testing::Test {
 protected:
  const test::TemporaryFolder temporary_;
  const fs::path& folder_ = temporary_.path();
};

TEST_F(ImageTest, ExrKeepsEveryFloat) {
  ImageF image(7, 5, 3);
  for (size_t i = 0; i < image.values.size(); ++i)
    image.values[i] = std::ldexp(static_cast<float>(i) - 50.3f, static_cast<int>(i % 40) - 20);
  image.values[4] = std::numeric_limits<float>::infinity();
  writeExr(folder_ / "a.exr", image, {.names = {"visibility", "truth", "label"}});
  const ImageF back = readImage(folder_ / "a.exr");
  ASSERT_EQ(back.values.size(), image.values.size());
  // Channels come back in the file's order, which is alphabetical: label, truth, visibility.
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 7; ++x)
      for (int c = 0; c < 3; ++c) EXPECT_EQ(back.at(x, y)[2 - c], image.at(x, y)[c]);
}

TEST_F(ImageTest, PngKeepsEveryByteAndTheSameImageGivesTheSameFile) {
  Image8 image(16, 16, 3);
  for (size_t i = 0; i < image.values.size(); ++i) image.values[i] = static_cast<uint8_t>(i * 37);
  writePng(folder_ / "a.png", image);
  writePng(folder_ / "b.png", image);
  EXPECT_EQ(readFile(folder_ / "a.png"), readFile(folder_ / "b.png"));
  const std::string bytes = readFile(folder_ / "a.png");
  const Image8 back = decodeImage(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size(), "a.png");
  for (int i = 0; i < 256; ++i)
    for (int c = 0; c < 3; ++c) EXPECT_EQ(back.values[4 * i + c], image.values[3 * i + c]);
}

// 16 bits, by hand: encodePng writes 8. One line of the filter "none" a row.
std::string png16(uint32_t width, uint32_t height, const std::vector<uint16_t>& rgba) {
  const auto word = [](uint32_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 255u);
    return bytes;
  };
  const auto chunk = [&](const std::string& type, const std::string& data) {
    const std::string summed = type + data;
    const auto* bytes = reinterpret_cast<const Bytef*>(summed.data());
    return word(static_cast<uint32_t>(data.size())) + summed +
           word(static_cast<uint32_t>(crc32_z(0, bytes, summed.size())));
  };
  std::string lines;
  for (uint32_t y = 0; y < height; ++y) {
    lines += '\0';
    for (uint32_t i = 0; i < 4 * width; ++i) {
      const uint16_t value = rgba[(4 * width * y + i) % rgba.size()];
      lines += static_cast<char>(value >> 8);
      lines += static_cast<char>(value & 255);
    }
  }
  std::string packed(compressBound(lines.size()), '\0');
  uLongf size = packed.size();
  compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(lines.data()), lines.size());
  packed.resize(size);
  return "\x89PNG\r\n\x1a\n" + chunk("IHDR", word(width) + word(height) + std::string("\x10\x06\0\0\0", 5)) +
         chunk("IDAT", packed) + chunk("IEND", "");
}

Image8 decoded(const std::string& bytes) {
  return decodeImage(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size(), "a.png");
}

TEST_F(ImageTest, SixteenBitsAreRoundedToEight) {
  std::vector<uint16_t> values;
  for (uint32_t value = 0; value < 65536; value += 4) values.push_back(static_cast<uint16_t>(value));
  const Image8 image = decoded(png16(64, 64, values));
  ASSERT_EQ(image.values.size(), values.size());
  for (size_t i = 0; i < values.size(); ++i)
    EXPECT_EQ(image.values[i], static_cast<uint8_t>(std::lround(values[i] / 257.0))) << values[i];
}

TEST_F(ImageTest, ADamagedPngIsOneErrorAndLibpngPrintsNothing) {
  const std::string whole = png16(16, 16, {1000, 2000, 3000, 65535});
  testing::internal::CaptureStderr();
  size_t refused = 0;
  for (size_t i = 8; i < whole.size(); ++i) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x55);
    try {
      decoded(damaged);
    } catch (const WorldError& error) {
      ++refused;
      EXPECT_EQ(std::string(error.what()).find("a.png: cannot be decoded as PNG; "), 0u) << error.what();
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
    EXPECT_THROW(decoded(whole.substr(0, i)), WorldError) << i;
  }
  EXPECT_GT(refused, whole.size() / 2);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(ImageTest, AFullDiskLeavesTheOldPictureWhereverItIsFull) {
  Image8 image(64, 64, 3);
  ImageF data(64, 64, 2);
  for (size_t i = 0; i < image.values.size(); ++i) image.values[i] = static_cast<uint8_t>(i * i / 7);
  for (size_t i = 0; i < data.values.size(); ++i) data.values[i] = std::sin(static_cast<float>(i));
  test::expectWholeOrOld<WorldError>(folder_ / "png" / "a.png", [&] { writePng(folder_ / "png" / "a.png", image); });
  test::expectWholeOrOld<WorldError>(folder_ / "exr" / "a.exr", [&] {
    writeExr(folder_ / "exr" / "a.exr", data, {.names = {"Y", "Z"}});
  });
}

// The standard's sums are part of what is checked: a decoder refuses a stream whose sum is wrong.
TEST_F(ImageTest, PngOfManyBandsComesBackWithAnyChannelsAndAnyThreads) {
  for (const int channels : {1, 3, 4}) {
    Image8 image(700, 1100, channels);  // 770 kB at least: two bands and more
    std::mt19937 random(static_cast<unsigned>(channels));
    for (uint8_t& value : image.values) value = static_cast<uint8_t>(random() % 3);
    const std::string bytes = encodePng(image);
    tbb::task_arena alone(1);
    EXPECT_EQ(alone.execute([&] { return encodePng(image); }), bytes);
    EXPECT_LT(bytes.size(), image.values.size() / 2);
    const Image8 back = decodeImage(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size(), "many.png");
    ASSERT_EQ(back.width, image.width);
    ASSERT_EQ(back.height, image.height);
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        for (int c = 0; c < 4; ++c) {
          const int expected = c == 3 && channels < 4 ? 255 : image.at(x, y)[channels == 1 ? 0 : c];
          ASSERT_EQ(back.at(x, y)[c], expected) << x << " " << y << " " << c;
        }
    for (const size_t damaged : {bytes.size() - 20, bytes.size() / 2}) {
      std::string bad = bytes;
      bad[damaged] = static_cast<char>(bad[damaged] ^ 0x10);
      EXPECT_THROW(decodeImage(reinterpret_cast<const uint8_t*>(bad.data()), bad.size(), "bad.png"), WorldError);
    }
  }
}

TEST_F(ImageTest, GarbageIsRefusedByName) {
  const std::string garbage = "\x89PNG but no more";
  try {
    decodeImage(reinterpret_cast<const uint8_t*>(garbage.data()), garbage.size(), "texture 3");
    FAIL();
  } catch (const WorldError& error) {
    EXPECT_NE(std::string(error.what()).find("texture 3"), std::string::npos);
  }
}

TEST(EncodeJpeg, ComesBackNearlyAsItWas) {
  Image8 image(64, 48, 3);
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x) {
      image.at(x, y)[0] = static_cast<uint8_t>(3 * x);
      image.at(x, y)[1] = static_cast<uint8_t>(200 - 2 * x);
      image.at(x, y)[2] = static_cast<uint8_t>(4 * y);
    }
  const std::string bytes = encodeJpeg(image, 95);
  EXPECT_EQ(bytes, encodeJpeg(image, 95));
  EXPECT_LT(encodeJpeg(image, 20).size(), bytes.size());
  const Image8 back = decodeImage(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size(), "a.jpg");
  ASSERT_EQ(back.width, 64);
  ASSERT_EQ(back.height, 48);
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x)
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(back.at(x, y)[c], image.at(x, y)[c], 12);
}

TEST(Base64, HasTheVectorsOfRfc4648) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfb"), "//77");
}

TEST(Srgb, RoundTrips) {
  for (int i = 0; i <= 255; ++i) {
    const float value = static_cast<float>(i) / 255.0f;
    EXPECT_NEAR(srgbFromLinear(linearFromSrgb(value)), value, 2e-6f);
  }
  EXPECT_NEAR(srgbFromLinear(0.5f), 0.735357f, 1e-5f);  // IEC 61966-2-1
}

}  // namespace
}  // namespace gnomon
