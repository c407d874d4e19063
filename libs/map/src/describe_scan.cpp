// SPDX-License-Identifier: BSD-3-Clause
#include <utility>

#include "map_state.h"
#include "mrpt_terrain/core/field_costs.h"
#include "mrpt_terrain/core/unseen_cells.h"

namespace mrpt_terrain {

Eigen::Isometry3d isometry_of(const mrpt::poses::CPose3D& pose) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  const auto& rotation = pose.getRotationMatrix();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) T.linear()(i, j) = rotation(i, j);
  }
  T.translation() = Eigen::Vector3d(pose.x(), pose.y(), pose.z());
  return T;
}

mrpt::poses::CPose3D pose_of(const Eigen::Isometry3d& T) {
  mrpt::math::CMatrixDouble44 matrix;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) matrix(i, j) = T.matrix()(i, j);
  }
  return mrpt::poses::CPose3D(matrix);
}

namespace {

BeamOrigins origins_of(const io::Scan& scan) {
  return {scan.ray_origins.empty() ? nullptr : scan.ray_origins.data(),
          scan.origin_of.empty() ? nullptr : scan.origin_of.data()};
}

void describe_fused_window(const io::Scan& scan, double time, FusionHalf& fusion,
                           const MapParams& params, TerrainSnapshot& snapshot) {
  const CurrentScan current{
      {scan.points.view(), snapshot.T_map_robot, time}, origins_of(scan), scan.ray_origins.size()};
  FusedDescription result;
  result.description = std::move(snapshot.description);
  result.cells = std::move(snapshot.window_cells);
  describe_fused(fusion.grid.now(), current, {params.description, fusion.params}, fusion.describing,
                 result);
  snapshot.description = std::move(result.description);
  snapshot.window_cells = std::move(result.cells);
  snapshot.T_map_window = Eigen::Translation3d(result.frame.x, result.frame.y, result.frame.z);
  snapshot.fused = fusion.grid.snapshot();
  snapshot.fusion = fusion.params;
}

// Costs from what is known of single points, too, which only the workspace holds.
void measure_costs(const io::Scan& scan, MapWriter& writer, TerrainSnapshot& snapshot) {
  const Description& description = snapshot.description;
  CellCosts& costs = snapshot.give_costs();
  const ScanView view{scan.points.view(), origins_of(scan)};
  auto workspace = writer.costs->take();
  compute_cell_costs(description, described_points(view.points, writer.workspace), snapshot.robot,
                     *workspace, costs);
  writer.costs->give_back(std::move(workspace));
  explain_unseen_cells(view, writer.workspace, description, writer.unseen, costs.unseen);
}

}  // namespace

std::shared_ptr<TerrainSnapshot> SnapshotPool::take() {
  std::unique_ptr<TerrainSnapshot> snapshot;
  {
    const std::lock_guard lock(mutex_);
    snapshot = std::move(spare_);
  }
  if (!snapshot) snapshot = std::make_unique<TerrainSnapshot>();
  const auto give_back = [pool = shared_from_this()](TerrainSnapshot* used) {
    pool->give_back(std::unique_ptr<TerrainSnapshot>(used));
  };
  return {snapshot.release(), give_back};
}

void SnapshotPool::give_back(std::unique_ptr<TerrainSnapshot> snapshot) {
  snapshot->fused = {};  // the writer waits for its tiles
  const std::lock_guard lock(mutex_);
  spare_.swap(snapshot);  // one that was there before ends here: the lock goes first
}

std::shared_ptr<TerrainSnapshot> describe_scan(const io::Scan& scan,
                                               const Eigen::Isometry3d& T_map_robot, double time,
                                               const MapParams& params, MapWriter& writer) {
  std::shared_ptr<TerrainSnapshot> snapshot = writer.snapshots->take();
  snapshot->stamp = scan.stamp;
  snapshot->T_map_robot = snapshot->T_map_window = T_map_robot;
  snapshot->robot = params.robot;
  snapshot->points = scan.points;
  snapshot->ray_origins = scan.ray_origins;
  snapshot->origin_of = scan.origin_of;
  if (writer.fusion) {
    describe_fused_window(scan, time, *writer.fusion, params, *snapshot);
  } else {
    describe({scan.points.view(), origins_of(scan)}, params.description, writer.workspace,
             snapshot->description);
  }
  // Fused cells are not those of the scan, and paper mode looks at no points: the description says
  // all that there is to costs, and who wants them can have them from there.
  const bool from_points =
      !writer.fusion && params.description.description.mode == DescriptionMode::kField;
  if (from_points) {
    measure_costs(scan, writer, *snapshot);
  } else {
    snapshot->expect_costs(writer.costs);
  }
  return snapshot;
}

void name_clusters(const TerrainSnapshot* before, double time, const MapParams& params,
                   MapWriter& writer, TerrainSnapshot& snapshot) {
  if (params.description.description.mode == DescriptionMode::kPaper) {
    snapshot.name_clusters(before, writer.next_identity);
    return;
  }
  snapshot.list_clusters();
  snapshot.set_identities(
      writer.tracker.update(snapshot.description.things, snapshot.T_map_window, time));
}

}  // namespace mrpt_terrain
