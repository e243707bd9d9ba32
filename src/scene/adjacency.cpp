#include "scene/adjacency.h"

#include "base/check.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>

namespace gnomon {

namespace {

constexpr uint32_t kNone = 0xffffffffu;

uint64_t mixed(uint64_t value) {  // the finalizer of splitmix64 (Steele, Lea, Flood 2014)
  value = (value ^ value >> 30) * 0xbf58476d1ce4e5b9ull;
  value = (value ^ value >> 27) * 0x94d049bb133111ebull;
  return value ^ value >> 31;
}

// Numbers things by what they equal: the first of equal ones speaks for all.
class FirstOfEqual {
 public:
  explicit FirstOfEqual(size_t most) : slots_(std::bit_ceil(2 * most + 1), kNone) {}
  template <typename Equal>
  uint32_t find(uint32_t thing, uint64_t hash, Equal equal) {
    const size_t mask = slots_.size() - 1;
    for (size_t at = hash & mask;; at = (at + 1) & mask) {
      if (slots_[at] == kNone) slots_[at] = thing;
      if (slots_[at] == thing || equal(slots_[at])) return slots_[at];
    }
  }

 private:
  std::vector<uint32_t> slots_;
};

// Of each vertex the first at its position; -0 equals 0.
std::vector<uint32_t> weld(std::span<const glm::vec3> positions, std::span<const uint32_t> used) {
  std::vector<uint32_t> welded(positions.size(), kNone);
  FirstOfEqual first(used.size());
  for (const uint32_t vertex : used) {
    if (welded[vertex] != kNone) continue;
    const glm::vec3 p = positions[vertex] + 0.0f;
    const uint64_t xy = uint64_t{std::bit_cast<uint32_t>(p.x)} << 32 | std::bit_cast<uint32_t>(p.y);
    welded[vertex] = first.find(vertex, mixed(mixed(xy) ^ std::bit_cast<uint32_t>(p.z)),
                                [&](uint32_t other) { return positions[other] == positions[vertex]; });
  }
  return welded;
}

using Corners = std::array<uint32_t, 3>;  // welded

bool hasArea(const Corners& c) {
  return c[0] != c[1] && c[1] != c[2] && c[2] != c[0];
}

// An edge as one of its triangles has it: opposite to its corner `half % 3`.
struct HalfEdge {
  uint32_t low, high;  // welded vertices
  bool upwards;        // runs from low to high as its triangle winds
};

class Linker {
 public:
  Linker(std::span<const glm::vec3> positions, std::span<const uint32_t> indices,
         std::span<const uint32_t> firstTriangles, Adjacency& result)
      : vertexCount_(positions.size()), corners_(indices.size() / 3), meshOf_(indices.size() / 3), result_(result) {
    const std::vector<uint32_t> welded = weld(positions, indices);
    for (size_t i = 0; i < indices.size(); ++i) corners_[i / 3][i % 3] = welded[indices[i]];
    for (size_t mesh = 0; mesh < firstTriangles.size(); ++mesh)
      std::fill(meshOf_.begin() + firstTriangles[mesh], meshOf_.end(), static_cast<uint32_t>(mesh));
  }

  void link() {
    std::vector<uint32_t> halves = halvesOfFirstFaces();
    countingSort(halves, [&](uint32_t half) { return edgeOf(half).high; });
    countingSort(halves, [&](uint32_t half) { return edgeOf(half).low; });
    const auto sameEdge = [&](uint32_t a, uint32_t b) {
      const HalfEdge p = edgeOf(a), q = edgeOf(b);
      return p.low == q.low && p.high == q.high;
    };
    for (size_t first = 0, next = 0; first < halves.size(); first = next) {
      for (next = first + 1; next < halves.size() && sameEdge(halves[first], halves[next]);) ++next;
      linkEdge(std::span(halves).subspan(first, next - first));
    }
    for (const auto& [copy, original] : copies_) copyLinks(copy, original);
    numberSheets();
  }

 private:
  HalfEdge edgeOf(uint32_t half) const {
    const Corners& c = corners_[half / 3];
    const uint32_t from = c[(half % 3 + 1) % 3], to = c[(half % 3 + 2) % 3];
    return {std::min(from, to), std::max(from, to), from < to};
  }

  // Of all faces with area but those that stand where an earlier one of their mesh does.
  std::vector<uint32_t> halvesOfFirstFaces() {
    const auto count = static_cast<uint32_t>(corners_.size());
    FirstOfEqual faces(count);
    std::vector<uint32_t> halves;
    halves.reserve(corners_.size() * 3);
    const auto sorted = [&](uint32_t t) {
      Corners c = corners_[t];
      std::ranges::sort(c);
      return c;
    };
    for (uint32_t t = 0; t < count; ++t) {
      if (!hasArea(corners_[t])) continue;
      const Corners c = sorted(t);
      const uint64_t hash = mixed(mixed(uint64_t{c[0]} << 32 | c[1]) ^ c[2]);
      const uint32_t same =
          faces.find(t, hash, [&](uint32_t other) { return meshOf_[other] == meshOf_[t] && sorted(other) == c; });
      if (same != t) copies_.emplace_back(t, same);
      for (uint32_t row = 0; same == t && row < 3; ++row) halves.push_back(3 * t + row);
    }
    return halves;
  }

  // Stable.
  template <typename Key>
  void countingSort(std::vector<uint32_t>& halves, Key key) const {
    std::vector<uint32_t> starts(vertexCount_ + 1, 0);
    for (const uint32_t half : halves) ++starts[key(half) + 1];
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    std::vector<uint32_t> sorted(halves.size());
    for (const uint32_t half : halves) sorted[starts[key(half)]++] = half;
    halves = std::move(sorted);
  }

  // All halves of one edge, mesh by mesh: pairs within a mesh, then the one pair of what is open of two.
  void linkEdge(std::span<const uint32_t> halves) {
    std::array<uint32_t, 2> open{};
    size_t openCount = 0;
    for (size_t first = 0, next = 0; first < halves.size(); first = next) {
      for (next = first + 1; next < halves.size() && meshOf_[halves[next] / 3] == meshOf_[halves[first] / 3];) ++next;
      if (next - first > 2) ++result_.nonManifoldEdges;
      if (next - first == 2) linkPair(halves[first], halves[first + 1]);
      if (next - first == 1) open[std::min(openCount++, size_t{1})] = halves[first];
    }
    if (openCount == 2)
      linkPair(open[0], open[1]);
    else
      result_.openEdges += openCount;
  }

  void linkPair(uint32_t a, uint32_t b) {
    const bool turned = edgeOf(a).upwards == edgeOf(b).upwards;
    result_.links[a] = glsl::packLink(b / 3, turned, static_cast<int>(b % 3));
    result_.links[b] = glsl::packLink(a / 3, turned, static_cast<int>(a % 3));
  }

  void copyLinks(uint32_t copy, uint32_t original) {
    for (uint32_t own = 3 * copy; own < 3 * copy + 3; ++own) {
      for (uint32_t other = 3 * original; other < 3 * original + 3; ++other) {
        const HalfEdge mine = edgeOf(own), theirs = edgeOf(other);
        if (mine.low != theirs.low || mine.high != theirs.high || result_.links[other] == glsl::kNoLink) continue;
        result_.links[own] = result_.links[other] ^ (mine.upwards == theirs.upwards ? 0u : 4u);
      }
    }
  }

  // Connected surfaces, by their links. A triangle without area is of none.
  void numberSheets() {
    std::vector<uint32_t>& sheetOf = result_.sheetOf;
    sheetOf.assign(corners_.size(), kNoSheet);
    for (const auto& [copy, original] : copies_) sheetOf[copy] = 0;  // set below
    std::vector<uint32_t> waiting;
    for (uint32_t seed = 0; seed < sheetOf.size(); ++seed) {
      if (sheetOf[seed] != kNoSheet || !hasArea(corners_[seed])) continue;
      const auto sheet = static_cast<uint32_t>(result_.sheets++);
      sheetOf[seed] = sheet;
      waiting.push_back(seed);
      while (!waiting.empty()) {
        const uint32_t t = waiting.back();
        waiting.pop_back();
        for (uint32_t half = 3 * t; half < 3 * t + 3; ++half) {
          const uint32_t link = result_.links[half];
          if (link == glsl::kNoLink || sheetOf[glsl::linkedTriangle(link)] != kNoSheet) continue;
          sheetOf[glsl::linkedTriangle(link)] = sheet;
          waiting.push_back(glsl::linkedTriangle(link));
        }
      }
    }
    for (const auto& [copy, original] : copies_) sheetOf[copy] = sheetOf[original];
  }

  const size_t vertexCount_;
  std::vector<Corners> corners_;
  std::vector<uint32_t> meshOf_;                       // of each triangle
  std::vector<std::pair<uint32_t, uint32_t>> copies_;  // and what they are copies of
  Adjacency& result_;
};

}  // namespace

Adjacency computeAdjacency(std::span<const glm::vec3> positions, std::span<const uint32_t> indices) {
  const uint32_t first = 0;
  return computeAdjacency(positions, indices, std::span(&first, 1));
}

Adjacency computeAdjacency(std::span<const glm::vec3> positions, std::span<const uint32_t> indices,
                           std::span<const uint32_t> firstTriangles) {
  const size_t triangleCount = indices.size() / 3;
  GNOMON_CHECK_LE(triangleCount, glsl::kMostLinkedTriangles);
  Adjacency adjacency;
  adjacency.links.assign(triangleCount * 3, glsl::kNoLink);
  Linker(positions, indices.first(triangleCount * 3), firstTriangles, adjacency).link();
  return adjacency;
}

}  // namespace gnomon
