// The biases that know surfaces, end to end: on every scene and map, beside the exact shadow and beside the same walks
// on the CPU.
#include "base/sanitizers.h"
#include "judge/light_on_map.h"
#include "lit_map.h"
#include "omni/cube_map.h"
#include "omni/paraboloid_map.h"
#include "planar/planar_map.h"
#include "shadow/map_image.h"
#include "tests/base/scenes_to_test.h"
#include "tests/shadow/host_tables.h"

#include "shared/surface_bias.glsl"

namespace gnomon {
namespace {

using test::LitMap;

struct Kind {
  const char* label;
  const Parameterization& map;
  MapOptions options;
  bool exact = true;  // a texel names what its ray meets
};

std::vector<Kind> kinds() {
  return {{"spot", spotParameterization(), {}},
          {"directional", directionalParameterization(), {}},
          {"directional, TSM", directionalParameterization(), {kWarp(Warp::Tsm)}},
          {"cascades", directionalParameterization(), {kCascades(3)}},
          {"cube", cubeParameterization(), {}},
          {"cube, radial", cubeParameterization(), {kCubeDepth(CubeDepth::Radial)}},
          {"paraboloid", paraboloidParameterization(), {}},
          {"paraboloid, tessellated", paraboloidParameterization(), {kParaboloidRaster(ParaboloidRaster::Tessellated)}},
          {"paraboloid, vertex", paraboloidParameterization(), {kParaboloidRaster(ParaboloidRaster::Vertex)}, false}};
}

class Witness : public gpu::GpuTest {};

// A verdict of shadow has a real surface before the receiver, however coarse the map; what is left are leaks where no
// texel saw the occluder's surface. sheets is masked, crowd instanced and mirrored.
TEST_F(Witness, HasNoAcneAnywhere) {
  for (const char* scene : test::scenesToTest({"atrium", "factory", "sheets", "contact", "crowd:20000"})) {
    for (const Kind& kind : kinds()) {
      LitMap map(device(), scene, kind.map, 128, {.side = 96, .options = kind.options});
      const LabelledResult witness = map.judge("witness"), adaptive = map.judge("adaptive");
      const std::string what = std::string(scene) + ", " + kind.label;
      EXPECT_EQ(witness.labels.count(Label::Acne), 0u) << what;
      EXPECT_EQ(witness.labels.count(Label::EdgeShadow), 0u) << what;
      const auto wrong = [&](const LabelledResult& judged) {
        return map.lit.receivers().scored - judged.labels.count(Label::Agree);
      };
      if (kind.exact) {
        EXPECT_LE(wrong(witness), wrong(adaptive) / 2) << what;
      }
      EXPECT_EQ(witness.walks.ends[glsl::kWalkAborted], 0u) << what;
    }
  }
}

// The pixel's receiver as receiver_fetch.glsl has it; absent where it faces away or nothing is seen.
std::optional<glsl::Receiver> receiverOf(const SceneView& seen, const LightOnMap& lit, size_t pixel) {
  const glsl::PrimitiveId id = seen.primitiveIds()[pixel];
  if (id.instancePlusOne == 0) return std::nullopt;
  const Instance& instance = seen.scene().instances[id.instancePlusOne - 1];
  const Mesh& mesh = seen.scene().meshes[instance.mesh];
  glm::vec3 c[3];
  for (int k = 0; k < 3; ++k) {
    c[k] = mesh.positions[mesh.indices[3 * id.triangle + k]];
    if (seen.buffers().instanced) c[k] = glm::vec3(glsl::transform(instance.worldFromMesh, glm::vec4(c[k], 1.0f)));
  }
  const glsl::CameraView& camera = seen.view();
  const int x = static_cast<int>(pixel) % camera.width, y = static_cast<int>(pixel) / camera.width;
  const glsl::Ray ray{.origin = camera.eyeW, .dir = glsl::unitVector(glsl::pixelDirection(camera, x, y))};
  const glsl::SurfacePoint surface = glsl::surfacePoint(ray, c[0], c[1], c[2]);
  const glsl::ShadeUniforms shade = shadeUniforms(camera, lit.light(), {});
  const float lightSide = glm::dot(surface.normal, glsl::towardsLight(shade, surface.position));
  const float cameraSide = glm::dot(surface.normal, camera.eyeW - surface.position);
  if (!(lightSide * cameraSide > 0.0f)) return std::nullopt;
  const glsl::LightFrame& frame = lit.fitted().frame;
  return glsl::Receiver{.posL = glsl::lightFromWorld(frame, surface.position),
                        .normalL = glsl::directionFromWorld(frame, lightSide > 0.0f ? surface.normal : -surface.normal),
                        .id = triangleId(seen.buffers(), id.instancePlusOne - 1,
                                         id.triangle + seen.buffers().firstTriangles[id.instancePlusOne - 1])};
}

// In one dispatch instead of three.
std::vector<float> visibilityAtOnce(LitMap& map, const Method& method) {
  const Occluders& drawn = map.lit.occluders(method.bias->channels);
  gpu::Commands commands(map.seen.device(), "visibility at once");
  drawn.recordVisibility(commands, map.seen.buffers(), map.seen.gbuffer(), map.passes.visibility,
                         {.bias = *method.bias, .once = true});
  commands.submitAndWait();
  return gpu::downloadAs<float>(map.seen.device(), map.passes.visibility.visibility());
}

TEST_F(Witness, WalksOnTheGpuAsOnTheCpu) {
  for (const char* scene : {"atrium", "sheets", "crowd:20000"}) {
    for (const Kind& kind : kinds()) {
      const bool isCube = std::string(kind.label) == "cube";
      // Under the sanitizers, which are slow here, one map will do for masks and instances.
      if (kHasSanitizers && std::string(scene) != "atrium" && !isCube) continue;
      for (const int reach : {2, 4}) {
        if (reach == 4 && !isCube) continue;
        LitMap map(device(), scene, kind.map, 96, {.side = 64, .options = kind.options});
        Method method = atDefaults(findBias("witness"), map.seen);
        method.params.witnessReach = reach;
        const std::vector<glsl::PixelDiagnosis> pixels = map.lit.diagnose(method);
        const Occluders& drawn = map.lit.occluders(method.bias->channels);
        const test::HostTables host(map.seen.scene(), map.seen.buffers(), map.lit.fitted(), drawn.downloadIds(device()),
                                    drawn.downloadDepth(device()));
        size_t asked = 0, different = 0, otherVerdicts = 0, steps = 0;
        for (size_t i = 0; i < pixels.size(); ++i) {
          const std::optional<glsl::Receiver> receiver = receiverOf(map.seen, map.lit, i);
          if (!receiver || (pixels[i].flags & glsl::kPixelCovered) == 0) continue;
          const glsl::ShadowMap& shape = map.lit.fitted().map;
          const glsl::WitnessVerdict verdict =
              glsl::witnessVerdict(shape, host.tables(), glsl::askingOf(reach), *receiver, receiver->posL,
                                   glsl::mapProject(shape, receiver->posL));
          ++asked;
          steps += verdict.tally.steps & 4095u;
          otherVerdicts += verdict.lit != ((pixels[i].flags & glsl::kPixelLit) != 0) ? 1 : 0;
          different += verdict.lit != ((pixels[i].flags & glsl::kPixelLit) != 0) ||
                               glsl::packTexel(verdict.slice, verdict.texel) != pixels[i].texel ||
                               verdict.tally.ends != pixels[i].walkEnds || verdict.tally.steps != pixels[i].walkSteps
                           ? 1
                           : 0;
        }
        const std::string what = std::string(scene) + ", " + kind.label;
        EXPECT_EQ(map.lit.visibility(method), visibilityAtOnce(map, method)) << what;
        EXPECT_GT(asked, pixels.size() / 8) << what;
        EXPECT_GT(steps, 100u) << what;
        // Elsewhere the last bits choose another texel, and so another walk to the same verdict.
        EXPECT_LE(different, isLavapipe() ? 0 : asked / 20) << what << ", of " << asked;
        EXPECT_LE(otherVerdicts, isLavapipe() ? 0 : asked / 500) << what << ", of " << asked;
      }
    }
  }
}

// The list of pixels that walk is cut in rows of groups of 64.
TEST_F(Witness, AListLongerThanARowOfGroupsIsWalkedToItsEnd) {
  LitMap map(device(), "factory", cubeParameterization(), 384, {.side = 64});
  const Method method = atDefaults(findBias("witness"), map.seen);
  size_t walked = 0;
  for (const glsl::PixelDiagnosis& pixel : map.lit.diagnose(method)) walked += pixel.walkEnds != 0 ? 1 : 0;
  EXPECT_GT(walked, 2 * 64 * glsl::kMostWalkGroupsX);
  EXPECT_EQ(map.lit.visibility(method), visibilityAtOnce(map, method));
}

// A filter asks for points of the receiver's plane: what it gives is nearer to the exact shadow through the same kernel
// than any bias that compares depths.
TEST_F(Witness, IsTheBestThroughFilters) {
  for (const char* scene : test::scenesToTest({"atrium", "sheets"})) {
    LitMap map(device(), scene, cubeParameterization(), 160, {.side = 256});
    for (const int filter : {glsl::kShadowFilterBilinear, glsl::kShadowFilterJitter4x4}) {
      const std::vector<float> truth = map.lit.filteredTruth(filter);
      const auto rmse = [&](const char* bias) {
        const std::vector<float> seen = map.lit.visibility(atDefaults(findBias(bias), map.seen), filter);
        double sum = 0.0;
        for (size_t i = 0; i < truth.size(); ++i)
          if (map.lit.receivers().states[i] == PixelState::Scored)
            sum += static_cast<double>(seen[i] - truth[i]) * static_cast<double>(seen[i] - truth[i]);
        return std::sqrt(sum / static_cast<double>(map.lit.receivers().scored));
      };
      const double witness = rmse("witness");
      for (const char* bias : {"adaptive", "dual", "two-plane", "two-plane-depth"})
        EXPECT_LT(witness, rmse(bias)) << scene << " " << filter << " " << bias;
    }
  }
}

}  // namespace
}  // namespace gnomon
