// The radiance pass: a square whose every pixel's colour is known, with and without texture and matrix. Each of the
// four is a program of its own.
#include "base/error.h"
#include "shadow/visibility_pass.h"
#include "tests/gpu_fixture.h"

#include <algorithm>

namespace gnomon {
namespace {

constexpr int kSide = 64;  // pixels
constexpr glm::vec3 kBase{0.5f, 0.25f, 1.0f};

class RadiancePassTest : public gpu::GpuTest {
 protected:
  // Ambient light alone.
  std::vector<glm::vec3> shade(const Scene& scene) {
    const glsl::CameraView view = cameraView(scene.cameras.front(), kSide, kSide);
    const SceneBuffers buffers = createSceneBuffers(device(), scene);
    const GBuffer gbuffer(device(), kSide, kSide);
    VisibilityPass visibility(device(), kSide, kSide);
    RadiancePass radiance(device(), kSide, kSide);
    glsl::ShadeUniforms uniforms = shadeUniforms(view, {.type = LightType::Point}, {});
    uniforms.lightColor = glm::vec3(0.0f);
    uniforms.ambient = glm::vec3(1.0f);
    visibility.setUniforms(uniforms);
    const std::vector<float> lit(kSide * kSide, 1.0f);
    gpu::upload(device(), visibility.visibility(), std::as_bytes(std::span(lit)));
    gpu::Commands commands(device(), "radiance");
    gbuffer.record(commands, buffers, view);
    commands.barrier("the G-buffer is drawn -> pixels are shaded");
    radiance.record(commands, buffers, gbuffer, visibility.uniforms(), visibility.visibility());
    commands.submitAndWait();
    return gpu::downloadAs<glm::vec3>(device(), radiance.radiance());
  }
};

// A square two metres wide that faces a camera four metres before it, its left half under a red texel and its right
// half under a green one. `worldFromMesh` places the mesh, and changes nothing of what is seen.
Scene square(bool textured, const glm::mat4& worldFromMesh) {
  Scene scene;
  scene.name = "square";
  scene.texels = {0xff0000ffu, 0xff00ff00u};
  scene.textures.push_back({0, 2, 1, glsl::kWrapClamp, glsl::kWrapClamp, glsl::kTexFilterNearest});
  scene.materials.push_back({.name = "paint", .baseColor = glm::vec4(kBase, 1.0f)});
  if (textured) scene.materials.back().baseColorTexture = 0;
  const glm::mat4 meshFromWorld = glm::inverse(worldFromMesh);
  Mesh mesh;
  mesh.indices = {0, 1, 2, 0, 2, 3};
  for (const glm::vec2 corner : {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)}) {
    mesh.positions.push_back(glm::vec3(meshFromWorld * glm::vec4(corner, -4.0f, 1.0f)));
    mesh.normals.push_back(glm::normalize(glm::transpose(glm::mat3(worldFromMesh)) * glm::vec3(0, 0, 1)));
    mesh.uvs.push_back(0.5f * corner + 0.5f);
  }
  scene.meshes.push_back(std::move(mesh));
  scene.instances.push_back({.name = "", .mesh = 0, .worldFromMesh = worldFromMesh});
  scene.cameras.push_back(lookAt("front", {0, 0, 0}, {0, 0, -1}, 0.45f));
  return scene;
}

TEST_F(RadiancePassTest, TextureMatrixAndNormalsAreHonouredWhereThereAreAny) {
  glm::mat4 sheared(1.0f);
  sheared[0] = {0.0f, 2.0f, 0.5f, 0.0f};
  sheared[1] = {-1.0f, 0.5f, 0.0f, 0.0f};
  sheared[3] = {3.0f, -2.0f, 1.0f, 1.0f};
  for (const bool textured : {false, true}) {
    for (const auto& [worldFromMesh, normals] :
         {std::pair(glm::mat4(1.0f), true), std::pair(sheared, true), std::pair(sheared, false)}) {
      Scene scene = square(textured, worldFromMesh);
      if (!normals) scene.meshes.front().normals.clear();
      const glsl::CameraView view = cameraView(scene.cameras.front(), kSide, kSide);
      const std::vector<glm::vec3> seen = shade(scene);
      for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
          const glm::vec3 toEye = -glm::normalize(glsl::pixelDirection(view, x, y));
          const glm::vec3 paint = !textured ? glm::vec3(1) : x < kSide / 2 ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
          const glm::vec3 expected = kBase * paint * (0.6f + 0.4f * toEye.z);
          const glm::vec3 difference = glm::abs(seen[static_cast<size_t>(y * kSide + x)] - expected);
          ASSERT_LT(std::max({difference.x, difference.y, difference.z}), 1e-5f)
              << (textured ? "textured " : "plain ") << (worldFromMesh == glm::mat4(1.0f) ? "" : "placed by a matrix ")
              << (normals ? "" : "without normals ") << x << " " << y;
        }
      }
    }
  }
}

TEST_F(RadiancePassTest, ASceneOfTooManyTrianglesIsOneLine) {
  const uint64_t allowed = device().info().maxStorageBufferBytes;
  if (allowed > (256u << 20)) GTEST_SKIP() << "a scene that this device refuses is too large for a test";
  Scene scene = square(false, glm::mat4(1.0f));
  scene.meshes.front().indices.resize(3 * (allowed / sizeof(glm::uvec3) + 1), 0);
  try {
    createSceneBuffers(device(), scene);
    FAIL();
  } catch (const WorldError& error) {
    EXPECT_NE(std::string(error.what()).find("triangles with 4 vertices need a buffer of"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace gnomon
