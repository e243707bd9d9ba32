// The whole frame in one pass: a fragment's receiver, its visibility by one bias and filter, and its shaded colour.
layout(constant_id = 0) const int kMethod = 0;   // kBias*
layout(constant_id = 2) const int kMapKind = 0;  // kMap*
#define GNOMON_BIAS_METHOD kMethod
#define GNOMON_MAP_KIND kMapKind
const int kDiagnose = 0;

#include "shadow/frame_draw.glsl"
#include "shadow/map_visibility.glsl"
#include "shadow/specialized_map.glsl"
#include "shadow/surface_light.glsl"

layout(constant_id = 9) const int kMasked = 0;

layout(location = 0) out vec4 radiance;

bool inHole() {
  SceneMaterial material;
  material.baseColor = baseColor;
  material.texture = textureIndex;
  material.alphaCutoff = alphaCutoff;
  return isHole(material, uv);
}

void main() {
  if (kMasked == 1 && inHole()) discard;
  PlaneView plane;
  plane.normalL = normalAndHeight.xyz;
  plane.height = normalAndHeight.w;
  plane.nearest = reachAndFacing.x;
  plane.farthest = reachAndFacing.y;
  vec3 dirL = eyeDirection(frame.eye, gl_FragCoord.xy);
  vec3 fromEye = dirL * planeDistance(plane, dirL);
  Receiver receiver;
  receiver.posL = frame.eye.eyeL + fromEye;
  receiver.normalL = plane.normalL;
  PixelDiagnosis unasked;
  float visible = 0.0f;
  if (reachAndFacing.z == 1.0f)
    visible = receiverVisibility(specializedMap(), receiver, ivec2(gl_FragCoord.xy), unasked);

  vec3 albedo = baseColor.xyz;
  if (kTextured == 1) albedo *= textureColorAt(textureIndex, uv);
  SurfaceView seen;
  seen.planeNormal = receiver.normalL;
  seen.smoothNormal = smoothNormalL;
  seen.toEye = -fromEye;
  seen.toLight = shade.positional == 1.0f ? -receiver.posL : frame.towardsL;
  seen.coneAxis = frame.coneAxisL;
  radiance = vec4(seenColor(lightSurface(seen, albedo, visible), visible), 1.0f);
}
