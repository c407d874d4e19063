// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/sim/truth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "support_rules.h"

namespace mrpt_terrain::sim {
namespace {

constexpr double kNotObserved = std::numeric_limits<double>::quiet_NaN();

// A place and its neighbours in which the lower ground beside a step is looked for.
constexpr double kNeighbourDistance = 0.01;
constexpr std::array<std::array<double, 2>, 5> kNeighbourhood{{{0, 0},
                                                               {kNeighbourDistance, 0},
                                                               {-kNeighbourDistance, 0},
                                                               {0, kNeighbourDistance},
                                                               {0, -kNeighbourDistance}}};
// More than the steepest drivable slope rises within a neighbourhood.
constexpr double kStep = 0.05;

/// Height of the ground that counts for a thing at a place: there, or at its lower side if it is at
/// a step. NaN without ground.
double ground_of(const std::optional<TerrainPoint>* neighbours) {
  double lowest = kNotObserved, highest = kNotObserved, here = kNotObserved;
  for (std::size_t k = kNeighbourhood.size(); k-- > 0;) {
    if (!neighbours[k]) continue;
    here = neighbours[k]->height;
    lowest = std::fmin(lowest, here);
    highest = std::fmax(highest, here);
  }
  return highest - lowest > kStep ? lowest : here;
}

/// Heights of the returns from objects above the ground; 0 for the others.
std::vector<double> heights_of(const RayCaster& caster, const Sweep& sweep) {
  const std::size_t n = sweep.points.size();
  std::vector<double> height(n, 0.0), x, y;
  std::vector<std::size_t> raised;
  for (std::size_t k = 0; k < n; ++k) {
    if (sweep.kind[sweep.slot[k]] != SurfaceKind::kObject) continue;
    raised.push_back(k);
    for (const auto& offset : kNeighbourhood) {
      x.push_back(static_cast<double>(sweep.true_points.x[k]) + offset[0]);
      y.push_back(static_cast<double>(sweep.true_points.y[k]) + offset[1]);
    }
  }
  std::vector<std::optional<TerrainPoint>> terrain;
  caster.terrain_under(x, y, terrain);
  for (std::size_t r = 0; r < raised.size(); ++r) {
    const double z = static_cast<double>(sweep.true_points.z[raised[r]]);
    height[raised[r]] = z - ground_of(&terrain[r * kNeighbourhood.size()]);
  }
  return height;
}

}  // namespace

PointTruth truth_of(const RayCaster& caster, const Sweep& sweep) {
  const World& world = caster.world();
  const SupportRules rules(world);
  const std::vector<double> height = heights_of(caster, sweep);
  PointTruth truth;
  for (std::size_t k = 0; k < sweep.points.size(); ++k) {
    const std::uint32_t slot = sweep.slot[k];
    const WorldSolid& solid = world.solids[static_cast<std::size_t>(sweep.solid[slot])];
    truth.solid.push_back(solid.id);
    truth.support.push_back(rules.support(sweep.solid[slot], sweep.kind[slot], height[k]));
    truth.terrain_class.push_back(solid.terrain_class);
    truth.true_range.push_back(sweep.true_range[slot]);
    truth.height.push_back(static_cast<float>(height[k]));
  }
  return truth;
}

std::vector<ObjectTruth> truth_of_objects(const World& world) {
  const SupportRules rules(world);
  std::vector<bool> drivable(world.solids.size(), false);
  for (std::size_t t = 0; t < world.mesh.size(); ++t) {
    if (world.mesh.kind[t] == SurfaceKind::kDrivable) {
      drivable[static_cast<std::size_t>(world.mesh.solid[t])] = true;
    }
  }
  std::vector<ObjectTruth> result;
  for (std::size_t s = 1; s < world.solids.size(); ++s) {
    const WorldSolid& solid = world.solids[s];
    const SurfaceKind kind = drivable[s] ? SurfaceKind::kDrivable : SurfaceKind::kObject;
    result.push_back({solid.id, solid.type, solid.terrain_class,
                      rules.support(static_cast<std::int32_t>(s), kind, solid.height), solid.height,
                      solid.length, solid.width, solid.slope, solid.T_map_solid});
  }
  return result;
}

}  // namespace mrpt_terrain::sim
