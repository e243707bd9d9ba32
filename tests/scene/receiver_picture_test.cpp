// A renderer's camera and depth buffer: what a pixel's ray and depth lead back to is what was projected there.
#include "scene/receiver_picture.h"
#include "base/error.h"

#include <cmath>

#include <gtest/gtest.h>

namespace gnomon {
namespace {

glm::mat4 worldFromEye() {
  const Camera camera = lookAt("", {2.0f, 1.5f, 4.0f}, {0.2f, 0.4f, -1.0f}, 1.0f);
  return camera.worldFromEye;
}

// Vulkan's clip space; w = -z.
glm::mat4 projection(float depthScale, float depthOffset, glm::vec2 aside = glm::vec2(0.0f)) {
  glm::mat4 m(0.0f);
  m[0][0] = 1.2f;
  m[1][1] = -1.7f;
  m[2][0] = aside.x;
  m[2][1] = aside.y;
  m[2][2] = -depthScale;
  m[2][3] = -1.0f;
  m[3][2] = depthOffset;
  return m;
}

TEST(ReceiverPicture, APixelsRayAndDepthLeadBackToItsPoint) {
  const float zNear = 0.1f, zFar = 50.0f;
  const float scale = zFar / (zFar - zNear);
  for (const glm::mat4& clip :
       {projection(0.0f, zNear), projection(scale, -zNear * scale), projection(0.0f, zNear, {0.13f, -0.21f}),
        projection(scale, -zNear * scale, {-0.4f, 0.3f})}) {
    const glsl::CameraView camera = cameraOf(worldFromEye(), clip, 40, 30);
    const glsl::ReceiverPicture meaning = depthMeaning(clip, 0.0f, glsl::kReceiverNormalsNone);
    for (int y = 0; y < 30; y += 7) {
      for (int x = 0; x < 40; x += 7) {
        const float t = 1.0f + 0.3f * static_cast<float>(x + y);
        const glm::vec3 posW = camera.eyeW + glsl::pixelDirection(camera, x, y) * t;
        const glm::vec4 at = camera.clipFromWorld * glm::vec4(posW, 1.0f);
        EXPECT_NEAR(at.w, t, 1e-4f * t);
        EXPECT_NEAR((at.x / at.w * 0.5f + 0.5f) * 40.0f, static_cast<float>(x) + 0.5f, 1e-3f);
        EXPECT_NEAR((at.y / at.w * 0.5f + 0.5f) * 30.0f, static_cast<float>(y) + 0.5f, 1e-3f);
        EXPECT_NEAR(glsl::distanceOfDepth(meaning, at.z / at.w), t, 2e-3f * t);
      }
    }
  }
}

TEST(ReceiverPicture, AProjectionThatIsNotPerspectiveIsRefused) {
  glm::mat4 orthographic(1.0f);
  EXPECT_THROW(cameraOf(worldFromEye(), orthographic, 40, 30), WorldError);
}

TEST(ReceiverPicture, NormalsAreDecodedAsTheyAreStored) {
  glsl::ReceiverPicture picture{};
  for (const glm::vec3 n : {glm::vec3(0, 0, 1), glm::vec3(0, 0, -1), glm::normalize(glm::vec3(1, -2, 3)),
                            glm::normalize(glm::vec3(-3, 1, -2)), glm::normalize(glm::vec3(1, 1, -1))}) {
    picture.normals = glsl::kReceiverNormalsSigned;
    EXPECT_NEAR(glm::distance(glsl::decodedNormal(picture, glm::vec4(n, 0.0f)), n), 0.0f, 1e-6f);
    picture.normals = glsl::kReceiverNormalsUnorm;
    EXPECT_NEAR(glm::distance(glsl::decodedNormal(picture, glm::vec4(0.5f * n + 0.5f, 0.0f)), n), 0.0f, 1e-6f);
    // Encoded as Cigolle et al. do.
    glm::vec2 p = glm::vec2(n) / (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
    if (n.z < 0.0f)
      p = glm::vec2((1.0f - std::abs(p.y)) * (p.x >= 0.0f ? 1.0f : -1.0f),
                    (1.0f - std::abs(p.x)) * (p.y >= 0.0f ? 1.0f : -1.0f));
    picture.normals = glsl::kReceiverNormalsOctahedral;
    const glm::vec3 found = glm::normalize(glsl::decodedNormal(picture, glm::vec4(p.x, p.y, 0.0f, 0.0f)));
    EXPECT_NEAR(glm::distance(found, n), 0.0f, 1e-6f);
  }
}

}  // namespace
}  // namespace gnomon
