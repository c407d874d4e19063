// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "mrpt_terrain/core/describe.h"
#include "mrpt_terrain/eval/plane_estimators.h"
#include "mrpt_terrain/sensors/sensor_model.h"
#include "mrpt_terrain/sim/ray_caster.h"
#include "mrpt_terrain/sim/sweep.h"
#include "mrpt_terrain/sim/world.h"

/// \file
/// The measurements of Meng, Cao et al. 2018 in simulated scenes: a robot that stands still scans
/// the same scene again and again, and each scan is described. doc/terrain-paper.md says how the
/// experiments were read.
namespace mrpt_terrain::eval {

/// Something in a scene that is described as one thing.
struct Target {
  std::string name;         ///< as in the paper: "A", "cluster 3"
  std::vector<int> solids;  ///< ids of its solids in the scene; the truth is that of the first
  double height = 0.0;      ///< truth, metres; negative: depth of a pothole
  double slope = 0.0;       ///< truth, radians
};

/// A scene ready to be scanned. The caster refers to the world.
struct PaperScene {
  std::string name;  ///< file without folder and extension
  std::unique_ptr<sim::World> world;
  std::unique_ptr<sim::RayCaster> caster;
  sim::MountedSensor sensor;
  std::vector<Target> targets;
};

/// Reads a scene file and looks up the truth of its targets. Throws sim::SceneError for bad scenes,
/// ids of solids that are not in the scene, std::runtime_error for sensors that are not known.
/// \param sensor_folder where the sensors are that scenes name
/// \param targets name and ids; truths are filled in
[[nodiscard]] PaperScene load_paper_scene(const std::string& file, const std::string& sensor_folder,
                                          std::vector<Target> targets);

/// Imperfections of sensor and robot. There are no others: no drop-outs, no quantisation.
struct TrialConditions {
  double range_sigma = 0.005;  ///< standard deviation of every range, metres
  double tilt_sigma = 0.0;     ///< of roll and pitch, which the robot takes for zero, radians
};

/// Angle of `slope.method = beam`.
struct BeamAngle {
  FeatureStatus status = FeatureStatus::kNotNeeded;
  double angle = 0.0;  ///< radians
  double sigma = 0.0;  ///< its own standard deviation of the angle, radians
};

/// What one scan said about one target.
struct Measurement {
  /// Clusters with returns of the target. The one with most of them is measured; with 0 of them
  /// nothing else means anything.
  int clusters = 0;
  ClusterDescription description;
  std::vector<PlaneEstimate> planes;  ///< one per estimator; kNotNeeded: not asked in this trial
  BeamAngle beam;                     ///< against the horizontal of the robot
  BeamAngle beam_to_ground;           ///< against the ground around, as the same scan shows it
};

/// Measurements of one scan, one per target of the scene.
using Trial = std::vector<Measurement>;

/// What is done in all trials of a run.
struct TrialPlan {
  DescriptionParams params;  ///< of the description; each trial has a slope seed of its own
  TrialConditions conditions;
  std::size_t trials = 50;
  std::uint64_t seed = 1;
  int threads = 1;
  double threshold = 0.01;  ///< inlier distance of the sampling estimators, metres
  bool with_beam = false;   ///< whether `slope.method = beam` measures too
  /// Estimators that see the first trials only, because they are slow: name and how many.
  std::map<std::string, std::size_t> limits;
};

/// Told every tenth of a second how many trials are done; returns whether to go on.
using TrialProgress = std::function<bool(std::size_t done)>;

/// Runs the trials. Trial k depends on scene, conditions, seed and k only: neither on the number of
/// threads nor on that of trials. All estimators see the same points.
/// \return one entry per trial; empty if `progress` stopped the run
[[nodiscard]] std::vector<Trial> run_trials(const PaperScene& scene,
                                            const PlaneEstimators& estimators,
                                            const TrialPlan& plan, const TrialProgress& progress);

/// Points of one scan for a picture; all arrays have one entry per point.
struct ScanPicture {
  static constexpr int kGround = -1;
  static constexpr int kOther = -2;
  Points points;  ///< robot frame, metres; those that the description looks at
  /// Index of the target that the point comes from, `kGround`, or `kOther` for other solids.
  std::vector<int> source;
  /// Index of the target whose measured cluster the point is in, `kGround`, or `kOther` for other
  /// clusters.
  std::vector<int> cluster;
};

/// The scan of trial 0.
[[nodiscard]] ScanPicture scan_picture(const PaperScene& scene, const TrialPlan& plan);

}  // namespace mrpt_terrain::eval
