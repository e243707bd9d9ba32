// One visibility shader for every map and every bias: G-buffer pixel -> receiver -> tap -> lit or not.
//
// The method, the map's kind and its layer count are specialization constants, so that each pipeline holds one bias on one
// map only, and reads the matrices of a single layer from constant addresses. kDiagnose also writes what decided the
// pixel; timings are taken without it.
#include "shared/bias.glsl"
#include "shared/shade.glsl"

#include "scene/surface_fetch.glsl"

layout(local_size_x = kShadeGroupSide, local_size_y = kShadeGroupSide) in;

layout(constant_id = 0) const int kMethod = kBiasNone;
layout(constant_id = 1) const int kDiagnose = 0;
layout(constant_id = 2) const int kMapKind = kMapPlanar;
layout(constant_id = 3) const int kLayerCount = 1;
layout(constant_id = 5) const int kSecondLayer = 0;  // 1: the method reads z2

layout(binding = kBindMapDepth) uniform texture2DArray mapDepthLayers;
layout(binding = kBindSecondDepth) uniform texture2DArray secondDepthLayers;
layout(scalar, binding = kBindShade) uniform Shade { ShadeUniforms shade; };
layout(scalar, binding = kBindVisibility) writeonly buffer Visibility { float visibility[]; };
layout(scalar, binding = kBindDiagnosis) writeonly buffer Diagnosis { PixelDiagnosis diagnosis[]; };

ShadowMap specializedMap() {
  ShadowMap map = shadowMap;
  map.kind = kMapKind;
  map.layerCount = kLayerCount;
  return map;
}

Tap fetchTap(ShadowMap map, int layer, ivec2 texel) {
  Tap tap;
  tap.layer = layer;
  tap.texel = texel;
  tap.ray = mapTexelRay(map, layer, mapTexelCenter(map, texel));
  tap.z1 = texelFetch(mapDepthLayers, ivec3(texel, layer), 0).x;
  tap.z2 = 1.0f;
  if (kSecondLayer == 1) tap.z2 = texelFetch(secondDepthLayers, ivec3(texel, layer), 0).x;
  return tap;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= shade.camera.width || pixel.y >= shade.camera.height) return;
  uint index = uint(pixel.y * shade.camera.width + pixel.x);

  PrimitiveId id = fetchPrimitive(pixel);
  uint flags = 0u;
  uint texelWord = 0u;
  float result = 1.0f;
  if (id.instancePlusOne != 0u) {
    SurfacePoint surface = fetchSurface(shade.camera, pixel, id);
    float lightSide = dot(surface.normal, towardsLight(shade, surface.position));
    float cameraSide = dot(surface.normal, shade.camera.eyeW - surface.position);
    result = 0.0f;
    if (lightSide * cameraSide > 0.0f) {
      flags = kPixelShaded;
      Receiver receiver;
      receiver.posL = lightFromWorld(lightFrame, surface.position);
      receiver.normalL = directionFromWorld(lightFrame, lightSide > 0.0f ? surface.normal : -surface.normal);
      ShadowMap map = specializedMap();
      receiver = biasReceiver(kMethod, map, shade.bias, receiver);
      MapPoint point = mapProject(map, receiver.posL);
      result = 1.0f;
      if (point.covered) {
        Tap tap = fetchTap(map, point.layer, mapTexel(map, point.uv));
        bool known;
        bool lit = biasLit(kMethod, map, shade.bias, receiver, tap, known);
        result = known ? (lit ? 1.0f : 0.0f) : kUnknownVisibility;
        if (kDiagnose == 1) {
          flags |= kPixelCovered | (lit ? kPixelLit : 0u) | (known ? 0u : kPixelUnknown);
          if (receiverPlaneDepth(map, tap.layer, receiver, tap.ray).grazing) flags |= kPixelGrazing;
          texelWord = packTexel(tap.layer, tap.texel);
        }
      }
    }
  }
  visibility[index] = result;
  if (kDiagnose == 1) {
    diagnosis[index].texel = texelWord;
    diagnosis[index].flags = flags;
  }
}
