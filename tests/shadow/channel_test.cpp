// Channels: the list, sets of them by name, and a map that holds several.
#include "shadow/channel.h"
#include "map_fixture.h"

#include <set>

namespace gnomon {
namespace {

using glsl::kChannelBackDepth;
using glsl::kChannelDepth;
using glsl::kChannelSecondDepth;

TEST(Channels, HaveEachTheirBitTheirBindingAndTheirColour) {
  ChannelSet bits = 0;
  std::set<int> bindings, locations;
  for (const Channel& channel : channels()) {
    EXPECT_EQ(bits & channel.bit, 0) << channel.name;
    bits |= channel.bit;
    EXPECT_TRUE(bindings.insert(channel.binding).second) << channel.name;
    EXPECT_LT(channel.binding, glsl::kBindRadiance) << channel.name;
    EXPECT_TRUE(channel.location == kDepthBuffer || locations.insert(channel.location).second) << channel.name;
  }
}

TEST(Channels, AreAskedForByNameAndComeWithWhatTheyNeed) {
  EXPECT_EQ(parseChannels("depth"), kChannelDepth);
  EXPECT_EQ(parseChannels("second-depth"), kChannelDepth | kChannelSecondDepth);
  EXPECT_EQ(parseChannels(" back-depth,depth "), kChannelDepth | kChannelBackDepth);
  EXPECT_EQ(parseChannels("depth, layers"), std::nullopt);
  EXPECT_EQ(parseChannels(" "), std::nullopt);
}

TEST(Channels, ReportsCallTheirSetsByTheNamesTheyHad) {
  EXPECT_EQ(contentName(kChannelDepth), "one layer");
  EXPECT_EQ(contentName(kChannelDepth | kChannelSecondDepth), "two layers");
  EXPECT_EQ(contentName(kChannelBackDepth), "back faces");
  EXPECT_EQ(contentName(kChannelDepth | kChannelBackDepth), "depth, back-depth");
}

class ChannelsOfAMap : public gpu::GpuTest {};

TEST_F(ChannelsOfAMap, HoldTogetherWhatEachHoldsAlone) {
  for (const char* scene : {"contact", "sheets"}) {
    const test::Rendered r = test::render(device(), scene, spotParameterization(), 64, 128, CullMode::Solids);
    ChannelSet every = 0;
    for (const Channel& channel : channels()) every |= channel.bit;
    const auto all = test::draw(device(), r, every, CullMode::Solids);
    for (const Channel& channel : channels()) {
      const auto alone = test::draw(device(), r, channel.bit, CullMode::Solids);
      EXPECT_EQ(alone->channels(), completed(channel.bit));
      EXPECT_EQ(gpu::download(device(), all->image(channel.bit)), gpu::download(device(), alone->image(channel.bit)))
          << scene << " " << channel.name;
    }
  }
}

}  // namespace
}  // namespace gnomon
