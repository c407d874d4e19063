// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/param_info.h"

namespace mrpt_terrain {

/// What a point or a cell is to a wheel; independent of `TerrainClass`.
/// Paper mode: ground = C_G; above and below = C_N, told apart by the sign of the height.
enum class Support : std::uint8_t {
  kUnknown = 0,  ///< see `UnknownReason`
  kGround,       ///< a surface that a wheel can rest on
  kAbove,        ///< sticks out of the ground
  kBelow,        ///< lies under the ground
};
constexpr EnumNames<Support, 4> enum_names(Support) {
  return {{{Support::kUnknown, "unknown"},
           {Support::kGround, "ground"},
           {Support::kAbove, "above"},
           {Support::kBelow, "below"}}};
}

/// Why a point has no support label.
enum class UnknownReason : std::uint8_t {
  kNone = 0,    ///< the support is known
  kNotFinite,   ///< a coordinate is NaN or infinite
  kTooHigh,     ///< at or above `GridParams::max_height`
  kOutsideMap,  ///< beyond the edges of the grid
};
constexpr EnumNames<UnknownReason, 4> enum_names(UnknownReason) {
  return {{{UnknownReason::kNone, "none"},
           {UnknownReason::kNotFinite, "not_finite"},
           {UnknownReason::kTooHigh, "too_high"},
           {UnknownReason::kOutsideMap, "outside_map"}}};
}

/// What a cluster is (Table 1 of the paper). `kNone` marks points and cells outside all clusters.
/// The values are those of the high 16 bits of label files.
enum class TerrainClass : std::uint8_t {
  kNone = 0,
  kSlope = 1,
  kPothole = 2,
  kObstacle = 3,
  kOther = 4
};
constexpr EnumNames<TerrainClass, 5> enum_names(TerrainClass) {
  return {{{TerrainClass::kNone, "none"},
           {TerrainClass::kSlope, "slope"},
           {TerrainClass::kPothole, "pothole"},
           {TerrainClass::kObstacle, "obstacle"},
           {TerrainClass::kOther, "other"}}};
}

/// Cluster number of points and cells that belong to none.
inline constexpr std::int32_t kNoCluster = -1;

/// One label per observed cell.
struct CellLabels {
  std::vector<Support> support;             ///< per slot
  std::vector<TerrainClass> terrain_class;  ///< per slot: class of the cell's cluster
};

/// One label per input point, in the order of the input; all arrays have its length.
struct PointLabels {
  std::vector<Support> support;
  std::vector<UnknownReason> reason;
  std::vector<TerrainClass> terrain_class;
  std::vector<std::int32_t> cluster;  ///< number of the cluster, or kNoCluster
};

}  // namespace mrpt_terrain
