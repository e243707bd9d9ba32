// The point of a triangle that a pixel sees, with all that its pixels have in common found once for the triangle: where
// the pixel's ray meets the triangle's plane. In the light's frame, so that what is near the light keeps its digits.
//
//     eye                    d = first + stepX x + stepY y    one metre along the camera's axis,
//      \                     t = height / (n.d)               so that t is the distance along that axis
//   d   \     n              point = eye + d t
//        \    |
//     -----P--+-------- plane, `height` = n.(corner - eye)
//
// Rounding: an error e of n.d, an ulp or two of |d|, moves the point along d by t e / (n.d), and so off the plane by
// t e, an ulp or two of the distance, however flat the view; as the weighted sum of the corners in surfacePoint does.
// d is the rounded direction in both places: its own error moves the point along the plane alone, as it does there.
//
// A pixel's ray may pass by its triangle by the 1/256 pixel of the rasterizer's grid. Where the plane is seen edge-on
// that is far along it: t is held within the triangle's own distances and a 64th of them beyond. A ray that meets the
// plane at more than 64 times the angle of that 1/256, a quarter of a pixel's, never gets there.
#ifndef GNOMON_PLANE_VIEW_GLSL
#define GNOMON_PLANE_VIEW_GLSL

#include "shared/geometry.glsl"
#include "shared/lang.glsl"
#include "shared/light_frame.glsl"
#include "shared/scene.glsl"

GNOMON_SHARED_BEGIN

// The camera in the light's frame.
struct EyeView {
  vec3 eyeL;
  vec3 firstL;  // the ray of the picture's upper left corner, one metre along the camera's axis
  vec3 stepXL;  // from one pixel to the next
  vec3 stepYL;
};

GNOMON_FN EyeView eyeView(CameraView camera, LightFrame frame) {
  EyeView view;
  vec3 right = directionFromWorld(frame, camera.rightW);
  vec3 up = directionFromWorld(frame, camera.upW);
  view.eyeL = lightFromWorld(frame, camera.eyeW);
  view.stepXL = right * (2.0f * camera.tanHalfX / float(camera.width));
  view.stepYL = up * (-2.0f * camera.tanHalfY / float(camera.height));
  view.firstL = directionFromWorld(frame, camera.forwardW) - right * camera.tanHalfX + up * camera.tanHalfY;
  return view;
}

// Through the pixel's place, whose centre lies at halves.
GNOMON_FN vec3 eyeDirection(EyeView view, vec2 at) { return view.firstL + view.stepXL * at.x + view.stepYL * at.y; }

struct PlaneView {
  vec3 normalL;   // unit; 0 where the triangle has no area
  float height;   // metres: of the plane over the eye
  float nearest;  // metres along the camera's axis, of the triangle
  float farthest;
};

GNOMON_FN PlaneView planeView(EyeView view, vec3 axisL, vec3 aL, vec3 bL, vec3 cL) {
  PlaneView plane;
  vec3 scaledNormal = cross(bL - aL, cL - aL);
  float area = length(scaledNormal);
  plane.normalL = area > 0.0f ? scaledNormal * (1.0f / area) : vec3(0.0f, 0.0f, 0.0f);
  plane.height = dot(plane.normalL, aL - view.eyeL);
  float a = dot(axisL, aL - view.eyeL);
  float b = dot(axisL, bL - view.eyeL);
  float c = dot(axisL, cL - view.eyeL);
  plane.nearest = min(a, min(b, c)) * (63.0f / 64.0f);
  plane.farthest = max(a, max(b, c)) * (65.0f / 64.0f);
  return plane;
}

// Metres along the camera's axis.
GNOMON_FN float planeDistance(PlaneView plane, vec3 dirL) {
  float t = plane.height / dot(plane.normalL, dirL);
  // What is no number (an eye in the plane) is not above the nearest, either.
  return t > plane.nearest ? min(t, plane.farthest) : plane.nearest;
}

GNOMON_SHARED_END
#endif
