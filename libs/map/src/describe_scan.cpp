// SPDX-License-Identifier: BSD-3-Clause
#include "map_state.h"

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

std::shared_ptr<TerrainSnapshot> describe_scan(const io::Scan& scan,
                                               const Eigen::Isometry3d& T_map_robot,
                                               const MapParams& params, MapWriter& writer) {
  auto snapshot = std::make_shared<TerrainSnapshot>();
  snapshot->stamp = scan.stamp;
  snapshot->T_map_robot = snapshot->T_map_window = T_map_robot;
  snapshot->robot = params.robot;
  snapshot->points = scan.points;
  snapshot->ray_origins = scan.ray_origins;
  snapshot->origin_of = scan.origin_of;
  const BeamOrigins origins{scan.ray_origins.empty() ? nullptr : scan.ray_origins.data(),
                            scan.origin_of.empty() ? nullptr : scan.origin_of.data()};
  describe({scan.points.view(), origins}, params.description, writer.workspace,
           snapshot->description);
  compute_cell_costs(snapshot->description.grid, params.robot, writer.costs, snapshot->costs);
  return snapshot;
}

}  // namespace mrpt_terrain
