// SPDX-License-Identifier: BSD-3-Clause
#include "plane_inliers.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>

#include "wide_registers.h"

namespace mrpt_terrain {
namespace {

constexpr std::size_t kBlock = 512;
// Sine of the smallest angle at which three points still span a plane.
constexpr float kLeastSine = 1e-4F;

MRPT_TERRAIN_WIDE_REGISTERS
std::int32_t count_range(const PointsView& cloud, std::size_t begin, std::size_t end,
                         const Plane& plane, float tolerance) {
  std::int32_t inliers = 0;
  for (std::size_t i = begin; i < end; ++i)
    inliers += is_inlier(cloud, i, plane, tolerance) ? 1 : 0;
  return inliers;
}

}  // namespace

std::optional<Plane> random_plane(const PointsView& cloud, RandomGenerator& random) {
  const auto n = static_cast<std::uint32_t>(cloud.size);
  const std::uint32_t i1 = random.below(n);
  std::uint32_t i2 = random.below(n - 1);
  if (i2 >= i1) ++i2;
  std::uint32_t i3 = random.below(n - 2);
  if (i3 >= std::min(i1, i2)) ++i3;
  if (i3 >= std::max(i1, i2)) ++i3;

  const Eigen::Vector3f p1(cloud.x[i1], cloud.y[i1], cloud.z[i1]);
  const Eigen::Vector3f u = Eigen::Vector3f(cloud.x[i2], cloud.y[i2], cloud.z[i2]) - p1;
  const Eigen::Vector3f v = Eigen::Vector3f(cloud.x[i3], cloud.y[i3], cloud.z[i3]) - p1;
  const Eigen::Vector3f normal = u.cross(v);
  const float length = normal.norm();
  if (!(length > kLeastSine * u.norm() * v.norm())) return std::nullopt;
  const Eigen::Vector3f unit = normal / length;
  return Plane{unit.x(), unit.y(), unit.z(), -unit.dot(p1)};
}

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
