// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "mrpt_terrain/io/scan.h"

namespace mrpt_terrain::io {
namespace {

using Matrix34 = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;
using Segment = DeskewScratch::Segment;
using Affine = std::array<float, 12>;  ///< 3x4, row by row

Matrix34 matrix_of(const mrpt::poses::CPose3D& pose) {
  Matrix34 matrix;
  matrix.leftCols<3>() = pose.getRotationMatrix().asEigen();
  matrix.col(3) << pose.x(), pose.y(), pose.z();
  return matrix;
}

Matrix34 compose(const Matrix34& T_a_b, const Matrix34& T_b_c) {
  Matrix34 T_a_c = T_a_b.leftCols<3>() * T_b_c;
  T_a_c.col(3) += T_a_b.col(3);
  return T_a_c;
}

void transform(const Affine& T, const Points& from, std::size_t k, Points& to) {
  const float x = from.x[k], y = from.y[k], z = from.z[k];
  to.x[k] = T[0] * x + T[1] * y + T[2] * z + T[3];
  to.y[k] = T[4] * x + T[5] * y + T[6] * z + T[7];
  to.z[k] = T[8] * x + T[9] * y + T[10] * z + T[11];
}

Affine to_float(const Matrix34& T) {
  Affine result{};
  Eigen::Map<Eigen::Matrix<float, 3, 4, Eigen::RowMajor>>(result.data()) = T.cast<float>();
  return result;
}

void transform_rigidly(const SensorPoints& sensor, Scan& scan) {
  const Affine T_robot_sensor = to_float(matrix_of(sensor.T_robot_sensor));
  for (std::size_t k = 0; k < sensor.points.size(); ++k) {
    transform(T_robot_sensor, sensor.points, k, scan.points);
  }
  scan.origin_of.clear();
  scan.ray_origins.assign(1, {T_robot_sensor[3], T_robot_sensor[7], T_robot_sensor[11]});
}

void store(const Matrix34& matrix, std::array<double, 12>& to) {
  Eigen::Map<Matrix34>(to.data()) = matrix;
}

/// The path between two poses, as the pose of the sensor in the robot's frame at the stamp.
///
/// With position linear and attitude turning by `angle` about one axis (which is what slerp does),
/// Rodrigues' formula makes every entry of the pose a combination of four constants:
/// T(u) = constant + u linear + sin(u angle) sine + (1 - cos(u angle)) versine, u in [0, 1].
Segment make_segment(const Matrix34& T_ref_a, const Matrix34& T_ref_b,
                     const Matrix34& T_robot_sensor) {
  const Eigen::Matrix3d R_a = T_ref_a.leftCols<3>();
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(R_a.transpose() * T_ref_b.leftCols<3>()));
  Eigen::Matrix3d K;
  const Eigen::Vector3d& w = turn.axis();
  K << 0.0, -w.z(), w.y(), w.z(), 0.0, -w.x(), -w.y(), w.x(), 0.0;

  Matrix34 linear = Matrix34::Zero();
  linear.col(3) = T_ref_b.col(3) - T_ref_a.col(3);
  Segment segment{};
  segment.angle = turn.angle();
  store(compose(T_ref_a, T_robot_sensor), segment.constant);
  store(linear, segment.linear);
  store(R_a * K * T_robot_sensor, segment.sine);
  store(R_a * K * K * T_robot_sensor, segment.versine);
  return segment;
}

Affine pose_at(const Segment& segment, double time) {
  const double length = segment.end - segment.begin;
  const double u = length > 0.0 ? std::clamp((time - segment.begin) / length, 0.0, 1.0) : 0.0;
  const double s = std::sin(u * segment.angle);
  const double v = 1.0 - std::cos(u * segment.angle);
  Affine result{};
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] = static_cast<float>(segment.constant[i] + u * segment.linear[i] +
                                   s * segment.sine[i] + v * segment.versine[i]);
  }
  return result;
}

struct TimeRange {
  float first = std::numeric_limits<float>::infinity();
  float last = -std::numeric_limits<float>::infinity();
};

TimeRange range_of(const std::vector<float>& times) {
  TimeRange range;
  for (const float t : times) {
    assert(std::isfinite(t));
    range.first = std::min(range.first, t);
    range.last = std::max(range.last, t);
  }
  return range;
}

/// The stretches of the path between `range.first` and `range.last`, or none if the trajectory does
/// not cover them all.
void find_segments(const SensorPoints& sensor, const Trajectory& path, const TimeRange& range,
                   const mrpt::poses::CPose3D& T_map_ref, std::vector<Segment>& segments) {
  segments.clear();
  const double begin = sensor.stamp + static_cast<double>(range.first);
  const double end = sensor.stamp + static_cast<double>(range.last);
  if (!path.at(begin) || !path.at(end)) return;
  const auto& stamps = path.stamps();
  const auto first_after = std::upper_bound(stamps.begin(), stamps.end(), begin);
  auto k = static_cast<std::size_t>(std::max<std::ptrdiff_t>(1, first_after - stamps.begin()));
  if (k == stamps.size()) --k;  // the sweep lies in the tolerance after the last pose
  const Matrix34 T_robot_sensor = matrix_of(sensor.T_robot_sensor);
  const auto relative = [&](std::size_t i) { return matrix_of(path.pose(i) - T_map_ref); };
  for (; k < stamps.size() && (segments.empty() || stamps[k - 1] < end); ++k) {
    const std::size_t before = k == 0 ? 0 : k - 1;
    const bool overlaps = stamps[before] < end && stamps[k] > begin;
    if (overlaps && stamps[k] - stamps[before] > path.max_gap) {
      segments.clear();
      return;
    }
    segments.push_back(make_segment(relative(before), relative(k), T_robot_sensor));
    segments.back().begin = stamps[before] - sensor.stamp;
    segments.back().end = stamps[k] - sensor.stamp;
  }
}

/// Finds or makes the firing of a time: firings that share their time share pose and ray origin.
/// Of times that fall into one bin only the latest is found again, so that a sweep whose times are
/// all different costs one pose per point and no search.
class Firings {
 public:
  Firings(const TimeRange& range, Scan& scan) : first_(range.first), scan_(scan) {
    const float length = range.last - range.first;
    bins_per_second_ = length > 0.0F ? (kBins - 1) / length : 0.0F;
    scan.scratch.bins.assign(kBins, {0.0F, kNone});
    scan.scratch.T_robot_sensor.clear();
    scan.ray_origins.clear();
  }

  std::uint32_t at(float time) {
    auto& bin = scan_.scratch.bins[static_cast<std::size_t>((time - first_) * bins_per_second_)];
    if (bin.firing == kNone || bin.time != time) bin = {time, add(time)};
    return bin.firing;
  }

 private:
  static constexpr std::size_t kBins = 8192;
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  std::uint32_t add(float time) {
    const auto& segments = scan_.scratch.segments;
    std::size_t k = 0;
    while (k + 1 < segments.size() && static_cast<double>(time) > segments[k].end) ++k;
    const Affine T = pose_at(segments[k], static_cast<double>(time));
    scan_.scratch.T_robot_sensor.push_back(T);
    scan_.ray_origins.push_back({T[3], T[7], T[11]});
    return static_cast<std::uint32_t>(scan_.ray_origins.size() - 1);
  }

  float first_;
  float bins_per_second_ = 0.0F;
  Scan& scan_;
};

/// False, and nothing done, if times or poses are missing.
bool deskew(const SensorPoints& sensor, const Trajectory& path, Scan& scan) {
  if (sensor.time.empty() || !scan.T_map_robot) return false;
  assert(sensor.time.size() == sensor.points.size());
  const TimeRange range = range_of(sensor.time);
  find_segments(sensor, path, range, *scan.T_map_robot, scan.scratch.segments);
  if (scan.scratch.segments.empty()) return false;
  Firings firings(range, scan);
  scan.origin_of.resize(sensor.points.size());
  for (std::size_t k = 0; k < sensor.points.size(); ++k) {
    const std::uint32_t firing = firings.at(sensor.time[k]);
    scan.origin_of[k] = firing;
    transform(scan.scratch.T_robot_sensor[firing], sensor.points, k, scan.points);
  }
  return true;
}

}  // namespace

void to_robot_frame(const SensorPoints& sensor, const Trajectory* trajectory,
                    const InputParams& params, Scan& scan) {
  scan.points.resize(sensor.points.size());
  scan.source_index = sensor.source_index;
  scan.source_size = sensor.source_size;
  scan.stamp = sensor.stamp;
  scan.counts = sensor.counts;
  scan.T_map_robot = trajectory == nullptr ? std::nullopt : trajectory->at(sensor.stamp);
  scan.deskewed = params.deskew && trajectory != nullptr && deskew(sensor, *trajectory, scan);
  if (!scan.deskewed) transform_rigidly(sensor, scan);
}

}  // namespace mrpt_terrain::io
