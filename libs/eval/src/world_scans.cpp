// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/eval/world_scans.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <variant>

#include "mrpt_terrain/sim/truth.h"
#include "mrpt_terrain/sim/vehicle.h"

namespace mrpt_terrain::eval {
namespace {

constexpr double kMicro = 1e-6;  // seconds, resolution of the stamps

TrueThing thing_of(const sim::WorldSolid& solid) {
  TrueThing thing;
  thing.id = solid.id;
  thing.type = solid.type;
  thing.terrain_class = solid.terrain_class;
  thing.slope = solid.slope;
  return thing;
}

std::vector<TrueThing> things_of(const sim::World& world, const sim::Scene& scene) {
  std::vector<TrueThing> things;
  for (const sim::WorldSolid& solid : world.solids) things.push_back(thing_of(solid));
  for (std::size_t k = 0; k < scene.solids.size(); ++k) {
    const sim::Shape& shape = scene.solids[k].shape;
    const auto* pothole = std::get_if<sim::Pothole>(&shape);
    if (pothole == nullptr && !std::holds_alternative<sim::Ditch>(shape)) continue;
    const sim::WorldSolid& solid = world.solids[k + 1];
    TrueThing& thing = things[k + 1];
    thing.depth = -solid.height;
    thing.footprint.centre = solid.T_map_solid.translation().head<2>();
    thing.footprint.yaw = scene.solids[k].placement.yaw;
    thing.footprint.length = solid.length;
    thing.footprint.width = solid.width;
    thing.footprint.ellipse = pothole != nullptr && pothole->form == sim::RimForm::kEllipse;
  }
  return things;
}

sim::MountedSensor sensor_of(const sim::SceneFile& file, const ScanOptions& options,
                             const std::string& source) {
  const std::string& name = options.sensor.empty() ? file.sensor : options.sensor;
  sim::MountedSensor sensor;
  sensor.model = sensors::resolve_sensor(name, options.sensor_folder, source + ": sensor");
  if (!sensor.model.has_timing()) {
    throw std::runtime_error(source + ": sensor = " + name +
                             ": cannot be simulated: its file gives no rate_hz or no columns");
  }
  sensor.T_robot_sensor = file.vehicle.T_robot_sensor();
  return sensor;
}

std::size_t whole_sweeps(const DrivenWorld& world) {
  std::size_t sweeps = 0;
  while (world.start_of(sweeps + 1) - kMicro <= world.motion.end()) ++sweeps;
  return std::max<std::size_t>(1, sweeps);
}

/// Pose of the frame in which the description gets the points, at the start of the sweep.
Eigen::Isometry3d frame_of(const Eigen::Isometry3d& T_map_robot, const ScanOptions& options) {
  if (!options.level) return T_map_robot;
  Eigen::Isometry3d level = Eigen::Isometry3d::Identity();
  level.translation() = T_map_robot.translation();
  const double yaw = std::atan2(T_map_robot(1, 0), T_map_robot(0, 0));
  level.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return level;
}

Eigen::Isometry3d disturbance(const ScanOptions& options) {
  Eigen::Isometry3d T_given_frame = Eigen::Isometry3d::Identity();
  T_given_frame.translation().z() = options.raise;
  T_given_frame.linear() =
      Eigen::AngleAxisd(options.pitch, Eigen::Vector3d::UnitY()).toRotationMatrix();
  return T_given_frame;
}

/// Whether the description gets the k-th return, and as what.
class Placer {
 public:
  Placer(const DrivenWorld& world, const sim::Sweep& sweep, const Eigen::Isometry3d& T_given_map,
         const ScanOptions& options)
      : sweep_(sweep), options_(options) {
    const std::size_t poses = options.skewed ? 1 : sweep.columns;
    for (std::size_t column = 0; column < poses; ++column) {
      // Robots stand still during a column, as they do in `simulate_sweep`.
      const double time = sweep.start_time + static_cast<double>(sweep.time[column * sweep.rings]);
      const Eigen::Isometry3d T_map_robot =
          world.motion.at(options.skewed ? sweep.start_time : time);
      T_given_sensor_.push_back(
          (T_given_map * T_map_robot * world.sensor.T_robot_sensor).cast<float>());
    }
  }

  void place(std::size_t k, TestScan& scan) const {
    const std::size_t column = options_.skewed ? 0 : sweep_.slot[k] / sweep_.rings;
    const Points& from = sweep_.points;
    const Eigen::Vector3f p =
        T_given_sensor_[column] * Eigen::Vector3f(from.x[k], from.y[k], from.z[k]);
    scan.points.push_back(p.x(), p.y(), p.z());
    scan.origin_of.push_back(static_cast<std::uint32_t>(column));
  }
  [[nodiscard]] bool is_in_range(std::size_t k) const {
    const auto range = static_cast<double>(sweep_.range[sweep_.slot[k]]);
    return range >= options_.min_range && range <= options_.max_range;
  }
  void store_origins(TestScan& scan) const {
    scan.ray_origins.clear();
    for (const Eigen::Isometry3f& T : T_given_sensor_) {
      scan.ray_origins.push_back({T.translation().x(), T.translation().y(), T.translation().z()});
    }
  }

 private:
  const sim::Sweep& sweep_;
  const ScanOptions& options_;
  std::vector<Eigen::Isometry3f> T_given_sensor_;
};

/// Number of a face among those of the scan.
std::int32_t face_number(std::int32_t thing, const Eigen::Vector3d& normal_in_map,
                         const Eigen::Isometry3d& T_frame_map, std::vector<TrueFace>& faces) {
  constexpr double kSame = 1e-6;
  const Eigen::Vector3d normal = T_frame_map.linear() * normal_in_map;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (faces[f].thing == thing && (faces[f].normal - normal).norm() < kSame) {
      return static_cast<std::int32_t>(f);
    }
  }
  faces.push_back({thing, normal, std::acos(std::clamp(normal_in_map.z(), -1.0, 1.0))});
  return static_cast<std::int32_t>(faces.size() - 1);
}

/// Finds the faces of returns from drivable surfaces of slopes.
void find_faces(const DrivenWorld& world, const sim::Sweep& sweep,
                const std::vector<std::size_t>& returns, const Eigen::Isometry3d& T_frame_map,
                ScanTruth& truth) {
  std::vector<double> x, y;
  std::vector<std::size_t> on_slope;
  for (std::size_t i = 0; i < returns.size(); ++i) {
    const bool wanted = world.things[static_cast<std::size_t>(truth.thing[i])].terrain_class ==
                            TerrainClass::kSlope &&
                        sweep.kind[sweep.slot[returns[i]]] == sim::SurfaceKind::kDrivable;
    if (!wanted) continue;
    on_slope.push_back(i);
    x.push_back(static_cast<double>(sweep.true_points.x[returns[i]]));
    y.push_back(static_cast<double>(sweep.true_points.y[returns[i]]));
  }
  std::vector<std::optional<sim::TerrainPoint>> terrain;
  world.caster->terrain_under(x, y, terrain);
  for (std::size_t k = 0; k < on_slope.size(); ++k) {
    const std::int32_t thing = truth.thing[on_slope[k]];
    if (!terrain[k] || terrain[k]->solid != thing) continue;
    truth.face[on_slope[k]] = face_number(thing, terrain[k]->normal, T_frame_map, truth.faces);
  }
}

double depth_below_rim(const DrivenWorld& world, const sim::Sweep& sweep, std::size_t k) {
  const Points& at = sweep.true_points;
  const double rim =
      world.ground->height(static_cast<double>(at.x[k]), static_cast<double>(at.y[k]));
  return rim - static_cast<double>(at.z[k]);
}

void fill_truth(const DrivenWorld& world, const sim::Sweep& sweep,
                const std::vector<std::size_t>& returns, ScanTruth& truth) {
  const sim::PointTruth of_sweep = sim::truth_of(*world.caster, sweep);
  for (const std::size_t k : returns) {
    const std::uint32_t slot = sweep.slot[k];
    const std::int32_t thing = sweep.solid[slot];
    const Support support = of_sweep.support[k];
    const bool is_hole = world.things[static_cast<std::size_t>(thing)].depth > 0.0;
    truth.support.push_back(support);
    truth.height.push_back(of_sweep.height[k]);
    truth.thing.push_back(thing);
    truth.cover.push_back(
        support == Support::kGround && sweep.kind[slot] == sim::SurfaceKind::kObject ? 1 : 0);
    truth.ring.push_back(static_cast<std::int32_t>(slot % sweep.rings));
    truth.below_rim.push_back(is_hole ? static_cast<float>(depth_below_rim(world, sweep, k))
                                      : 0.0F);
  }
  truth.face.assign(returns.size(), kNoFace);
}

void leave_out_beyond(double radius, TestScan& scan) {
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const float reach = std::max(std::abs(scan.points.x[i]), std::abs(scan.points.y[i]));
    if (static_cast<double>(reach) > radius) scan.truth.support[i] = Support::kUnknown;
  }
}

}  // namespace

double DrivenWorld::start_of(std::size_t sweep) const {
  return std::round(static_cast<double>(sweep) * sweep_time() / kMicro) * kMicro;
}

std::unique_ptr<DrivenWorld> make_driven_world(const sim::Family& family, std::uint64_t seed,
                                               const ScanOptions& options) {
  const std::string source = family.name + " seed " + std::to_string(seed);
  auto result = std::make_unique<DrivenWorld>();
  result->family = family.name;
  result->seed = seed;
  result->file = sim::make_world(family, seed).file;
  if (options.sensor_z > 0.0) result->file.vehicle.sensor_z = options.sensor_z;
  if (options.speed > 0.0) result->file.path.speed = options.speed;
  result->sensor = sensor_of(result->file, options, source);
  result->world = sim::build_world(result->file.scene);
  result->caster = std::make_unique<sim::RayCaster>(result->world);
  result->ground = std::make_unique<sim::GroundSurface>(result->file.scene.ground, source);
  result->motion = sim::drive(*result->caster, result->file.vehicle, result->file.path, source);
  result->things = things_of(result->world, result->file.scene);
  result->sweeps = whole_sweeps(*result);
  return result;
}

std::vector<std::size_t> spread_sweeps(std::size_t sweeps, std::size_t count) {
  std::vector<std::size_t> result;
  const std::size_t n = std::min(sweeps, count);
  for (std::size_t k = 0; k < n; ++k) result.push_back((2 * k + 1) * sweeps / (2 * n));
  return result;
}

ScanView TestScan::view() const {
  return {points.view(),
          {ray_origins.empty() ? nullptr : ray_origins.data(),
           origin_of.empty() ? nullptr : origin_of.data()}};
}

void take_scan(const DrivenWorld& world, std::size_t sweep_number, const ScanOptions& options,
               ScanWorkspace& workspace, TestScan& scan) {
  const double start = world.start_of(sweep_number);
  const auto stream = static_cast<std::uint64_t>(std::llround(start / world.sweep_time()));
  sim::Sweep& sweep = workspace.sweep;
  sim::simulate_sweep(*world.caster, world.sensor, world.motion, start, options.noise_seed, stream,
                      workspace.sweep_workspace, sweep);
  const Eigen::Isometry3d T_map_frame = frame_of(world.motion.at(start), options);
  scan.truth.clear_points();
  scan.truth.things = world.things;
  scan.truth.ground_low = world.world.min_corner;
  scan.truth.ground_high = world.world.max_corner;
  scan.truth.T_map_given = T_map_frame * disturbance(options).inverse();
  scan.truth.range_sigma = world.sensor.model.noise.range_sigma;
  scan.truth.range_growth = world.sensor.model.noise.range_growth;
  const Placer placer(world, sweep, scan.truth.T_map_given.inverse(), options);
  scan.points.clear();
  scan.origin_of.clear();
  placer.store_origins(scan);
  std::vector<std::size_t> returns;
  for (std::size_t k = 0; k < sweep.slot.size(); ++k) {
    if (!placer.is_in_range(k)) continue;
    placer.place(k, scan);
    returns.push_back(k);
  }
  fill_truth(world, sweep, returns, scan.truth);
  find_faces(world, sweep, returns, T_map_frame.inverse(), scan.truth);
  if (options.radius > 0.0) leave_out_beyond(options.radius, scan);
}

}  // namespace mrpt_terrain::eval
