#include "shadow/channel.h"

#include "base/check.h"

#include <algorithm>
#include <sstream>

namespace gnomon {

using glsl::kChannelBackDepth;
using glsl::kChannelDepth;
using glsl::kChannelIds;
using glsl::kChannelSecondDepth;
using glsl::kChannelSecondIds;

const std::vector<Channel>& channels() {
  static const std::vector<Channel> all = {
      {.bit = kChannelDepth,
       .name = "depth",
       .member = "z1",
       .pass = ChannelPass::Nearest,
       .format = VK_FORMAT_D32_SFLOAT,
       .location = kDepthBuffer,
       .binding = glsl::kBindMapDepth},
      {.bit = kChannelSecondDepth,
       .name = "second-depth",
       .member = "z2",
       .pass = ChannelPass::Second,
       .format = VK_FORMAT_R32_SFLOAT,
       .location = 0,
       .clear = {.float32 = {1.0f, 0.0f, 0.0f, 0.0f}},
       .binding = glsl::kBindSecondDepth,
       .needs = kChannelDepth},
      {.bit = kChannelBackDepth,
       .name = "back-depth",
       .member = "zBack",
       .pass = ChannelPass::BackFaces,
       .format = VK_FORMAT_D32_SFLOAT,
       .location = kDepthBuffer,
       .binding = glsl::kBindBackDepth},
      {.bit = kChannelIds,
       .name = "ids",
       .member = "id1",
       .pass = ChannelPass::Nearest,
       .format = VK_FORMAT_R32_UINT,
       .location = 1,
       .clear = {.uint32 = {0, 0, 0, 0}},
       .binding = glsl::kBindIds,
       .needs = kChannelDepth},
      {.bit = kChannelSecondIds,
       .name = "second-ids",
       .member = "id2",
       .pass = ChannelPass::Second,
       .format = VK_FORMAT_R32_UINT,
       .location = 2,
       .clear = {.uint32 = {0, 0, 0, 0}},
       .binding = glsl::kBindSecondIds,
       .needs = kChannelDepth | kChannelSecondDepth,
       .blends = false},
  };
  return all;
}

ChannelSet completed(ChannelSet set) {
  for (const Channel& channel : channels())
    if ((set & channel.bit) != 0) set |= channel.needs;
  return set;
}

size_t bytesOf(ChannelSet set) {
  size_t bytes = 0;
  for (const Channel& channel : channels()) {
    if ((set & channel.bit) == 0) continue;
    GNOMON_CHECK(channel.format == VK_FORMAT_D32_SFLOAT || channel.format == VK_FORMAT_R32_SFLOAT ||
                 channel.format == VK_FORMAT_R32_UINT);
    bytes += 4;
  }
  return bytes;
}

bool blends(ChannelSet set) {
  return std::ranges::none_of(channels(),
                              [&](const Channel& channel) { return (set & channel.bit) != 0 && !channel.blends; });
}

ChannelSet writtenBy(ChannelPass pass, ChannelSet set) {
  if (pass == ChannelPass::Both) return writtenBy(ChannelPass::Nearest, set) | writtenBy(ChannelPass::Second, set);
  ChannelSet written = 0;
  for (const Channel& channel : channels())
    if (channel.pass == pass) written |= set & channel.bit;
  return written;
}

std::optional<ChannelSet> parseChannels(const std::string& list) {
  ChannelSet set = 0;
  std::string spaced = list;
  std::ranges::replace(spaced, ',', ' ');
  std::istringstream words(spaced);
  for (std::string word; words >> word;) {
    const auto found = std::ranges::find_if(channels(), [&](const Channel& channel) { return word == channel.name; });
    if (found == channels().end()) return std::nullopt;
    set |= found->bit;
  }
  return set == 0 ? std::nullopt : std::optional(completed(set));
}

std::string channelNames(ChannelSet set) {
  std::string names;
  for (const Channel& channel : channels())
    if ((set & channel.bit) != 0) names += (names.empty() ? "" : ", ") + std::string(channel.name);
  return names;
}

std::string contentName(ChannelSet set) {
  switch (set) {
    case kChannelDepth:
      return "one layer";
    case kChannelDepth | kChannelSecondDepth:
      return "two layers";
    case kChannelBackDepth:
      return "back faces";
    case kChannelDepth | kChannelIds:
    case kChannelIds:
      return "one layer, ids";
    default:
      return channelNames(set);
  }
}

}  // namespace gnomon
