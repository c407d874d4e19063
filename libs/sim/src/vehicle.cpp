// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/sim/vehicle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "route.h"

namespace mrpt_terrain::sim {
namespace {

constexpr std::size_t kWheels = 4;
// Places under one wheel, so far apart that a step passes under it one place per route sample.
constexpr std::size_t kContacts = static_cast<std::size_t>(kContactLength / kRouteStep) + 1;

/// Front left, front right, rear left, rear right, in the level frame of the vehicle.
std::array<Eigen::Vector2d, kWheels> wheels_of(const VehicleParams& vehicle) {
  const double x = 0.5 * vehicle.wheelbase, y = 0.5 * vehicle.track;
  return {{{x, y}, {x, -y}, {-x, y}, {-x, -y}}};
}

/// Places under all wheels: per wheel `kContacts` in a row along the heading.
struct Contacts {
  std::vector<double> x, y;
};

void find_contacts(const RoutePoint& at, const VehicleParams& vehicle, Contacts& contacts) {
  const Eigen::Rotation2Dd turn(at.yaw);
  contacts.x.clear();
  contacts.y.clear();
  for (const Eigen::Vector2d& wheel : wheels_of(vehicle)) {
    for (std::size_t k = 0; k < kContacts; ++k) {
      const double ahead =
          kContactLength * (static_cast<double>(k) / static_cast<double>(kContacts - 1) - 0.5);
      const Eigen::Vector2d place = at.position + turn * (wheel + Eigen::Vector2d(ahead, 0.0));
      contacts.x.push_back(place.x());
      contacts.y.push_back(place.y());
    }
  }
}

[[noreturn]] void refuse_place(const World& world, double x, double y, const std::string& source) {
  std::ostringstream message;
  message << source << ": leaves the terrain at (" << x << ", " << y
          << "): every wheel must stand on the ground, which reaches from (" << world.min_corner.x()
          << ", " << world.min_corner.y() << ") to (" << world.max_corner.x() << ", "
          << world.max_corner.y() << ") m";
  throw SceneError(message.str());
}

/// The plane z = height + slope . (x, y) of least squares through the four wheels' feet.
Eigen::Isometry3d pose_on(const RoutePoint& at, const VehicleParams& vehicle,
                          const std::array<double, kWheels>& feet) {
  const double height = 0.25 * (feet[0] + feet[1] + feet[2] + feet[3]);
  const double slope_x = (feet[0] + feet[1] - feet[2] - feet[3]) / (2.0 * vehicle.wheelbase);
  const double slope_y = (feet[0] - feet[1] + feet[2] - feet[3]) / (2.0 * vehicle.track);
  Eigen::Matrix3d axes;
  axes.col(0) = Eigen::Vector3d(1.0, 0.0, slope_x).normalized();
  axes.col(2) = Eigen::Vector3d(-slope_x, -slope_y, 1.0).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(at.yaw, Eigen::Vector3d::UnitZ()) * axes;
  pose.translation() << at.position, height;
  return pose;
}

void check_path(const DrivePath& path, const std::string& source) {
  for (std::size_t k = 0; k < path.waypoints.size(); ++k) {
    if (path.waypoints[k].allFinite()) continue;
    std::ostringstream message;
    message << source << ": path: waypoints[" << k << "] = (" << path.waypoints[k].x() << ", "
            << path.waypoints[k].y() << "): must be finite numbers, metres";
    throw SceneError(message.str());
  }
  if (std::isfinite(path.speed) && path.speed > 0.0) return;
  std::ostringstream message;
  message << source << ": path: speed = " << path.speed << ": must be above 0 m/s";
  throw SceneError(message.str());
}

}  // namespace

Eigen::Isometry3d VehicleParams::T_robot_sensor() const {
  return Eigen::Translation3d(sensor_x, 0.0, sensor_z) *
         Eigen::AngleAxisd(sensor_pitch, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(sensor_roll, Eigen::Vector3d::UnitX());
}

Motion drive(const RayCaster& caster, const VehicleParams& vehicle, const DrivePath& path,
             const std::string& source) {
  check_path(path, source);
  std::vector<double> times;
  std::vector<Eigen::Isometry3d> poses;
  Contacts contacts;
  std::vector<std::optional<TerrainPoint>> terrain;
  for (const RoutePoint& at : route_of(path)) {
    find_contacts(at, vehicle, contacts);
    caster.terrain_under(contacts.x, contacts.y, terrain);
    std::array<double, kWheels> feet{};
    for (std::size_t k = 0; k < terrain.size(); ++k) {
      if (!terrain[k]) refuse_place(caster.world(), contacts.x[k], contacts.y[k], source);
      feet[k / kContacts] += terrain[k]->height / static_cast<double>(kContacts);
    }
    times.push_back(at.time);
    poses.push_back(pose_on(at, vehicle, feet));
  }
  return Motion(std::move(times), std::move(poses));
}

}  // namespace mrpt_terrain::sim
