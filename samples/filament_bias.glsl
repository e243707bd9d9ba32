//! name: filament
//! sentence: Along the normal by half a texel, a millimetre, and twice a texel's slope (Filament's defaults).
//! knob: constant metres 0 1 0.001
//! knob: normal-texels texels 0 16 0.5
//! knob: slope one 0 64 2
// The receiver as if it stood `normal-texels` texels, times the sine of the light's angle, out along its normal; the
// look-up stays where it is, which a bias file cannot move.
bool userLit(ShadowMap map, BiasParams params, Receiver receiver, Tap tap) {
  MapPoint point = mapProject(map, receiver.posL);
  Ray ray = mapTexelRay(map, point.slice, point.uv);
  float texel = texelWidthAt(map, point, ray, receiver.posL);
  float facing = clamp(-dot(receiver.normalL, tap.ray.dir), 0.0f, 1.0f);
  float sine = sqrt(max(1.0f - facing * facing, 0.0f));
  vec3 moved = receiver.posL + receiver.normalL * (params.knobs[kUserNormalTexels] * texel * sine);
  float center = receiverPlaneDepth(map, tap.slice, receiver, tap.ray).depth;
  vec2 uv = mapTexelCenter(map, tap.texel);
  vec2 halfTexel = vec2(0.5f / float(map.width), 0.5f / float(map.height));
  float change = max(planeDepthChange(map, tap.slice, receiver, center, vec2(uv.x + halfTexel.x, uv.y)),
                     planeDepthChange(map, tap.slice, receiver, center, vec2(uv.x, uv.y + halfTexel.y)));
  float depth = depthTowardsLight(map, tap.slice, moved, tap.ray, params.knobs[kUserConstant]);
  return depth - 2.0f * params.knobs[kUserSlope] * change <= tap.z1;
}
