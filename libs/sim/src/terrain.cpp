// SPDX-License-Identifier: BSD-3-Clause
#include "terrain.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace mrpt_terrain::sim {
namespace {

// How deep bodies reach below the lowest ground that was sampled under them, metres.
constexpr double kSink = 0.2;
constexpr double kSampleSpacing = 0.25;
constexpr int kMostSamples = 64;

std::optional<double> top_of(const Platform& platform, double x, double y) {
  const Eigen::Vector3d p = platform.T_platform_map * Eigen::Vector3d(x, y, 0.0);
  if (std::abs(p.y()) > platform.width / 2) return std::nullopt;
  for (std::size_t i = 0; i + 1 < platform.profile.size(); ++i) {
    const Eigen::Vector2d& a = platform.profile[i];
    const Eigen::Vector2d& b = platform.profile[i + 1];
    if (!(p.x() >= a.x() && p.x() <= b.x() && b.x() > a.x())) continue;
    const double share = (p.x() - a.x()) / (b.x() - a.x());
    return a.y() + share * (b.y() - a.y()) - p.z();
  }
  return std::nullopt;
}

int samples_along(double length) {
  return std::clamp(static_cast<int>(std::ceil(length / kSampleSpacing)), 1, kMostSamples);
}

}  // namespace

double Terrain::height(double x, double y) const {
  double height = ground_.height(x, y) - lowered_by(holes_, x, y);
  for (const Platform& platform : platforms_) {
    if (const std::optional<double> top = top_of(platform, x, y)) height = std::max(height, *top);
  }
  return height;
}

double Terrain::lowest(const Polygon& rectangle) const {
  const Eigen::Vector2d along = rectangle[1] - rectangle[0];
  const Eigen::Vector2d across = rectangle[3] - rectangle[0];
  const int n = samples_along(along.norm());
  const int m = samples_along(across.norm());
  double lowest = height(rectangle[0].x(), rectangle[0].y());
  for (int i = 0; i <= n; ++i) {
    for (int k = 0; k <= m; ++k) {
      const Eigen::Vector2d p = rectangle[0] + along * i / n + across * k / m;
      lowest = std::min(lowest, height(p.x(), p.y()));
    }
  }
  return lowest - kSink;
}

}  // namespace mrpt_terrain::sim
