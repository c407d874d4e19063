// SPDX-License-Identifier: BSD-3-Clause
#include "poses_file.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mrpt_terrain/view/text.h"
#include "observations.h"
#include "rounding.h"

namespace {

constexpr double kInterval = 0.01;  // seconds
constexpr double kMicro = 1e-6;     // seconds, resolution of the stamps

}  // namespace

PosesFile::PosesFile(const std::string& file)
    : file_(file), last_(-std::numeric_limits<double>::infinity()) {
  file_.stream() << "# stamp tx ty tz qx qy qz qw: true poses of the robot in the map\n";
}

void PosesFile::add(const mrpt_terrain::sim::Motion& motion, double begin, double end) {
  const auto steps = static_cast<int>(std::ceil((end - begin) / kInterval - kMicro));
  for (int k = 0; k <= steps; ++k) {
    const double time = std::min(begin + k * kInterval, end);
    if (time > last_ + kMicro) write(time, motion.at(time));
  }
}

void PosesFile::write(double time, const Eigen::Isometry3d& T_map_robot) {
  using mrpt_terrain::view::fixed;
  Eigen::Quaterniond q(T_map_robot.linear());
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  auto& stream = file_.stream();
  stream << fixed(kRunEpoch + time, 6);
  for (const double metres : T_map_robot.translation()) {
    stream << ' ' << fixed(rounded(metres, kPositionStep), 5);
  }
  for (const double part : q.coeffs()) stream << ' ' << fixed(rounded(part, kAngleStep), 7);
  stream << '\n';
  last_ = time;
}
