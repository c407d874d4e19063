// SPDX-License-Identifier: BSD-3-Clause
#include "support_rules.h"

#include "mrpt_terrain/sim/truth.h"

namespace mrpt_terrain::sim {

SupportRules::SupportRules(const World& world) {
  is_cover_.reserve(world.solids.size());
  for (const WorldSolid& solid : world.solids) {
    is_cover_.push_back(solid.type == Rubble::kType || solid.type == Grass::kType);
  }
}

Support SupportRules::support(std::int32_t solid, SurfaceKind kind, double height) const {
  if (kind == SurfaceKind::kDrivable) return Support::kGround;
  if (kind == SurfaceKind::kFlank) return Support::kUnknown;
  if (height > kLeastObstacle) return Support::kAbove;
  const bool covers_ground = is_cover_[static_cast<std::size_t>(solid)] && height <= kGroundCover;
  return covers_ground ? Support::kGround : Support::kUnknown;
}

}  // namespace mrpt_terrain::sim
