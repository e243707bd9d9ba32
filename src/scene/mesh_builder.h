#pragma once
// Closed solids and open sheets from which the generated scenes are composed.
//
// Everything is computed in double and rounded once, and points that two faces share come from one expression, so that
// they weld exactly: a solid built here is closed in the sense of computeClosed, as long as no two solids of one mesh
// touch. Faces are counter-clockwise seen from outside (sheets: from the stated side).

#include "scene/scene.h"

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace gnomon {

class MeshBuilder {
 public:
  MeshBuilder(std::string name, int material);

  // Where the next shapes are put; must not mirror. Identity at first.
  void place(const glm::dmat4& worldFromShape) { worldFromShape_ = worldFromShape; }
  void placeAt(const glm::dvec3& origin);

  // One flat face of two triangles, corners counter-clockwise seen from its front; uv (0,1) (1,1) (1,0) (0,0).
  void quad(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d);

  // 12 triangles.
  void box(const glm::dvec3& lower, const glm::dvec3& upper);

  // Poles on y. 2 * segments * (rings - 1) triangles.
  void sphere(const glm::dvec3& center, double radius, int segments, int rings);

  // About the y axis through the centre. 2 * segments * sides triangles.
  void torus(const glm::dvec3& center, double ringRadius, double tubeRadius, int segments, int sides);

  // A profile of (radius, y), bottom to top, turned about y: sharp along the profile, smooth around it. Ends
  // with a radius above 0 are closed with a disc; radius 0 makes a tip. 2 * segments * (points - 1)
  // triangles, plus segments - 2 a disc, less segments a tip.
  void lathe(std::span<const glm::dvec2> profile, int segments);

  // Straight, from one point to another, closed by discs. 4 * segments - 4 triangles.
  void cylinder(const glm::dvec3& from, const glm::dvec3& to, double radius, int segments);

  // A round tube along a path of two points or more, closed by discs; smooth all over.
  // 2 * segments * (points - 1) + 2 * (segments - 2) triangles.
  void tube(std::span<const glm::dvec3> path, double radius, int segments);

  // A simple polygon in xy, counter-clockwise, extruded along z from zLower to zUpper. 4 * points - 4 triangles.
  void extrude(std::span<const glm::dvec2> polygon, double zLower, double zUpper);

  // An open grid of columns x rows cells over (s, t) in [0,1]^2, smooth; its front is where d/ds x d/dt
  // points. uv = (s, 1 - t). 2 * columns * rows triangles.
  void sheet(int columns, int rows, const std::function<glm::dvec3(double s, double t)>& point);

  // A closed surface of cells around (i, wrapping) and along (j); point(i, j) and normal(i, j) of vertex j = 0..rows.
  using GridFunction = std::function<glm::dvec3(int i, int j)>;
  void loop(int segments, int rows, const GridFunction& point, const GridFunction& normal);

  // The finished mesh; `closed` is computed.
  Mesh build();

 private:
  uint32_t vertex(const glm::dvec3& point, const glm::dvec3& normal, const glm::dvec2& uv);
  void triangle(uint32_t a, uint32_t b, uint32_t c);
  void disc(std::span<const glm::dvec3> ring, const glm::dvec3& normal);

  void dropUnusedVertices();

  Mesh mesh_;
  glm::dmat4 worldFromShape_{1.0};
};

// A point on a circle; segment i of n, the same bits for i and i + n.
glm::dvec2 onCircle(int i, int n);

// Triangles of a simple counter-clockwise polygon by ear clipping: points - 2 of them (three indices each).
std::vector<uint32_t> triangulate(std::span<const glm::dvec2> polygon);

}  // namespace gnomon
