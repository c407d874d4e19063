// SPDX-License-Identifier: BSD-3-Clause
#include "scan_pipeline.h"

#include <chrono>
#include <cmath>

namespace {

using namespace mrpt_terrain;
using mrpt::poses::CPose3D;
using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

class StageTimer : public StageListener {
 public:
  explicit StageTimer(view::ScanMilliseconds& milliseconds) : milliseconds_(milliseconds) {}
  void stage_done(Stage stage) override {
    milliseconds_.stage[static_cast<std::size_t>(stage)] = milliseconds_since(last_);
    last_ = Clock::now();
  }

 private:
  view::ScanMilliseconds& milliseconds_;
  Clock::time_point last_ = Clock::now();
};

// Turns the plane's normal upright by roll and pitch, so that x keeps its heading, and lifts the
// origin until z = 0 is on the ground below it.
CPose3D levelling(const GroundPlane& plane) {
  const Eigen::Vector3d& n = plane.normal;
  const double roll = std::atan2(n.y(), n.z());
  const double pitch = std::atan2(-n.x(), std::hypot(n.y(), n.z()));
  return {0, 0, -n.z() * plane.height, 0, pitch, roll};
}

}  // namespace

io::Conversion convert(const mrpt::obs::CObservation& observation, ScanPipeline& pipeline) {
  const io::Conversion result =
      io::convert_observation(observation, pipeline.input, pipeline.models, pipeline.sensor_points);
  CPose3D& T_robot_sensor = pipeline.sensor_points.T_robot_sensor;
  if (pipeline.sensor_pose) T_robot_sensor = *pipeline.sensor_pose;
  if (pipeline.T_level_robot) T_robot_sensor = *pipeline.T_level_robot + T_robot_sensor;
  return result;
}

GroundPlane level_by_ground(ScanPipeline& pipeline) {
  io::SensorPoints& sensor = pipeline.sensor_points;
  io::to_robot_frame(sensor, nullptr, pipeline.input, pipeline.scan);
  GroundPlaneWorkspace workspace;
  const GroundPlane plane =
      find_ground_plane(pipeline.scan.points.view(), pipeline.ground_plane, workspace);
  if (!plane.found) return plane;
  pipeline.T_level_robot = levelling(plane);
  sensor.T_robot_sensor = *pipeline.T_level_robot + sensor.T_robot_sensor;
  return plane;
}

view::LeftOutReturns left_out(const io::ReturnCounts& counts) {
  return {counts.no_return, counts.not_finite, counts.out_of_range};
}

void place_scan(ScanPipeline& pipeline, view::ScanRecord& record) {
  const Clock::time_point start = Clock::now();
  const io::Trajectory* trajectory = pipeline.trajectory.empty() ? nullptr : &pipeline.trajectory;
  io::to_robot_frame(pipeline.sensor_points, trajectory, pipeline.input, pipeline.scan);
  record.milliseconds.transform = milliseconds_since(start);
  record.stamp = pipeline.scan.stamp;
  record.left_out = left_out(pipeline.scan.counts);
}

// Gives things the numbers that they had in the scans before, if poses are known.
void name_things(const io::Scan& scan, ScanDescriber& describer) {
  if (describer.params.description.mode != DescriptionMode::kField || !scan.T_map_robot) return;
  std::vector<ClusterDescription>& things = describer.description.things;
  const Eigen::Isometry3d T_map_robot(
      scan.T_map_robot->getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen());
  const std::vector<std::uint64_t>& identities =
      describer.tracker.update(things, T_map_robot, scan.stamp);
  for (std::size_t k = 0; k < things.size(); ++k) things[k].identity = identities[k];
}

ScanView view_of(const io::Scan& scan) {
  const bool one_origin = scan.origin_of.empty();
  const BeamOrigins origins{scan.ray_origins.empty() ? nullptr : scan.ray_origins.data(),
                            one_origin ? nullptr : scan.origin_of.data()};
  return {scan.points.view(), origins};
}

void describe_scan(ScanPipeline& pipeline, ScanDescriber& describer, view::ScanRecord& record) {
  const Clock::time_point start = Clock::now();
  place_scan(pipeline, record);
  StageTimer timer(record.milliseconds);
  describe(view_of(pipeline.scan), describer.params, describer.workspace, describer.description,
           &timer);
  name_things(pipeline.scan, describer);
  record.milliseconds.total = milliseconds_since(start);
  record.counts = view::count(describer.description);
}
