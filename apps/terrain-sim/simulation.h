// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mrpt_terrain/sim/motion.h"
#include "mrpt_terrain/sim/ray_caster.h"
#include "mrpt_terrain/sim/scene_file.h"
#include "mrpt_terrain/sim/sweep.h"
#include "observations.h"
#include "options.h"
#include "sim_params.h"

/// A world, a sensor that is driven through it, and when it measures.
struct Simulation {
  mrpt_terrain::sim::SceneFile file;
  SimParams params;
  mrpt_terrain::sim::MountedSensor sensor;
  SweepForm form = SweepForm::kCloud;
  mrpt_terrain::sim::World world;
  std::unique_ptr<mrpt_terrain::sim::RayCaster> caster;  ///< of `world`
  mrpt_terrain::sim::Motion motion;
  std::vector<double> starts;  ///< of the sweeps, seconds of the run
  std::string shortfall;       ///< why there are fewer sweeps than asked for; empty: all there

  [[nodiscard]] double sweep_time() const { return 1.0 / sensor.model.rate; }
};

/// Reads and builds all that the command line names. The result stays where it is: the caster
/// refers to the world in it. Throws exceptions of scenes, sensors and parameters, and
/// std::invalid_argument for options that do not go together.
[[nodiscard]] std::unique_ptr<Simulation> make_simulation(const SimOptions& options);
