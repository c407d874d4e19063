// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/map/terrain_map.h"

#include <mrpt/serialization/CArchive.h>

#include <cmath>
#include <limits>
#include <utility>

#include "map_state.h"
#include "mrpt_terrain/params/data_files.h"
#include "mrpt_terrain/sensors/sensor_model.h"

namespace mrpt_terrain {
namespace {

// Between scans without time stamps, seconds.
constexpr double kPeriod = 0.1;

TerrainSnapshotPtr empty_snapshot(const MapParams& params) {
  auto snapshot = std::make_shared<TerrainSnapshot>();
  snapshot->stamp = std::numeric_limits<double>::quiet_NaN();
  snapshot->robot = params.robot;
  return snapshot;
}

std::unique_ptr<OctreeHalf> make_octree(const MapParams& params) {
  if (!params.creation.octree) return nullptr;
  return std::make_unique<OctreeHalf>(params.creation, params.octree);
}

std::unique_ptr<FusionHalf> make_fusion(const MapParams& params) {
  if (params.creation.fusion == Fusion::kScan) return nullptr;
  return std::make_unique<FusionHalf>(fusion_of(params));
}

/// Beam tables of range image sensors, read once per process. None where the project's data folder
/// is not found: then such observations are refused, and the others are not.
const sensors::SensorModels& sensor_models() {
  static const sensors::SensorModels models = [] {
    try {
      const auto folder = params::find_data_folder() / "params" / "sensors";
      return sensors::SensorModels::from_folder(folder.string());
    } catch (const std::exception&) {
      return sensors::SensorModels();
    }
  }();
  return models;
}

bool any_finite(const Points& points) {
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (std::isfinite(points.x[k]) && std::isfinite(points.y[k]) && std::isfinite(points.z[k])) {
      return true;
    }
  }
  return false;
}

}  // namespace

CTerrainMap::State::State(const MapParams& given)
    : params(given), octree(make_octree(given)), snapshot_(empty_snapshot(given)) {
  writer.fusion = make_fusion(given);
}

CTerrainMap::State::State(const State& other) : State(other.params) {
  const std::lock_guard lock(other.writing);
  writer.next_identity = other.writer.next_identity;
  writer.tracker = other.writer.tracker;
  writer.time = other.writer.time;
  if (other.octree) octree = std::make_unique<OctreeHalf>(*other.octree);
  snapshot_ = other.snapshot();
  if (writer.fusion) copy_tiles(snapshot_->fused, writer.fusion->grid);
}

TerrainSnapshotPtr CTerrainMap::State::snapshot() const {
  const std::lock_guard lock(swapping_);
  return snapshot_;
}

void CTerrainMap::State::publish(TerrainSnapshotPtr next) {
  const std::lock_guard lock(swapping_);
  snapshot_.swap(next);  // what it was may end here, without the lock
}

CTerrainMap::CTerrainMap() : CTerrainMap(MapParams{}) {}
CTerrainMap::CTerrainMap(const MapParams& params) : state_(std::make_unique<State>(params)) {}
CTerrainMap::CTerrainMap(const CTerrainMap& other)
    : mrpt::maps::CMetricMap(other), state_(std::make_unique<State>(*other.state_)) {}
CTerrainMap& CTerrainMap::operator=(const CTerrainMap& other) {
  if (this == &other) return *this;
  mrpt::maps::CMetricMap::operator=(other);
  state_ = std::make_unique<State>(*other.state_);
  return *this;
}
CTerrainMap::~CTerrainMap() = default;

const MapParams& CTerrainMap::params() const { return state_->params; }
void CTerrainMap::set_render_params(const MapRenderParams& render) {
  state_->params.render = render;
}

TerrainSnapshotPtr CTerrainMap::snapshot() const { return state_->snapshot(); }
CellView CTerrainMap::cell_at(double x, double y) const { return snapshot()->cell_at(x, y); }
Cost CTerrainMap::cost_at(double x, double y, double heading) const {
  return snapshot()->cost_at(x, y, heading);
}
std::vector<ClusterView> CTerrainMap::clusters_in(const MapBox& box) const {
  const TerrainSnapshotPtr now = snapshot();
  std::vector<ClusterView> found;
  for (const std::size_t k : now->clusters_in(box)) found.push_back(now->clusters[k]);
  return found;
}
std::shared_ptr<const octomap::OcTree> CTerrainMap::octree() const {
  return state_->octree ? state_->octree->copy() : nullptr;
}

FreeSpaceGrid CTerrainMap::free_space(const MapBox& box, double low, double high) const {
  FreeSpaceGrid grid;
  const TerrainSnapshotPtr now = snapshot();
  const double voxel = state_->params.creation.octree_resolution;
  const double cell = state_->params.description.grid.cell_size;
  const double voxels = cell / voxel;
  const bool whole = std::abs(voxels - std::round(voxels)) < 1e-6 && voxels > 0.5;
  grid.lattice = MapLattice(whole ? cell : voxel, voxel);
  grid.time = now->stamp;
  MapCell first, last;
  LayerSpan layers;
  const bool valid = grid.lattice.cell_at(box.min.x, box.min.y, first) &&
                     grid.lattice.cell_at(box.max.x, box.max.y, last) &&
                     grid.lattice.layer_at(low, layers.low) &&
                     grid.lattice.layer_at(high, layers.high);
  if (!valid || !state_->octree) return grid;
  ++layers.high;
  state_->octree->find_free_space_in(grid.lattice, {first, {last.i + 1, last.j + 1}}, layers,
                                     now->stamp, grid);
  return grid;
}

bool CTerrainMap::State::insert(const io::Scan& scan, const Eigen::Isometry3d& T_map_robot) {
  if (!any_finite(scan.points)) return false;
  const TerrainSnapshotPtr before = snapshot();
  writer.time = std::isfinite(scan.stamp) ? scan.stamp : writer.time + kPeriod;
  if (writer.fusion) {
    fuse(scan, T_map_robot, writer.time, *writer.fusion, octree.get());
  } else if (octree) {
    octree->insert(scan, T_map_robot);
  }
  const auto next = describe_scan(scan, T_map_robot, writer.time, params, writer);
  next->revision = before->revision + 1;
  name_clusters(before.get(), writer.time, params, writer, *next);
  publish(next);
  return true;
}

bool CTerrainMap::insert_scan(const io::Scan& scan, const mrpt::poses::CPose3D& T_map_robot) {
  const std::lock_guard lock(state_->writing);
  return state_->insert(scan, isometry_of(T_map_robot));
}

std::string CTerrainMap::last_refusal() const {
  const std::lock_guard lock(state_->writing);
  return state_->writer.refusal;
}

bool CTerrainMap::isEmpty() const { return snapshot()->revision == 0; }

std::string CTerrainMap::asString() const {
  const TerrainSnapshotPtr now = snapshot();
  return "Terrain map: " + std::to_string(now->revision) + " scans, " +
         std::to_string(now->description.grid.observed()) + " cells, " +
         std::to_string(now->clusters.size()) + " clusters";
}

float CTerrainMap::compute3DMatchingRatio(
    const mrpt::maps::CMetricMap* /*other*/, const mrpt::poses::CPose3D& /*other_pose*/,
    const mrpt::maps::TMatchingRatioParams& /*params*/) const {
  return 0.0F;
}

void CTerrainMap::getVisualizationInto(mrpt::opengl::CSetOfObjects& objects) const {
  if (!genericMapParams.enableSaveAs3DObject) return;
  draw(*this, state_->params.render, objects);
}

void CTerrainMap::saveMetricMapRepresentationToFile(const std::string& prefix) const {
  save_files(*this, prefix);
}

void CTerrainMap::internal_clear() {
  const std::lock_guard lock(state_->writing);
  if (state_->octree) state_->octree->clear();
  state_->writer.fusion = make_fusion(state_->params);
  state_->writer.tracker.forget();
  state_->publish(empty_snapshot(state_->params));
}

bool CTerrainMap::internal_insertObservation(
    const mrpt::obs::CObservation& observation,
    const std::optional<const mrpt::poses::CPose3D>& robot_pose) {
  const std::lock_guard lock(state_->writing);
  MapWriter& writer = state_->writer;
  const io::InputParams& input = state_->params.input;
  const io::Conversion conversion =
      io::convert_observation(observation, input, sensor_models(), writer.sensor_points);
  writer.refusal = conversion.reason;
  if (conversion.status != io::ConversionStatus::kOk) return false;
  // The host's pose is that of the observation's time; nobody tells how the robot moved about it.
  io::to_robot_frame(writer.sensor_points, nullptr, input, writer.scan);
  return state_->insert(writer.scan, isometry_of(robot_pose.value_or(mrpt::poses::CPose3D())));
}

double CTerrainMap::internal_computeObservationLikelihood(
    const mrpt::obs::CObservation& observation, const mrpt::poses::CPose3D& taken_from) const {
  try {
    const auto scan = state_->judged.of(observation, state_->params, sensor_models());
    if (!scan->usable) return 0.0;
    return log_likelihood(*state_->fields.of(snapshot()), scan->points.view(),
                          isometry_of(taken_from), state_->params.likelihood);
  } catch (const std::exception&) {
    return 0.0;  // hosts sum over many maps: one that has nothing to say must not stop them
  }
}

bool CTerrainMap::internal_canComputeObservationLikelihood(
    const mrpt::obs::CObservation& observation) const {
  try {
    return state_->judged.of(observation, state_->params, sensor_models())->usable;
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace mrpt_terrain
