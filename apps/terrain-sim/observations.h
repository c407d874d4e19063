// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/obs/CObservation.h>
#include <mrpt/poses/CPose3D.h>

#include <Eigen/Geometry>
#include <string>

#include "mrpt_terrain/sim/sweep.h"
#include "odometry.h"

/// Start of every simulated run: 2020-01-01 00:00:00 UTC, seconds since the Unix epoch. The time of
/// day must not get into the files.
inline constexpr double kRunEpoch = 1577836800.0;

/// What a sweep is written as.
enum class SweepForm {
  kCloud,    ///< CObservationPointCloud: the returns, sensor frame at the time of their firings
  kPackets,  ///< CObservationVelodyneScan: raw packets
  kPlanar,   ///< CObservation2DRangeScan
};

/// Whether a sensor scans one plane, which is what CObservation2DRangeScan holds.
[[nodiscard]] bool is_planar(const mrpt_terrain::sensors::SensorModel& model);

/// The observation of one sweep, with the label and the sensor's pose on the robot. Numbers are
/// rounded so that the last bits of sines and cosines, which differ between processors, do not get
/// into the files: coordinates to 2^-13 m (0.12 mm), planar ranges to 0.1 mm.
[[nodiscard]] mrpt::obs::CObservation::Ptr make_observation(
    SweepForm form, const mrpt_terrain::sim::MountedSensor& sensor,
    const mrpt_terrain::sim::Sweep& sweep, const std::string& label);

/// CObservationOdometry at a time of the run.
[[nodiscard]] mrpt::obs::CObservation::Ptr make_odometry(double time, const PlanarPose& pose);

/// Moves the points of a sweep into the sensor frame at the start of the sweep, by the true motion.
void undo_motion(const mrpt_terrain::sim::MountedSensor& sensor,
                 const mrpt_terrain::sim::Motion& motion, mrpt_terrain::sim::Sweep& sweep);
