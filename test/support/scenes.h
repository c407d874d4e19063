// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>

#include "mrpt_terrain/sim/scene.h"

/// \file
/// Scenes written in code, for tests of what is derived from them.
namespace mrpt_terrain::worlds {

/// A level plane of 40 m x 40 m about the origin with nothing on it.
[[nodiscard]] inline sim::Scene level_scene() {
  sim::Scene scene;
  scene.name = "level";
  scene.source = "level.yaml";
  return scene;
}

/// Puts a shape into a scene; its class is the usual one, ids count from 1.
/// \return index into World::solids
inline std::int32_t put(sim::Scene& scene, sim::Shape shape, double x, double y, double yaw = 0.0) {
  sim::Solid solid;
  solid.shape = std::move(shape);
  solid.placement.id = static_cast<int>(scene.solids.size()) + 1;
  solid.placement.x = x;
  solid.placement.y = y;
  solid.placement.yaw = yaw;
  solid.placement.terrain_class = sim::usual_class(solid.shape);
  scene.solids.push_back(std::move(solid));
  return static_cast<std::int32_t>(scene.solids.size());
}

}  // namespace mrpt_terrain::worlds
