// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/obs/CObservation.h>
#include <mrpt/poses/CPose3D.h>

#include <optional>

#include "mrpt_terrain/core/describe.h"
#include "mrpt_terrain/core/ground_plane.h"
#include "mrpt_terrain/core/thing_tracker.h"
#include "mrpt_terrain/io/scan.h"
#include "mrpt_terrain/io/trajectory.h"
#include "mrpt_terrain/sensors/sensor_model.h"
#include "mrpt_terrain/view/scan_record.h"

/// From an observation to a scan in the robot's frame; keeps the memory of the last one.
struct ScanPipeline {
  mrpt_terrain::io::InputParams input;
  mrpt_terrain::GroundPlaneParams ground_plane;
  mrpt_terrain::sensors::SensorModels models;
  std::optional<mrpt::poses::CPose3D> sensor_pose;    ///< replaces that of the observations
  std::optional<mrpt::poses::CPose3D> T_level_robot;  ///< found by `level_by_ground`
  mrpt_terrain::io::Trajectory trajectory;            ///< of the robot; may be empty

  mrpt_terrain::io::SensorPoints sensor_points;
  mrpt_terrain::io::Scan scan;
};

/// Describes scans one by one; keeps the memory of the last one.
struct ScanDescriber {
  mrpt_terrain::DescriptionParams params;
  mrpt_terrain::DescriptionWorkspace workspace;
  mrpt_terrain::Description description;
  mrpt_terrain::ThingTracker tracker;  ///< of field mode; needs poses
};

/// Fills `pipeline.sensor_points`; its sensor pose is the one that the user gave, if there is one.
mrpt_terrain::io::Conversion convert(const mrpt::obs::CObservation& observation,
                                     ScanPipeline& pipeline);

/// Looks for the ground in `pipeline.sensor_points`. If it is there, the sensor poses of this and
/// all further scans are corrected so that the ground is at z = 0 of the robot frame; the robot's
/// path stays as it is.
mrpt_terrain::GroundPlane level_by_ground(ScanPipeline& pipeline);

/// Puts `pipeline.sensor_points` into the robot's frame, de-skewed by the trajectory, as
/// `pipeline.scan`; fills stamp, left out returns and the time that it took.
void place_scan(ScanPipeline& pipeline, mrpt_terrain::view::ScanRecord& record);

/// Points and origins of beams of a scan, borrowed.
[[nodiscard]] mrpt_terrain::ScanView view_of(const mrpt_terrain::io::Scan& scan);

/// Places and describes `pipeline.sensor_points` and fills counts and times of `record` (all but
/// `io`).
void describe_scan(ScanPipeline& pipeline, ScanDescriber& describer,
                   mrpt_terrain::view::ScanRecord& record);

/// The counts as `scans.csv` and `summary.json` name them.
[[nodiscard]] mrpt_terrain::view::LeftOutReturns left_out(
    const mrpt_terrain::io::ReturnCounts& counts);
