// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace mrpt_terrain::sim {

/// What a triangle is to a wheel.
enum class SurfaceKind : std::uint8_t {
  kDrivable,  ///< a wheel can rest on it: ground, ramps, curb tops, floors of potholes
  kFlank,     ///< part of the ground that no wheel rests on: steep walls of potholes and ditches
  kObject,    ///< stands on the ground: side of a ramp, box, wall, stone ...
};

/// Triangles in double precision, in the map frame, metres. Structure of arrays: one entry per
/// triangle in `triangles`, `solid` and `kind`.
struct Mesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from outside
  std::vector<std::int32_t> solid;                      ///< index into `World::solids`
  std::vector<SurfaceKind> kind;

  [[nodiscard]] std::size_t size() const { return triangles.size(); }
};

}  // namespace mrpt_terrain::sim
