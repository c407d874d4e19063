// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/sim/scene.h"

namespace mrpt_terrain::sim {

const char* type_of(const Shape& shape) {
  return std::visit([](const auto& s) { return s.kType; }, shape);
}

TerrainClass usual_class(const Shape& shape) {
  if (std::holds_alternative<Ramp>(shape)) return TerrainClass::kSlope;
  if (std::holds_alternative<Pothole>(shape) || std::holds_alternative<Ditch>(shape)) {
    return TerrainClass::kPothole;
  }
  if (std::holds_alternative<Grass>(shape)) return TerrainClass::kOther;
  return TerrainClass::kObstacle;
}

}  // namespace mrpt_terrain::sim
