// A session's volume, validated: sound as it is, reported in full, and unsound where any part says so.
#include "lab/volume/volume_report.h"
#include "tests/gpu_fixture.h"
#include "vsv/volume_parameterization.h"

#include <nlohmann/json.hpp>

namespace gnomon {
namespace {

class VolumeValidationTest : public ::testing::Test {
 protected:
  static VolumeOptions options(VolumeSource source) {
    VolumeOptions options{.mapSide = 256, .validate = true, .command = "gnomon vsv contact"};
    options.map.set(kVolumeSize({.alpha = 128, .theta = 128, .phi = 128}));
    options.map.set(kVolumeSource(source));
    return options;
  }
  std::vector<std::string> messages_;
  const Session session_{{.validation = true, .messageSink = &messages_}, {.scene = "contact", .size = "64"}};
};

TEST_F(VolumeValidationTest, AVolumeIsSoundAndItsReportAddsUp) {
  for (const VolumeSource source : {VolumeSource::Direct, VolumeSource::Resample}) {
    const VolumeResult result = examineVolume(session_, options(source));
    EXPECT_TRUE(result.sound());
    const auto json = nlohmann::json::parse(volumeJson(session_, options(source), result));
    EXPECT_EQ(json.at("same_map").at("voxels"), 128 * 128 * 128);
    EXPECT_EQ(json.at("same_map").at("mismatches"), 0);
    EXPECT_TRUE(json.at("same_map").contains("within_tolerance"));
    EXPECT_EQ(json.at("exact").at("columns"), 128 * 128);
    EXPECT_EQ(json.at("memory").at("dense_bytes"), 128 * 128 * 128 / 8);
    EXPECT_GT(json.at("memory").at("openvdb_bytes"), 0);
    uint64_t columns = 0, explained = 0;
    for (const auto& bucket : json.at("exact").at("histogram")) {
      columns += bucket.at("columns").get<uint64_t>();
      for (const char* cause : {"rounding", "outside", "silhouette", "resolution"})
        if (bucket.at("voxels") != "0") explained += bucket.at(cause).get<uint64_t>();
    }
    EXPECT_EQ(columns, 128u * 128u);
    const uint64_t exact = json.at("exact").at("histogram")[0].at("columns");
    EXPECT_EQ(explained, columns - exact);
    // A cube map's texels are not the columns.
    EXPECT_EQ(exact > columns * 999 / 1000, source == VolumeSource::Direct);
    const std::string table = volumeTable(session_, options(source), result);
    EXPECT_NE(table.find("0 mismatches"), std::string::npos) << table;
  }
  EXPECT_TRUE(messages_.empty());
}

TEST_F(VolumeValidationTest, AnyWrongVoxelColumnOrRowIsUnsound) {
  VolumeResult result;
  EXPECT_TRUE(result.sound());  // nothing was asked
  result.validation.emplace();
  EXPECT_TRUE(result.sound());
  result.validation->source.sameMap.withinTolerance = 5;
  result.validation->exact.tooDark = 100;
  EXPECT_TRUE(result.sound());
  for (uint64_t* count :
       {&result.validation->source.sameMap.mismatches, &result.validation->source.sameOccluders.mismatches,
        &result.validation->source.occluders.beyond, &result.validation->litBehind}) {
    *count = 1;
    EXPECT_FALSE(result.sound());
    *count = 0;
  }
}

}  // namespace
}  // namespace gnomon
