// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/maps/CPointsMapXYZI.h>

#include "mrpt_terrain/io/file_cloud.h"

namespace mrpt_terrain::io {

/// All slots of a cloud, in their order.
inline mrpt::maps::CPointsMapXYZI::Ptr to_map(const FileCloud& cloud) {
  auto map = mrpt::maps::CPointsMapXYZI::Create();
  const Points& points = cloud.points;
  map->resize(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const float intensity = cloud.intensity.empty() ? 0.0f : cloud.intensity[k];
    map->setPointFast(k, points.x[k], points.y[k], points.z[k]);
    map->setPointColor_fast(k, intensity, intensity, intensity);
  }
  return map;
}

}  // namespace mrpt_terrain::io
