#pragma once
// The list of channels: what a texel of a map may store, in what format, and which draw pass writes it. A bias requests
// a set of them (BiasMethod::channels), and a map is rendered with a set (MapImage). Fragments store them in
// shaders/shadow/store_channels.glsl, taps fetch them in fetch_channels.glsl.

#include "gpu/vulkan.h"

#include "shared/channels.glsl"

#include <optional>
#include <string>
#include <vector>

namespace gnomon {

using ChannelSet = int;  // kChannel* bits

// How often a slice is drawn: once for each of these that writes a channel of the map.
enum class ChannelPass {
  Nearest,    // the nearest of all fragments
  Second,     // the nearest of those behind the first depth layer
  Both,       // the channels of these two at once (SecondLayer::Ordered)
  BackFaces,  // the nearest back face of solids; sheets as they are
};

struct Channel {
  ChannelSet bit;      // one kChannel*
  const char* name;    // in a user's `//! channels:`, and in reports
  const char* member;  // of Tap, which holds it
  ChannelPass pass;
  VkFormat format;
  int location;  // of the colour that fragments store it in; kDepthBuffer: it is the depth buffer of its pass
  VkClearColorValue clear;  // of a colour
  int binding;              // kBind*: where a tap finds it
  ChannelSet needs;         // channels that must be there for it to be drawn
  bool blends = true;       // a minimum keeps what the nearest fragment stored; ids must be peeled
};
inline constexpr int kDepthBuffer = -1;

const std::vector<Channel>& channels();

// The set with what its channels need: what a map that holds it holds.
ChannelSet completed(ChannelSet set);

// What a texel takes that stores these, bytes.
size_t bytesOf(ChannelSet set);
// Whether a minimum keeps all that a set stores of the second layer.
bool blends(ChannelSet set);

// Those of a set that a pass writes.
ChannelSet writtenBy(ChannelPass pass, ChannelSet set);

// "depth, second-depth" and the like; nothing where a name is none of the list's, or where there is no name.
std::optional<ChannelSet> parseChannels(const std::string& list);
std::string channelNames(ChannelSet set = ~0);

// For reports: "one layer", "two layers", "back faces"; other sets by their channels' names.
std::string contentName(ChannelSet set);

}  // namespace gnomon
