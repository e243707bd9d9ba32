#include "base/image_codec.h"

#include "base/check.h"
#include "base/error.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>

#include <fmt/format.h>

namespace gnomon {

namespace {

// The file's bytes. The name says which writer is meant.
std::string encode(const char* name, const OIIO::ImageSpec& spec, OIIO::TypeDesc format, const void* values) {
  OIIO::Filesystem::IOVecOutput memory;
  auto out = OIIO::ImageOutput::create(name);
  GNOMON_CHECK(out && out->supports("ioproxy"));
  out->set_ioproxy(&memory);
  if (!out->open(name, spec) || !out->write_image(format, values) || !out->close())
    throw fileError("a picture", "cannot be encoded", out->geterror());
  return {memory.buffer().begin(), memory.buffer().end()};
}

// x and y of red, green, blue and white: ITU-R BT.709, which IEC 61966-2-1 shares.
constexpr float kBt709[8] = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};

std::string encodeExrBytes(const ImageF& image, const ExrChannels& channels, const ExrOrigin& origin) {
  GNOMON_CHECK_EQ(image.channels, static_cast<int>(channels.names.size()));
  OIIO::ImageSpec spec(image.width, image.height, image.channels, OIIO::TypeDesc::FLOAT);
  spec.channelnames = channels.names;
  spec.attribute("compression", "zip");
  spec.attribute("oiio:ColorSpace", "Linear");
  if (channels.isColour) spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), kBt709);
  spec.attribute("gnomon:colour_space", channels.isColour ? "linear, primaries of ITU-R BT.709" : "none: data");
  if (!channels.units.empty()) spec.attribute("gnomon:units", channels.units);
  if (!origin.command.empty()) spec.attribute("gnomon:command", origin.command);
  // No wall clock in an output: the same command gives the same bytes.
  spec.attribute("DateTime", "1980:01:01 00:00:00");
  spec.attribute("Software", origin.software);
  return encode("memory.exr", spec, OIIO::TypeDesc::FLOAT, image.values.data());
}

ImageF readImageFile(const std::filesystem::path& path) {
  auto in = OIIO::ImageInput::open(path.string());
  if (!in) throw fileError(path.string(), "cannot be read as an image", OIIO::geterror());
  const OIIO::ImageSpec& spec = in->spec();
  ImageF image(spec.width, spec.height, spec.nchannels);
  if (!in->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, image.values.data()))
    throw fileError(path.string(), "cannot be read as an image", in->geterror());
  return image;
}

Image8 decodeImageBytes(const uint8_t* bytes, size_t size, const std::string& what) {
  // Colour stays as stored: OpenImageIO would multiply it by alpha.
  OIIO::Filesystem::IOMemReader reader(const_cast<uint8_t*>(bytes), size);
  OIIO::Filesystem::IOProxy* proxy = &reader;
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  // The name only tells OpenImageIO which reader to try; PNG is image_png.h's.
  auto in = OIIO::ImageInput::open("memory.jpg", &config);
  if (!in) throw fileError(what, "cannot be decoded as PNG or JPEG", OIIO::geterror());
  const OIIO::ImageSpec spec = in->spec();
  if (spec.width <= 0 || spec.height <= 0 || spec.width > 16384 || spec.height > 16384)
    throw fileError(what, fmt::format("has {} x {} pixels", spec.width, spec.height), "at most 16384 x 16384 are read");
  std::vector<uint8_t> raw(static_cast<size_t>(spec.width) * spec.height * spec.nchannels);
  if (!in->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, raw.data()))
    throw fileError(what, "cannot be decoded", in->geterror());
  Image8 image(spec.width, spec.height, 4, 255);
  const int n = spec.nchannels;
  for (size_t i = 0; i < image.values.size() / 4; ++i) {
    for (int c = 0; c < 3; ++c) image.values[4 * i + c] = raw[n * i + (n >= 3 ? c : 0)];
    if (n == 4 || n == 2) image.values[4 * i + 3] = raw[n * i + n - 1];
  }
  return image;
}

std::string encodeJpegBytes(const Image8& image, int quality) {
  OIIO::ImageSpec spec(image.width, image.height, image.channels, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("compression", fmt::format("jpeg:{}", quality));
  return encode("memory.jpg", spec, OIIO::TypeDesc::UINT8, image.values.data());
}

std::string base64Text(std::string_view bytes) {
  return OIIO::Strutil::base64_encode({bytes.data(), bytes.size()});
}

}  // namespace

}  // namespace gnomon

extern "C" __attribute__((visibility("default"))) const gnomon::ImageCodec gnomonImageCodec = {
    .encodeExr = gnomon::encodeExrBytes,
    .readImage = gnomon::readImageFile,
    .decodeImage = gnomon::decodeImageBytes,
    .encodeJpeg = gnomon::encodeJpegBytes,
    .base64 = gnomon::base64Text,
};
