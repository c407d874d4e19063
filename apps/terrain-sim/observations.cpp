// SPDX-License-Identifier: BSD-3-Clause
#include "observations.h"

#include <mrpt/core/Clock.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <cmath>

#include "mrpt_terrain/io/velodyne_packets.h"
#include "rounding.h"

using namespace mrpt_terrain;

namespace {

mrpt::poses::CPose3D to_mrpt(const Eigen::Isometry3d& pose) {
  const Eigen::Matrix3d& R = pose.linear();
  const auto& t = pose.translation();
  const double yaw = std::atan2(R(1, 0), R(0, 0));
  const double pitch = std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0)));
  const double roll = std::atan2(R(2, 1), R(2, 2));
  return {rounded(t.x(), kPositionStep), rounded(t.y(), kPositionStep),
          rounded(t.z(), kPositionStep), rounded(yaw, kAngleStep),
          rounded(pitch, kAngleStep),    rounded(roll, kAngleStep)};
}

mrpt::obs::CObservation::Ptr make_cloud(const sim::MountedSensor& sensor, const sim::Sweep& sweep) {
  const Points& points = sweep.points;
  auto map = mrpt::maps::CPointsMapXYZI::Create();
  map->resize(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const float intensity = static_cast<float>(sweep.intensity[sweep.slot[k]]) / 255.0F;
    map->setPointFast(k, rounded_coordinate(points.x[k]), rounded_coordinate(points.y[k]),
                      rounded_coordinate(points.z[k]));
    map->setPointColor_fast(k, intensity, intensity, intensity);
  }
  auto cloud = mrpt::obs::CObservationPointCloud::Create();
  cloud->sensorPose = to_mrpt(sensor.T_robot_sensor);
  cloud->pointcloud = map;
  return cloud;
}

mrpt::obs::CObservation::Ptr make_packets(const sim::MountedSensor& sensor,
                                          const sim::Sweep& sweep) {
  const io::VelodyneTurn turn{sweep.range, sweep.intensity, kRunEpoch + sweep.start_time};
  auto scan = std::make_shared<mrpt::obs::CObservationVelodyneScan>(
      io::encode_velodyne(sensor.model, turn));
  scan->sensorPose = to_mrpt(sensor.T_robot_sensor);
  return scan;
}

/// The scan plane's own x axis is the middle of its field of view.
mrpt::obs::CObservation::Ptr make_planar(const sim::MountedSensor& sensor,
                                         const sim::Sweep& sweep) {
  const double first = sensor.model.azimuth(0, 0);
  const double last = sensor.model.azimuth(sweep.columns - 1, 0);
  const Eigen::AngleAxisd turn(0.5 * (first + last), Eigen::Vector3d::UnitZ());
  auto scan = mrpt::obs::CObservation2DRangeScan::Create();
  scan->sensorPose = to_mrpt(sensor.T_robot_sensor * turn);
  scan->aperture = static_cast<float>(std::abs(last - first));
  scan->rightToLeft = last > first;
  scan->maxRange = static_cast<float>(sensor.model.max_range + 1.0);
  scan->stdError = static_cast<float>(sensor.model.noise.range_sigma);
  scan->beamAperture = static_cast<float>(sensor.model.noise.beam_divergence);
  scan->resizeScan(sweep.columns);
  scan->setScanHasIntensity(true);
  for (std::size_t k = 0; k < sweep.columns; ++k) {
    const double range = static_cast<double>(sweep.range[k]);
    scan->setScanRange(k, static_cast<float>(rounded(range, kPlanarRangeStep)));
    scan->setScanRangeValidity(k, range > 0.0);
    scan->setScanIntensity(k, sweep.intensity[k]);
  }
  return scan;
}

mrpt::Clock::time_point stamp_of(double time) { return mrpt::Clock::fromDouble(kRunEpoch + time); }

}  // namespace

bool is_planar(const sensors::SensorModel& model) {
  return model.elevation.size() == 1 && model.elevation.front() == 0.0;
}

mrpt::obs::CObservation::Ptr make_observation(SweepForm form, const sim::MountedSensor& sensor,
                                              const sim::Sweep& sweep, const std::string& label) {
  const auto observation = form == SweepForm::kPackets  ? make_packets(sensor, sweep)
                           : form == SweepForm::kPlanar ? make_planar(sensor, sweep)
                                                        : make_cloud(sensor, sweep);
  observation->timestamp = stamp_of(sweep.start_time);
  observation->sensorLabel = label;
  return observation;
}

mrpt::obs::CObservation::Ptr make_odometry(double time, const PlanarPose& pose) {
  auto odometry = mrpt::obs::CObservationOdometry::Create();
  odometry->timestamp = stamp_of(time);
  odometry->sensorLabel = "odometry";
  odometry->odometry = {rounded(pose.x, kPositionStep), rounded(pose.y, kPositionStep),
                        rounded(pose.yaw, kAngleStep)};
  return odometry;
}

void undo_motion(const sim::MountedSensor& sensor, const sim::Motion& motion, sim::Sweep& sweep) {
  const auto T_map_sensor = [&](double time) { return motion.at(time) * sensor.T_robot_sensor; };
  const Eigen::Isometry3d T_start_map = T_map_sensor(sweep.start_time).inverse();
  for (std::size_t k = 0; k < sweep.slot.size(); ++k) {
    // Robots stand still during a column, as they do in `simulate_sweep`.
    const std::size_t column = sweep.slot[k] / sweep.rings;
    const double time = sweep.start_time + static_cast<double>(sweep.time[column * sweep.rings]);
    const Eigen::Vector3d point(sweep.points.x[k], sweep.points.y[k], sweep.points.z[k]);
    const Eigen::Vector3d moved = T_start_map * (T_map_sensor(time) * point);
    sweep.points.x[k] = static_cast<float>(moved.x());
    sweep.points.y[k] = static_cast<float>(moved.y());
    sweep.points.z[k] = static_cast<float>(moved.z());
  }
}
