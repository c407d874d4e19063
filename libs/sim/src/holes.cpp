// SPDX-License-Identifier: BSD-3-Clause
#include "holes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mesh_builder.h"
#include "mrpt_terrain/sim/world.h"

namespace mrpt_terrain::sim {
namespace {

// Walls from this angle on carry no wheel.
constexpr double kSteep = M_PI / 4;
// Distance, metres, up to which a corner that clipping made lies on the line that made it.
constexpr double kOnLine = 1e-9;

using Triangle = std::array<Eigen::Vector3d, 3>;

/// One triangle of the ground and its heights beyond its corners.
class Facet {
 public:
  explicit Facet(const Triangle& corners) : corners_(corners) {
    const Eigen::Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    gradient_ = -normal.head<2>() / normal.z();
  }
  [[nodiscard]] Eigen::Vector3d lift(const Eigen::Vector2d& p, double lowered = 0.0) const {
    const double rise = gradient_.dot(p - corners_[0].head<2>());
    return {p.x(), p.y(), corners_[0].z() + rise - lowered};
  }
  [[nodiscard]] Polygon outline() const {
    return {corners_[0].head<2>(), corners_[1].head<2>(), corners_[2].head<2>()};
  }

 private:
  Triangle corners_;
  Eigen::Vector2d gradient_;
};

template <class Lowering>
void add_fan(const Facet& facet, const Polygon& polygon, Lowering&& lowering, SurfaceKind kind,
             MeshBuilder& builder) {
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    builder.add_triangle(facet.lift(polygon[0], lowering(polygon[0])),
                         facet.lift(polygon[i - 1], lowering(polygon[i - 1])),
                         facet.lift(polygon[i], lowering(polygon[i])), kind);
  }
}

double distance_from_line(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                          const Eigen::Vector2d& p) {
  return side_of(a, b, p) / (b - a).norm();
}

// Upright walls under the edges of `inside` that lie on the rim.
void add_upright_walls(const Facet& facet, const Hole& hole, const Polygon& inside,
                       MeshBuilder& builder) {
  for (std::size_t r = 0; r < hole.rim.size(); ++r) {
    const Eigen::Vector2d& a = hole.rim[r];
    const Eigen::Vector2d& b = hole.rim[(r + 1) % hole.rim.size()];
    for (std::size_t i = 0; i < inside.size(); ++i) {
      const Eigen::Vector2d& p = inside[i];
      const Eigen::Vector2d& q = inside[(i + 1) % inside.size()];
      const bool on_rim = std::abs(distance_from_line(a, b, p)) < kOnLine &&
                          std::abs(distance_from_line(a, b, q)) < kOnLine;
      if (!on_rim || (q - p).norm() < kOnLine) continue;
      builder.add_quad(facet.lift(p), facet.lift(q), facet.lift(q, hole.depth),
                       facet.lift(p, hole.depth), SurfaceKind::kFlank);
    }
  }
}

// Between each edge of the rim and that of the floor.
void add_sloped_walls(const Facet& facet, const Hole& hole, const Polygon& inside,
                      MeshBuilder& builder) {
  const SurfaceKind kind = hole.wall_angle < kSteep ? SurfaceKind::kDrivable : SurfaceKind::kFlank;
  const double fall = std::tan(hole.wall_angle);
  for (std::size_t r = 0; r < hole.rim.size(); ++r) {
    const std::size_t next = (r + 1) % hole.rim.size();
    const Eigen::Vector2d& a = hole.rim[r];
    const Eigen::Vector2d& b = hole.rim[next];
    const Polygon sector = intersection(inside, {a, b, hole.floor[next], hole.floor[r]});
    add_fan(
        facet, sector,
        [&](const Eigen::Vector2d& p) {
          return std::clamp(fall * distance_from_line(a, b, p), 0.0, hole.depth);
        },
        kind, builder);
  }
}

void add_hole(const Facet& facet, const Hole& hole, const Polygon& inside, Mesh& mesh) {
  MeshBuilder builder(mesh, hole.solid);
  add_fan(
      facet, intersection(inside, hole.floor), [&](const Eigen::Vector2d&) { return hole.depth; },
      SurfaceKind::kDrivable, builder);
  if (hole.upright_walls()) {
    add_upright_walls(facet, hole, inside, builder);
  } else {
    add_sloped_walls(facet, hole, inside, builder);
  }
}

struct Bounds {
  Eigen::Vector2d low, high;
  [[nodiscard]] bool touches(const Bounds& other) const {
    return (low.array() <= other.high.array()).all() && (high.array() >= other.low.array()).all();
  }
};

Bounds bounds_of(const Polygon& polygon) {
  Bounds bounds{polygon[0], polygon[0]};
  for (const Eigen::Vector2d& p : polygon) {
    bounds = {bounds.low.cwiseMin(p), bounds.high.cwiseMax(p)};
  }
  return bounds;
}

// Cuts one triangle of the ground; false if no hole is near and it can be added as it is.
bool add_cut(const Facet& facet, const std::vector<Hole>& holes,
             const std::vector<Bounds>& bounds_of_holes, Mesh& mesh) {
  const Bounds bounds = bounds_of(facet.outline());
  std::vector<Polygon> left{facet.outline()};
  bool cut = false;
  for (std::size_t h = 0; h < holes.size(); ++h) {
    if (!bounds.touches(bounds_of_holes[h])) continue;
    cut = true;
    std::vector<Polygon> still_left;
    for (Polygon& polygon : left) {
      Split parts = split(std::move(polygon), holes[h].rim);
      std::move(parts.outside.begin(), parts.outside.end(), std::back_inserter(still_left));
      if (!parts.inside.empty()) add_hole(facet, holes[h], parts.inside, mesh);
    }
    left = std::move(still_left);
  }
  if (!cut) return false;
  MeshBuilder builder(mesh, kGroundSolid);
  for (const Polygon& polygon : left) {
    add_fan(
        facet, polygon, [](const Eigen::Vector2d&) { return 0.0; }, SurfaceKind::kDrivable,
        builder);
  }
  return true;
}

}  // namespace

double lowered_by(const std::vector<Hole>& holes, double x, double y) {
  const Eigen::Vector2d p(x, y);
  for (const Hole& hole : holes) {
    if (!contains(hole.rim, p)) continue;
    if (hole.upright_walls() || contains(hole.floor, p)) return hole.depth;
    double nearest = hole.depth / std::tan(hole.wall_angle);
    for (std::size_t r = 0; r < hole.rim.size(); ++r) {
      nearest = std::min(nearest,
                         distance_from_line(hole.rim[r], hole.rim[(r + 1) % hole.rim.size()], p));
    }
    return std::tan(hole.wall_angle) * nearest;
  }
  return 0.0;
}

void add_ground(const GroundSurface& ground, const std::vector<Hole>& holes, Mesh& mesh) {
  std::vector<Bounds> bounds;
  for (const Hole& hole : holes) bounds.push_back(bounds_of(hole.rim));
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto row = static_cast<std::uint32_t>(ground.nodes_x());
  for (std::size_t k = 0; k < ground.nodes_y(); ++k) {
    for (std::size_t i = 0; i < ground.nodes_x(); ++i) mesh.vertices.push_back(ground.node(i, k));
  }
  for (std::uint32_t k = 0; k + 1 < ground.nodes_y(); ++k) {
    for (std::uint32_t i = 0; i + 1 < row; ++i) {
      const std::uint32_t corner = first + k * row + i;
      const std::uint32_t opposite = corner + row + 1;
      for (const auto& [b, c] : {std::pair{corner + 1, opposite}, {opposite, corner + row}}) {
        const Facet facet({mesh.vertices[corner], mesh.vertices[b], mesh.vertices[c]});
        if (add_cut(facet, holes, bounds, mesh)) continue;
        mesh.triangles.push_back({corner, b, c});
        mesh.solid.push_back(kGroundSolid);
        mesh.kind.push_back(SurfaceKind::kDrivable);
      }
    }
  }
}

}  // namespace mrpt_terrain::sim
