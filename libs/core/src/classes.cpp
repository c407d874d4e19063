// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/classes.h"

namespace mrpt_terrain {

TerrainClass class_from_height(const HeightIndex& height, const ClassParams& params) {
  // As floats, like eq. (1): a height that equals a threshold in the file is equal here too.
  const auto h_f = static_cast<float>(height.h_f);
  if (h_f <= static_cast<float>(params.t_neg)) return TerrainClass::kPothole;
  if (h_f < static_cast<float>(params.t_pos)) return TerrainClass::kOther;
  return TerrainClass::kNone;
}

TerrainClass classify(const HeightIndex& height, const Roughness& roughness, const Slope& slope,
                      const ClassParams& params) {
  const TerrainClass by_height = class_from_height(height, params);
  if (by_height != TerrainClass::kNone) return by_height;
  const bool flat = roughness.status == FeatureStatus::kOk && !roughness.rough;
  const bool drivable_angle = slope.status == FeatureStatus::kOk &&
                              slope.angle >= params.slope_min && slope.angle <= params.slope_max;
  return flat && drivable_angle ? TerrainClass::kSlope : TerrainClass::kObstacle;
}

}  // namespace mrpt_terrain
