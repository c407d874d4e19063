// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/eval/scan_truth.h"

#include <cmath>

namespace mrpt_terrain::eval {

bool Footprint::contains(const Eigen::Vector2d& place, double grown) const {
  const Eigen::Vector2d own = Eigen::Rotation2Dd(-yaw) * (place - centre);
  const double u = own.x() / (0.5 * length + grown), v = own.y() / (0.5 * width + grown);
  return ellipse ? u * u + v * v <= 1.0 : std::abs(u) <= 1.0 && std::abs(v) <= 1.0;
}

void ScanTruth::clear_points() {
  support.clear();
  height.clear();
  thing.clear();
  cover.clear();
  ring.clear();
  below_rim.clear();
  face.clear();
  faces.clear();
}

}  // namespace mrpt_terrain::eval
