// SPDX-License-Identifier: BSD-3-Clause
#include "plane_inliers.h"

#include <algorithm>

namespace mrpt_terrain {
namespace {

constexpr std::size_t kBlock = 512;

std::int32_t count_range(const PointsView& cloud, std::size_t begin, std::size_t end,
                         const Plane& plane, float tolerance) {
  std::int32_t inliers = 0;
  for (std::size_t i = begin; i < end; ++i)
    inliers += is_inlier(cloud, i, plane, tolerance) ? 1 : 0;
  return inliers;
}

}  // namespace

std::int32_t count_inliers(const PointsView& cloud, const Plane& plane, float tolerance,
                           std::int32_t to_beat) {
  std::int32_t inliers = 0;
  for (std::size_t begin = 0; begin < cloud.size; begin += kBlock) {
    const auto left = static_cast<std::int64_t>(cloud.size - begin);
    if (inliers + left <= to_beat) break;
    const std::size_t end = std::min(cloud.size, begin + kBlock);
    inliers += count_range(cloud, begin, end, plane, tolerance);
  }
  return inliers;
}

}  // namespace mrpt_terrain
