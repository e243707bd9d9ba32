#include "scene/mesh_builder.h"

#include "base/check.h"

#include <cmath>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>

namespace gnomon {

namespace {

double cross2(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

bool insideTriangle(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return cross2(b - a, p - a) >= 0.0 && cross2(c - b, p - b) >= 0.0 && cross2(a - c, p - c) >= 0.0;
}

// Any unit vector at right angles to a unit vector.
glm::dvec3 anyPerpendicular(const glm::dvec3& axis) {
  const glm::dvec3 other = std::abs(axis.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  return glm::normalize(glm::cross(other, axis));
}

}  // namespace

glm::dvec2 onCircle(int i, int n) {
  const double angle = 2.0 * std::numbers::pi * (i % n) / n;
  return {std::cos(angle), std::sin(angle)};
}

std::vector<uint32_t> triangulate(std::span<const glm::dvec2> polygon) {
  std::vector<uint32_t> left(polygon.size());
  for (uint32_t i = 0; i < left.size(); ++i) left[i] = i;
  std::vector<uint32_t> triangles;
  while (left.size() > 3) {
    const size_t n = left.size();
    size_t ear = n;
    for (size_t i = 0; i < n && ear == n; ++i) {
      const glm::dvec2 &a = polygon[left[(i + n - 1) % n]], &b = polygon[left[i]], &c = polygon[left[(i + 1) % n]];
      if (cross2(b - a, c - b) <= 0.0) continue;
      bool empty = true;
      for (size_t k = 2; k + 1 < n && empty; ++k) empty = !insideTriangle(polygon[left[(i + k) % n]], a, b, c);
      if (empty) ear = i;
    }
    GNOMON_CHECK_LT(ear, n);  // a simple counter-clockwise polygon always has an ear
    for (size_t k : {ear + n - 1, ear, ear + 1}) triangles.push_back(left[k % n]);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  triangles.insert(triangles.end(), left.begin(), left.end());
  return triangles;
}

MeshBuilder::MeshBuilder(std::string name, int material) {
  mesh_.name = std::move(name);
  mesh_.material = material;
}

void MeshBuilder::placeAt(const glm::dvec3& origin) {
  worldFromShape_ = glm::translate(glm::dmat4(1.0), origin);
}

uint32_t MeshBuilder::vertex(const glm::dvec3& point, const glm::dvec3& normal, const glm::dvec2& uv) {
  // Shapes are placed by rotation, translation and even scale, so normals turn with the matrix itself.
  mesh_.positions.push_back(glm::vec3(glm::dvec3(worldFromShape_ * glm::dvec4(point, 1.0))));
  mesh_.normals.push_back(glm::vec3(glm::normalize(glm::dvec3(worldFromShape_ * glm::dvec4(normal, 0.0)))));
  mesh_.uvs.push_back(glm::vec2(uv));
  return static_cast<uint32_t>(mesh_.positions.size() - 1);
}

void MeshBuilder::triangle(uint32_t a, uint32_t b, uint32_t c) {
  for (uint32_t i : {a, b, c}) mesh_.indices.push_back(i);
}

void MeshBuilder::quad(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
  const glm::dvec3 normal = glm::cross(c - a, d - b);
  const uint32_t first = vertex(a, normal, {0, 1});
  vertex(b, normal, {1, 1});
  vertex(c, normal, {1, 0});
  vertex(d, normal, {0, 0});
  triangle(first, first + 1, first + 2);
  triangle(first, first + 2, first + 3);
}

void MeshBuilder::box(const glm::dvec3& lower, const glm::dvec3& upper) {
  const auto corner = [&](int x, int y, int z) {
    return glm::dvec3(x ? upper.x : lower.x, y ? upper.y : lower.y, z ? upper.z : lower.z);
  };
  quad(corner(0, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1));
  quad(corner(1, 0, 0), corner(0, 0, 0), corner(0, 1, 0), corner(1, 1, 0));
  quad(corner(1, 0, 1), corner(1, 0, 0), corner(1, 1, 0), corner(1, 1, 1));
  quad(corner(0, 0, 0), corner(0, 0, 1), corner(0, 1, 1), corner(0, 1, 0));
  quad(corner(0, 1, 1), corner(1, 1, 1), corner(1, 1, 0), corner(0, 1, 0));
  quad(corner(0, 0, 0), corner(1, 0, 0), corner(1, 0, 1), corner(0, 0, 1));
}

void MeshBuilder::loop(int segments, int rows, const GridFunction& point, const GridFunction& normal) {
  const uint32_t first = static_cast<uint32_t>(mesh_.positions.size());
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= segments; ++i)
      vertex(point(i % segments, j), normal(i % segments, j),
             {static_cast<double>(i) / segments, 1.0 - static_cast<double>(j) / rows});
  const uint32_t stride = static_cast<uint32_t>(segments) + 1;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < segments; ++i) {
      const uint32_t a = first + static_cast<uint32_t>(j) * stride + static_cast<uint32_t>(i);
      // A row that shrinks to a point makes triangles, not quads.
      const bool tipBelow = point(0, j) == point(1, j);
      const bool tipAbove = point(0, j + 1) == point(1, j + 1);
      if (!tipBelow) triangle(a, a + 1, tipAbove ? a + stride : a + stride + 1);
      if (!tipAbove) triangle(a, a + stride + 1, a + stride);
    }
  }
}

void MeshBuilder::disc(std::span<const glm::dvec3> ring, const glm::dvec3& normal) {
  const uint32_t first = static_cast<uint32_t>(mesh_.positions.size());
  const int n = static_cast<int>(ring.size());
  for (int i = 0; i < n; ++i) vertex(ring[i], normal, 0.5 + 0.5 * onCircle(i, n));
  for (uint32_t i = 1; i + 1 < ring.size(); ++i) triangle(first, first + i, first + i + 1);
}

void MeshBuilder::sphere(const glm::dvec3& center, double radius, int segments, int rings) {
  // From the bottom pole up; x and z so that the outside is in front.
  const auto direction = [&](int i, int j) {
    if (j == 0) return glm::dvec3(0, -1, 0);
    if (j == rings) return glm::dvec3(0, 1, 0);
    const double polar = std::numbers::pi * j / rings;
    const glm::dvec2 c = onCircle(i, segments);
    return glm::dvec3(std::sin(polar) * c.x, -std::cos(polar), -std::sin(polar) * c.y);
  };
  loop(
      segments, rings, [&](int i, int j) { return center + radius * direction(i, j); }, direction);
}

void MeshBuilder::torus(const glm::dvec3& center, double ringRadius, double tubeRadius, int segments, int sides) {
  const auto direction = [&](int i, int j) {
    const glm::dvec2 c = onCircle(i, segments);
    const glm::dvec2 s = onCircle(j, sides);
    return glm::dvec3(s.x * c.x, s.y, -s.x * c.y);
  };
  const auto point = [&](int i, int j) {
    const glm::dvec2 c = onCircle(i, segments);
    return center + ringRadius * glm::dvec3(c.x, 0, -c.y) + tubeRadius * direction(i, j);
  };
  loop(segments, sides, point, direction);
}

void MeshBuilder::lathe(std::span<const glm::dvec2> profile, int segments) {
  for (size_t k = 0; k + 1 < profile.size(); ++k) {
    const glm::dvec2 along = profile[k + 1] - profile[k];
    const glm::dvec2 out(along.y, -along.x);
    const auto point = [&](int i, int j) {
      const glm::dvec2 c = onCircle(i, segments);
      const glm::dvec2 p = profile[k + j];
      return glm::dvec3(p.x * c.x, p.y, -p.x * c.y);
    };
    const auto normal = [&](int i, int) {
      const glm::dvec2 c = onCircle(i, segments);
      return glm::dvec3(out.x * c.x, out.y, -out.x * c.y);
    };
    loop(segments, 1, point, normal);
  }
  for (const bool top : {false, true}) {
    const glm::dvec2 p = top ? profile.back() : profile.front();
    if (p.x <= 0.0) continue;
    std::vector<glm::dvec3> ring;
    for (int i = 0; i < segments; ++i) {
      const glm::dvec2 c = onCircle(top ? i : segments - i, segments);
      ring.emplace_back(p.x * c.x, p.y, -p.x * c.y);
    }
    disc(ring, glm::dvec3(0, top ? 1 : -1, 0));
  }
}

void MeshBuilder::cylinder(const glm::dvec3& from, const glm::dvec3& to, double radius, int segments) {
  const glm::dvec3 path[2] = {from, to};
  tube(path, radius, segments);
}

void MeshBuilder::tube(std::span<const glm::dvec3> path, double radius, int segments) {
  const int last = static_cast<int>(path.size()) - 1;
  // Frames carried along the path by projection, so that the tube does not twist.
  std::vector<glm::dvec3> side, up;
  for (int j = 0; j <= last; ++j) {
    const glm::dvec3 tangent = glm::normalize(path[std::min(j + 1, last)] - path[std::max(j - 1, 0)]);
    const glm::dvec3 before = j == 0 ? anyPerpendicular(tangent) : side.back();
    side.push_back(glm::normalize(before - glm::dot(before, tangent) * tangent));
    up.push_back(glm::cross(tangent, side.back()));
  }
  const auto direction = [&](int i, int j) {
    const glm::dvec2 c = onCircle(i, segments);
    return c.x * side[j] + c.y * up[j];
  };
  const auto point = [&](int i, int j) { return path[j] + radius * direction(i, j); };
  loop(segments, last, point, direction);
  std::vector<glm::dvec3> ring;
  for (int i = 0; i < segments; ++i) ring.push_back(point((segments - i) % segments, 0));
  disc(ring, glm::cross(up[0], side[0]));
  for (int i = 0; i < segments; ++i) ring[i] = point(i, last);
  disc(ring, glm::cross(side[last], up[last]));
}

void MeshBuilder::extrude(std::span<const glm::dvec2> polygon, double zLower, double zUpper) {
  const size_t n = polygon.size();
  for (size_t i = 0; i < n; ++i) {
    const glm::dvec2 &a = polygon[i], &b = polygon[(i + 1) % n];
    quad({a.x, a.y, zUpper}, {a.x, a.y, zLower}, {b.x, b.y, zLower}, {b.x, b.y, zUpper});
  }
  const std::vector<uint32_t> caps = triangulate(polygon);
  for (const bool front : {true, false}) {
    const uint32_t first = static_cast<uint32_t>(mesh_.positions.size());
    for (const glm::dvec2& p : polygon)
      vertex({p.x, p.y, front ? zUpper : zLower}, {0, 0, front ? 1 : -1}, {p.x, -p.y});
    for (size_t k = 0; k < caps.size(); k += 3)
      triangle(first + caps[k], first + caps[front ? k + 1 : k + 2], first + caps[front ? k + 2 : k + 1]);
  }
}

void MeshBuilder::sheet(int columns, int rows, const std::function<glm::dvec3(double s, double t)>& point) {
  const double h = 1e-4;
  const uint32_t first = static_cast<uint32_t>(mesh_.positions.size());
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      const double s = static_cast<double>(i) / columns, t = static_cast<double>(j) / rows;
      const glm::dvec3 ds = point(s + h, t) - point(s - h, t);
      const glm::dvec3 dt = point(s, t + h) - point(s, t - h);
      vertex(point(s, t), glm::cross(ds, dt), {s, 1.0 - t});
    }
  }
  const uint32_t stride = static_cast<uint32_t>(columns) + 1;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const uint32_t a = first + static_cast<uint32_t>(j) * stride + static_cast<uint32_t>(i);
      triangle(a, a + 1, a + stride + 1);
      triangle(a, a + stride + 1, a + stride);
    }
  }
}

// The tips of closed shapes leave a vertex that no triangle uses, which would not come back from a file.
void MeshBuilder::dropUnusedVertices() {
  std::vector<uint32_t> kept(mesh_.positions.size(), 0);
  for (uint32_t index : mesh_.indices) kept[index] = 1;
  uint32_t count = 0;
  for (size_t i = 0; i < kept.size(); ++i) {
    if (kept[i] == 0) continue;
    mesh_.positions[count] = mesh_.positions[i];
    mesh_.normals[count] = mesh_.normals[i];
    mesh_.uvs[count] = mesh_.uvs[i];
    kept[i] = count++;
  }
  mesh_.positions.resize(count);
  mesh_.normals.resize(count);
  mesh_.uvs.resize(count);
  for (uint32_t& index : mesh_.indices) index = kept[index];
}

Mesh MeshBuilder::build() {
  dropUnusedVertices();
  mesh_.closed = computeClosed(mesh_);
  return std::move(mesh_);
}

}  // namespace gnomon
