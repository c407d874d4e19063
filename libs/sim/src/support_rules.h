// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "mrpt_terrain/core/labels.h"
#include "mrpt_terrain/sim/world.h"

namespace mrpt_terrain::sim {

/// The rules of truth.h for one world.
class SupportRules {
 public:
  explicit SupportRules(const World& world);

  /// \param solid index into World::solids
  /// \param height above the drivable ground, metres; may be NaN
  [[nodiscard]] Support support(std::int32_t solid, SurfaceKind kind, double height) const;

 private:
  std::vector<bool> is_cover_;  ///< per solid: rubble or grass
};

}  // namespace mrpt_terrain::sim
