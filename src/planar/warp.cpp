#include "planar/warp.h"

#include "planar/convex_body.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace gnomon {

constinit const ChoiceOption<Warp> kWarp(
    {.name = "warp",
     .sentence = "a warp that gives the texels of spot and directional maps to what is near the camera",
     .results = InResults::EveryRow},
    Warp::None,
    {{Warp::None, "none", "no warp"},
     {Warp::Psm, "psm", "perspective shadow maps"},
     {Warp::Lispsm, "lispsm", "light space perspective shadow maps"},
     {Warp::Tsm, "tsm", "trapezoidal shadow maps"}});

namespace {

// The camera's depths of what it sees, metres.
struct ViewRange {
  double nearest = 1e30;
  double farthest = -1e30;
};

ViewRange viewRange(const WarpInput& input) {
  ViewRange range;
  for (const glm::dvec3& receiver : input.receiversW) {
    const double depth = viewDepth(input.camera, receiver);
    range.nearest = std::min(range.nearest, depth);
    range.farthest = std::max(range.farthest, depth);
  }
  return range;
}

// Scales (X, Y) so that the points fill the square but for half a texel; nothing where W is not positive on
// all of it or varies too much.
std::optional<glm::dmat3> fillSquare(const glm::dmat3& rows, std::span<const glm::dvec2> points, int side) {
  Window box{.lower = glm::dvec2(1e300), .upper = glm::dvec2(-1e300)};
  for (const glm::dvec2& point : points) {
    const glm::dvec3 p = rows * glm::dvec3(point, 1.0);
    if (!(p.z > 0.0)) return std::nullopt;
    box.lower = glm::min(box.lower, glm::dvec2(p) / p.z);
    box.upper = glm::max(box.upper, glm::dvec2(p) / p.z);
  }
  // Of a line of points, 1e-6 of the square's middle is the least width that still has an inverse.
  const glm::dvec2 pad =
      (box.upper - box.lower) * (0.5 / side) + 1e-6 * glm::max(glm::abs(box.lower), glm::abs(box.upper)) + 1e-12;
  box = {.lower = box.lower - pad, .upper = box.upper + pad};
  glm::dmat3 m = clipFromPlane(box) * rows;
  // A mirrored slice (a window's has a negative determinant, y being down) would show the rasterizer every
  // face from its other side.
  if (glm::determinant(m) > 0.0) m = glm::dmat3({-1, 0, 0}, {0, 1, 0}, {0, 0, 1}) * m;
  m *= (glm::inverse(m) * glm::dvec3(0.0, 0.0, 1.0)).z;  // W is 1 in the square's middle
  const WRange w = wRange(m);
  if (!(w.least > 0.0) || w.greatest > kMostWarp * w.least) return std::nullopt;
  return m;
}

// LiSPSM and TSM: a frustum that lies across the light.
//
//        C          t   the way the camera looks, seen from the light
//       /|\ |       s   across it
//      / | \| n     n   from the projection centre C to what is nearest
//     /--+--\       W = n + t - tNearest, X = s - s of C, Y = 1
//    /   t   \      Y/W falls from 1/n, spending more texels on what is near the smaller n is
struct Axis {
  glm::dvec2 through{0.0};  // plane coordinates; C lies on the line through it
  glm::dvec2 t{0.0};        // unit
  double metre = 1.0;       // in plane coordinates, at the middle of what is seen
  double sinAngle = 0.0;    // between the light and the view
};

// Where the light shines along the view there is no axis: its sine is 0.
//
// Differs from the papers: the line runs through the eye only where the light is directional. The eye may
// stand beside or behind a spot, so there the line is the view direction seen from the light at the middle of
// the receivers, which is what both papers' detour by the light's perspective space tends to where the
// receivers are close together.
Axis viewAxis(const WarpInput& input) {
  glm::dvec3 middle(0.0);
  for (const glm::dvec3& receiver : input.receiversW)
    middle += input.frame.lightFromWorld(receiver) / static_cast<double>(input.receiversW.size());
  const glm::dvec3 view = glm::transpose(input.frame.worldFromLight) * glm::dvec3(input.camera.forwardW);
  Axis axis;
  glm::dvec3 ray(0.0, 0.0, -1.0);
  glm::dvec2 along(view);
  if (input.frame.perspective) {
    const double depth = std::max(-middle.z, 1e-12);
    ray = glm::normalize(middle);
    axis.through = glm::dvec2(middle) / depth;
    axis.metre = 1.0 / depth;
    along = glm::dvec2(view) + axis.through * view.z;  // d (x/-z) = (dx + x/-z dz) / -z
  } else {
    axis.through = glm::dvec2(input.frame.lightFromWorld(glm::dvec3(input.camera.eyeW)));
  }
  const double length = glm::length(along);
  axis.sinAngle = length > 0.0 ? glm::length(glm::cross(ray, view)) : 0.0;
  if (length > 0.0) axis.t = along / length;
  return axis;
}

struct Extent {
  double lower = 1e300;
  double upper = -1e300;
  double length() const { return upper - lower; }
};

Extent extentAlong(const glm::dvec2& direction, std::span<const glm::dvec2> points) {
  Extent extent;
  for (const glm::dvec2& point : points) {
    extent.lower = std::min(extent.lower, glm::dot(direction, point));
    extent.upper = std::max(extent.upper, glm::dot(direction, point));
  }
  return extent;
}

// Wimmer, Scherzer, Purgathofer, "Light Space Perspective Shadow Maps", EGSR 2004, section 4.2, in the form of its
// later errata: n = (z_n + sqrt(z_n z_f)) / sin gamma, z_n and z_f the camera's depths of what it sees.
double lispsmDistance(const WarpInput& input, const Axis& axis) {
  const ViewRange range = viewRange(input);
  return axis.metre * (range.nearest + std::sqrt(range.nearest * range.farthest)) / axis.sinAngle;
}

// Martin and Tan, "Anti-aliasing and Continuity with Trapezoidal Shadow Maps", EGSR 2004, section 5: a focus
// point delta behind the trapezoid's top line, of a trapezoid lambda long, shall fall on the line xi = -0.6,
// with 80% of the map before it: eta = (lambda delta + lambda delta xi) / (lambda - 2 delta - lambda xi). The
// paper leaves the focus to the application; here half of what the camera sees lies before it. Infinite where
// that half fills 80% without a warp.
double tsmDistance(const WarpInput& input, const Axis& axis, const Extent& extent) {
  std::vector<double> along;
  for (const glm::dvec3& receiver : input.receiversW)
    along.push_back(glm::dot(axis.t, glm::dvec2(input.frame.planeFromWorld(receiver))));
  const auto middle = along.begin() + static_cast<std::ptrdiff_t>(along.size() / 2);
  std::nth_element(along.begin(), middle, along.end());
  constexpr double kXi = -0.6;
  const double lambda = extent.length();
  const double delta = std::max(*middle - extent.lower, 0.0);
  const double free = lambda - 2.0 * delta - lambda * kXi;
  return free > 0.0 ? lambda * delta * (1.0 + kXi) / free : INFINITY;
}

WarpedPlane warpAlongAxis(Warp warp, const WarpInput& input) {
  const Axis axis = viewAxis(input);
  const Extent extent = extentAlong(axis.t, input.points);
  // The warp fades out as the light turns to the view; its whole effect is then below a texel.
  if (axis.sinAngle < 1.0 / input.side || extent.length() <= 0.0)
    return {.note = fmt::format("{}: not applied, the light shines along the view direction", kWarp.text(warp))};
  double n = warp == Warp::Lispsm ? lispsmDistance(input, axis) : tsmDistance(input, axis, extent);
  if (!std::isfinite(n))
    return {.note =
                fmt::format("{}: not applied, the nearer half of the visible receivers already fills 80% of the map",
                            kWarp.text(warp))};
  // Where it is nearer W would vary by more over the points alone; the square is a texel longer, and so its
  // bound is found by trying, in steps that lose at most 5%.
  const double wanted = n;
  n = std::max(n, extent.length() / (kMostWarp - 1.0));
  const glm::dvec2 s(axis.t.y, -axis.t.x);
  for (; n < 1e3 * extent.length() + 2.0 * wanted; n *= 1.05) {
    const glm::dmat3 rows = glm::transpose(
        glm::dmat3({s.x, s.y, -glm::dot(s, axis.through)}, {0.0, 0.0, 1.0}, {axis.t.x, axis.t.y, n - extent.lower}));
    const auto filled = fillSquare(rows, input.points, input.side);
    if (!filled) continue;
    return {.clipFromPlane = *filled,
            .warped = true,
            .note = n > wanted ? fmt::format("{}: weakened, so that texel size varies at most {:g} times",
                                             kWarp.text(warp), kMostWarp)
                               : ""};
  }
  return {.note = fmt::format("{}: not applied, the visible receivers are too narrow", kWarp.text(warp))};
}

// The camera as PSM has it, moved back by `back` metres, with a view frustum about what the first one sees:
// x, y in [-1,1] and z in [0,1] after division.
struct PostPerspective {
  glm::dvec3 eyeW{0.0};
  glm::dmat3 axesFromWorld{1.0};  // right, up, forward
  double tanHalfX = 1.0, tanHalfY = 1.0, nearest = 1.0, farthest = 2.0;

  glm::dvec4 operator()(const glm::dvec3& vectorW, double w) const {
    const glm::dvec3 p = axesFromWorld * (vectorW - w * eyeW);
    const double scale = farthest / (farthest - nearest);
    return {p.x / tanHalfX, p.y / tanHalfY, (p.z - w * nearest) * scale, p.z};
  }
};

PostPerspective postPerspective(const glsl::CameraView& camera, const ViewRange& range, double back) {
  const double farthest = std::max(range.farthest, range.nearest * (1.0 + 1e-3)) + back;
  const double narrowing = (farthest - back) / farthest;
  return {.eyeW = glm::dvec3(camera.eyeW) - back * glm::dvec3(camera.forwardW),
          .axesFromWorld = glm::transpose(
              glm::dmat3(glm::dvec3(camera.rightW), glm::dvec3(camera.upW), glm::dvec3(camera.forwardW))),
          .tanHalfX = static_cast<double>(camera.tanHalfX) * narrowing,
          .tanHalfY = static_cast<double>(camera.tanHalfY) * narrowing,
          .nearest = range.nearest + back,
          .farthest = farthest};
}

// The light of post-perspective space looks at the middle G of the unit cube from q (homogeneous). With unit axes u, v,
// a, where a runs from q to G: X = u.(p - G), Y = v.(p - G), W = a.p q.w - a.q p.w, each 0 at q itself, and W the
// distance along a, up to a factor. Where q lies at infinity W is p.w, and the light is directional there.
std::optional<glm::dmat3> psmRows(const WarpInput& input, const PostPerspective& camera) {
  const AxisFrame& frame = input.frame;
  const glm::dvec3 towards = frame.worldFromLight[2];
  const glm::dvec4 q = frame.perspective ? camera(frame.originW, 1.0) : camera(towards, 0.0);
  const glm::dvec3 middle(0.0, 0.0, 0.5);
  const glm::dvec3 toMiddle = middle * q.w - glm::dvec3(q);
  if (glm::length(toMiddle) == 0.0) return std::nullopt;
  const glm::dvec3 a = glm::normalize(toMiddle);
  const glm::dvec3 hint = std::abs(a.z) > 0.999 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
  const glm::dvec3 u = glm::normalize(glm::cross(hint, a));
  const glm::dvec3 v = glm::cross(a, u);
  const auto project = [&](const glm::dvec4& p) {
    const glm::dvec3 offset = glm::dvec3(p) - middle * p.w;
    return glm::dvec3(glm::dot(u, offset), glm::dot(v, offset),
                      glm::dot(a, glm::dvec3(p)) * q.w - glm::dot(a, glm::dvec3(q)) * p.w);
  };
  // A ray h meets, apart from the light itself, the direction right x + up y - back (perspective) or the
  // point at depth 0.
  const glm::dvec3 third = frame.perspective ? project(camera(-towards, 0.0)) : project(camera(frame.originW, 1.0));
  glm::dmat3 rows(project(camera(frame.worldFromLight[0], 0.0)), project(camera(frame.worldFromLight[1], 0.0)), third);
  const glm::dvec2 some = input.points.front();
  if ((rows * glm::dvec3(some, 1.0)).z < 0.0) rows *= -1.0;
  return rows;
}

// Stamminger and Drettakis, "Perspective Shadow Maps", SIGGRAPH 2002. Their remedy for what lies behind the
// camera, to move a virtual camera back, weakens the warp until it is none at infinity.
WarpedPlane warpPsm(const WarpInput& input) {
  const ViewRange range = viewRange(input);
  const double step = std::max(range.farthest - range.nearest, 1e-3 * range.farthest) / 64.0;
  constexpr int kSteps = 16;  // to 500 times the depth of what is seen
  for (int i = 0; i <= kSteps; ++i) {
    const double back = i == 0 ? 0.0 : step * std::exp2(i - 1);
    const auto rows = psmRows(input, postPerspective(input.camera, range, back));
    const auto filled = rows ? fillSquare(*rows, input.points, input.side) : std::nullopt;
    if (!filled) continue;
    return {.clipFromPlane = *filled,
            .warped = true,
            .note = i == 0 ? "" : fmt::format("psm: the virtual camera is {:.3g} m behind the camera", back)};
  }
  return {.note = "psm: not applied, the light is among the visible receivers"};
}

}  // namespace

WarpedPlane warpPlane(Warp warp, const WarpInput& input) {
  if (input.receiversW.empty() || input.points.empty())
    return {.note = fmt::format("{}: not applied, no visible surface faces the light", kWarp.text(warp))};
  return warp == Warp::Psm ? warpPsm(input) : warpAlongAxis(warp, input);
}

std::vector<glm::dvec2> convexHull(std::vector<glm::dvec2> points) {
  const auto turnsLeft = [](const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 0.0;
  };
  std::ranges::sort(points,
                    [](const glm::dvec2& a, const glm::dvec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<glm::dvec2> hull;
  for (const int pass : {0, 1}) {
    const size_t start = hull.size();
    for (const glm::dvec2& point : points) {
      while (hull.size() >= start + 2 && !turnsLeft(hull[hull.size() - 2], hull.back(), point)) hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();  // the next chain begins with it
    if (pass == 0) std::ranges::reverse(points);
  }
  return hull;
}

}  // namespace gnomon
