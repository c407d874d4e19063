// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "mrpt_terrain/sim/world.h"

/// \file
/// Triangle meshes written by hand, for tests of what is cast into them.
namespace mrpt_terrain::worlds {

/// Adds a triangle, counter-clockwise seen from outside.
inline void add_triangle(sim::Mesh& mesh, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                         const Eigen::Vector3d& c, std::int32_t solid, sim::SurfaceKind kind) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.solid.push_back(solid);
  mesh.kind.push_back(kind);
}

/// Adds the parallelogram at `corner` spanned by u and v, seen from where u x v points to.
inline void add_patch(sim::Mesh& mesh, const Eigen::Vector3d& corner, const Eigen::Vector3d& u,
                      const Eigen::Vector3d& v, std::int32_t solid, sim::SurfaceKind kind) {
  add_triangle(mesh, corner, corner + u, corner + u + v, solid, kind);
  add_triangle(mesh, corner, corner + u + v, corner + v, solid, kind);
}

/// Adds all six sides of a box.
inline void add_box(sim::Mesh& mesh, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                    std::int32_t solid) {
  const Eigen::Vector3d size = high - low;
  const Eigen::Vector3d x(size.x(), 0, 0), y(0, size.y(), 0), z(0, 0, size.z());
  for (const auto& [u, v] : {std::pair{x, y}, std::pair{y, z}, std::pair{z, x}}) {
    add_patch(mesh, low, v, u, solid, sim::SurfaceKind::kObject);
    add_patch(mesh, high - u - v, u, v, solid, sim::SurfaceKind::kObject);
  }
}

/// A level drivable square about (x, y).
inline void add_ground(sim::World& world, double x, double y, double z, double half_size) {
  const double size = 2.0 * half_size;
  add_patch(world.mesh, {x - half_size, y - half_size, z}, {size, 0, 0}, {0, size, 0},
            sim::kGroundSolid, sim::SurfaceKind::kDrivable);
  world.min_corner = {x - half_size, y - half_size};
  world.max_corner = {x + half_size, y + half_size};
}

}  // namespace mrpt_terrain::worlds
