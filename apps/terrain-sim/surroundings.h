// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "simulation.h"

/// Part of the scene, metres in the map.
struct Surroundings {
  Eigen::Vector2d low, high;
};

/// What is worth looking at: the path and all things with a margin, as far as there is ground, on
/// whole decimetres.
[[nodiscard]] Surroundings surroundings_of(const Simulation& simulation);

/// Places of the robot along its path, a few centimetres to decimetres apart; one if it stands.
[[nodiscard]] std::vector<Eigen::Vector2d> path_of(const mrpt_terrain::sim::Motion& motion);
