// SPDX-License-Identifier: BSD-3-Clause
#include "surroundings.h"

#include <Eigen/Geometry>
#include <cmath>

using namespace mrpt_terrain;

namespace {

constexpr double kPathInterval = 0.1;       // seconds
constexpr double kLeastSurroundings = 6.0;  // metres about the path
constexpr double kMargin = 1.0;             // metres about things

void add(const Eigen::Vector2d& place, double radius, Eigen::AlignedBox2d& box) {
  box.extend(place - Eigen::Vector2d::Constant(radius));
  box.extend(place + Eigen::Vector2d::Constant(radius));
}

double on_decimetres(double metres) { return std::round(metres * 10.0) / 10.0; }

}  // namespace

Surroundings surroundings_of(const Simulation& simulation) {
  const sim::World& world = simulation.world;
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& place : path_of(simulation.motion)) {
    add(place, kLeastSurroundings, box);
  }
  for (std::size_t k = 1; k < world.solids.size(); ++k) {
    const sim::WorldSolid& solid = world.solids[k];
    add(solid.T_map_solid.translation().head<2>(),
        kMargin + 0.5 * std::hypot(solid.length, solid.width), box);
  }
  const Eigen::Vector2d low = box.min().unaryExpr(&on_decimetres);
  const Eigen::Vector2d high = box.max().unaryExpr(&on_decimetres);
  return {low.cwiseMax(world.min_corner), high.cwiseMin(world.max_corner)};
}

std::vector<Eigen::Vector2d> path_of(const sim::Motion& motion) {
  std::vector<Eigen::Vector2d> path;
  for (double time = motion.start(); time < motion.end(); time += kPathInterval) {
    path.emplace_back(motion.at(time).translation().head<2>());
  }
  path.emplace_back(motion.at(motion.end()).translation().head<2>());
  return path;
}
