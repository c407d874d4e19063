// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/io/trajectory.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string_view>

namespace mrpt_terrain::io {
namespace {

Eigen::Quaterniond attitude_of(const mrpt::poses::CPose3D& pose) {
  return Eigen::Quaterniond(Eigen::Matrix3d(pose.getRotationMatrix().asEigen()));
}

mrpt::poses::CPose3D make_pose(const Eigen::Vector3d& position, const Eigen::Quaterniond& q) {
  return mrpt::poses::CPose3D::FromQuaternionAndTranslation(
      mrpt::math::CQuaternionDouble(q.w(), q.x(), q.y(), q.z()),
      mrpt::math::TPoint3D(position.x(), position.y(), position.z()));
}

Eigen::Vector3d position_of(const mrpt::poses::CPose3D& pose) {
  return {pose.x(), pose.y(), pose.z()};
}

mrpt::poses::CPose3D interpolate(const mrpt::poses::CPose3D& a, const mrpt::poses::CPose3D& b,
                                 double share) {
  const Eigen::Vector3d position = (1.0 - share) * position_of(a) + share * position_of(b);
  return make_pose(position, attitude_of(a).slerp(share, attitude_of(b)));
}

/// Reads the lines of one TUM file and says where something is wrong.
class TumParser {
 public:
  explicit TumParser(std::string file) : file_(std::move(file)) {}

  /// Adds the pose of one line, if it holds one.
  void parse(std::string_view line, const mrpt::poses::CPose3D& T_sensor_robot,
             Trajectory& result) {
    ++line_;
    line = line.substr(0, line.find('#'));
    std::array<double, 8> values{};
    if (!read_values(line, values)) return;
    Eigen::Quaterniond q(values[7], values[4], values[5], values[6]);
    if (!(std::abs(q.norm() - 1.0) <= 1e-3)) {
      fail("the quaternion has norm " + std::to_string(q.norm()) + ", must be 1 within 0.001");
    }
    q.normalize();
    result.add(values[0], make_pose({values[1], values[2], values[3]}, q) + T_sensor_robot);
  }

 private:
  /// False for a line without content.
  bool read_values(std::string_view line, std::array<double, 8>& values) const {
    constexpr std::string_view kBlanks = " \t\r\v\f";
    std::size_t n = 0;
    for (auto at = line.find_first_not_of(kBlanks); at != std::string_view::npos; ++n) {
      const auto end = std::min(line.find_first_of(kBlanks, at), line.size());
      if (n < values.size()) values[n] = number(line.substr(at, end - at), n);
      at = line.find_first_not_of(kBlanks, end);
    }
    if (n != 0 && n != values.size()) {
      fail("expected 8 numbers (stamp tx ty tz qx qy qz qw), found " + std::to_string(n));
    }
    return n != 0;
  }

  [[nodiscard]] double number(std::string_view text, std::size_t column) const {
    constexpr std::array<const char*, 8> kColumns{"stamp", "tx", "ty", "tz",
                                                  "qx",    "qy", "qz", "qw"};
    double value = 0.0;
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
    if (parsed.ec != std::errc() || parsed.ptr != text.data() + text.size()) {
      fail(std::string(kColumns[column]) + " = '" + std::string(text) + "' is not a number");
    }
    if (!std::isfinite(value)) {
      fail(std::string(kColumns[column]) + " = '" + std::string(text) + "' is not finite");
    }
    return value;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(file_ + ":" + std::to_string(line_) + ": " + what);
  }

  std::string file_;
  std::size_t line_ = 0;
};

}  // namespace

void Trajectory::add(double stamp, const mrpt::poses::CPose3D& T_map_robot) {
  assert(std::isfinite(stamp));
  if (stamps_.empty() || stamp > stamps_.back()) {
    stamps_.push_back(stamp);
    poses_.push_back(T_map_robot);
    return;
  }
  const auto at = std::lower_bound(stamps_.begin(), stamps_.end(), stamp);
  const auto k = at - stamps_.begin();
  if (*at == stamp) {
    poses_[static_cast<std::size_t>(k)] = T_map_robot;
  } else {
    stamps_.insert(at, stamp);
    poses_.insert(poses_.begin() + k, T_map_robot);
  }
}

std::optional<mrpt::poses::CPose3D> Trajectory::at(double stamp) const {
  if (empty() || !(stamp >= stamps_.front() - tolerance && stamp <= stamps_.back() + tolerance)) {
    return std::nullopt;
  }
  const auto after = std::lower_bound(stamps_.begin(), stamps_.end(), stamp);
  if (after == stamps_.end()) return poses_.back();
  const auto k = static_cast<std::size_t>(after - stamps_.begin());
  if (k == 0 || *after == stamp) return poses_[k];
  const double gap = stamps_[k] - stamps_[k - 1];
  if (gap > max_gap) return std::nullopt;
  return interpolate(poses_[k - 1], poses_[k], (stamp - stamps_[k - 1]) / gap);
}

Trajectory load_tum(const std::string& file, const mrpt::poses::CPose3D& T_robot_sensor) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error(file + ": cannot be opened");
  const mrpt::poses::CPose3D T_sensor_robot = -T_robot_sensor;
  Trajectory trajectory;
  TumParser parser(file);
  for (std::string line; std::getline(stream, line);) {
    parser.parse(line, T_sensor_robot, trajectory);
  }
  if (stream.bad()) throw std::runtime_error(file + ": cannot be read");
  if (trajectory.empty()) throw std::runtime_error(file + ":1: holds no pose");
  return trajectory;
}

void save_tum(const Trajectory& trajectory, const std::string& file) {
  std::ofstream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error(file + ": cannot be opened for writing");
  stream << "# stamp tx ty tz qx qy qz qw\n";
  std::array<char, 512> line{};
  for (std::size_t k = 0; k < trajectory.size(); ++k) {
    const auto& pose = trajectory.pose(k);
    const Eigen::Quaterniond q = attitude_of(pose);
    std::snprintf(line.data(), line.size(), "%.9f %.9f %.9f %.9f %.9f %.9f %.9f %.9f\n",
                  trajectory.stamps()[k], pose.x(), pose.y(), pose.z(), q.x(), q.y(), q.z(), q.w());
    stream << line.data();
  }
  stream.close();
  if (!stream) throw std::runtime_error(file + ": cannot be written");
}

}  // namespace mrpt_terrain::io
