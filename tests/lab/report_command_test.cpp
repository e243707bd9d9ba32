// The command that makes one row again.
#include "lab/page/report_command.h"

#include <gtest/gtest.h>

namespace gnomon {
namespace {

Row rowOf(const std::string& bias) {
  Row row;
  row.map = "spot";
  row.bias = bias;
  row.filter = "none";
  row.mapSide = 512;
  return row;
}

TEST(RowCommand, KeepsTheSceneAndDropsOtherMethodsAndOutputs) {
  Row row = rowOf("slope");
  row.params = {{"factor", 2.5}, {"offset", 0.001}, {"map_content", "one layer"}, {"cull", "none"}};
  EXPECT_EQ(rowCommand("gnomon compare 'my scene.glb' --light 1,2,3 --biases all --maps=spot,directional --tune -o "
                       "/tmp/out --json r.json --fail-if 'acne>0.1%' --constant-offset 0.5 --map-texels 9999 --size 64 "
                       "--quiet",
                       row),
            "gnomon compare 'my scene.glb' --light 1,2,3 --size 64 --maps spot --biases slope --map-size 512 "
            "--slope-factor 2.5 --slope-offset 0.001 --cull none");
}

TEST(RowCommand, TheAdaptiveMethodsShareAKnobAndAFilterIsNamed) {
  Row row = rowOf("adaptive-ehm");
  row.filter = "bilinear";
  row.params = {{"k", 0.0002}, {"epsilon_at", "stored"}};
  EXPECT_EQ(rowCommand("gnomon compare atrium -o/tmp/x", row),
            "gnomon compare atrium --maps spot --biases adaptive-ehm --filters bilinear --map-size 512 "
            "--adaptive-k "
            "0.0002 --epsilon-at stored");
}

TEST(RowCommand, AUsersBiasHasNoKnobFlag) {
  Row row = rowOf("my bias;rm");
  row.params = {{"offset", 1.0}};
  EXPECT_EQ(rowCommand("gnomon compare atrium --bias-file 'a b.glsl'", row),
            "gnomon compare atrium --bias-file 'a b.glsl' --maps spot --biases 'my bias;rm' --map-size 512");
}

TEST(RowCommand, LeavesOtherCommandsAlone) {
  EXPECT_EQ(rowCommand("", rowOf("dual")), "");
  EXPECT_EQ(rowCommand("gnomon sweep plan", rowOf("dual")), "gnomon sweep plan");
}

}  // namespace
}  // namespace gnomon
