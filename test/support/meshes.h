// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
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

/// A drivable grid of `cells` x `cells` squares about the origin with heights height(x, y), shared
/// vertices, two triangles per square.
template <class Height>
void add_height_field(sim::World& world, int cells, double spacing, Height&& height) {
  sim::Mesh& mesh = world.mesh;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const double low = -0.5 * cells * spacing;
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      const double x = low + i * spacing, y = low + j * spacing;
      mesh.vertices.emplace_back(x, y, height(x, y));
    }
  }
  const auto row = static_cast<std::uint32_t>(cells + 1);
  for (std::uint32_t j = 0; j + 1 < row; ++j) {
    for (std::uint32_t i = 0; i + 1 < row; ++i) {
      const std::uint32_t a = first + j * row + i, b = a + 1, c = b + row, d = a + row;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
  mesh.solid.resize(mesh.size(), sim::kGroundSolid);
  mesh.kind.resize(mesh.size(), sim::SurfaceKind::kDrivable);
  world.min_corner.setConstant(low);
  world.max_corner.setConstant(-low);
}

/// Gentle hills and short bumps.
[[nodiscard]] inline double uneven_height(double x, double y) {
  return 0.6 * std::sin(0.25 * x) * std::cos(0.31 * y) + 0.05 * std::sin(1.7 * x + 0.4 * y) +
         0.02 * std::cos(3.1 * y - 0.8 * x);
}

}  // namespace mrpt_terrain::worlds
