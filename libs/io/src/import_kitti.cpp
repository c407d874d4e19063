// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <map>
#include <optional>

#include "file_bytes.h"
#include "mrpt_terrain/io/import_writer.h"
#include "mrpt_terrain/io/kitti_scan.h"
#include "mrpt_terrain/io/label_file.h"
#include "mrpt_terrain/io/trajectory.h"

namespace mrpt_terrain::io {
namespace {

namespace fs = std::filesystem;
using mrpt::poses::CPose3D;

/// What a list beside the scans says of one scan.
struct Row {
  std::optional<double> stamp;
  std::optional<CPose3D> T_map_robot;
};

/// A list with one row per scan and where it came from.
struct RowList {
  std::string file;
  std::vector<Row> rows;
};

/// Calls `take(line number, words)` for the lines of a text file that are not blank.
template <class Take>
void for_each_line(const std::string& file, const Take& take) {
  const std::vector<std::uint8_t> bytes = read_bytes(file);
  TextCursor cursor({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  std::string_view line;
  while (cursor.next_line(line)) {
    if (line.find_first_not_of(" \t") != std::string_view::npos) take(cursor.line(), line);
  }
}

RowList read_times(const std::string& file) {
  RowList list{file, {}};
  for_each_line(file, [&](std::size_t number, std::string_view line) {
    double stamp = 0.0;
    if (!parse_number(take_word(line), stamp) || !take_word(line).empty()) {
      fail_at_line(file, number, "is not one number, the time of a scan in seconds");
    }
    list.rows.push_back({stamp, std::nullopt});
  });
  return list;
}

/// The 3x4 matrix (row by row) that the rest of a line holds, as a pose.
CPose3D parse_matrix(const std::string& file, std::size_t number, std::string_view line) {
  mrpt::math::CMatrixDouble44 matrix = mrpt::math::CMatrixDouble44::Identity();
  for (int k = 0; k < 12; ++k) {
    if (!parse_number(take_word(line), matrix(k / 4, k % 4))) {
      fail_at_line(file, number, "is not a 3x4 matrix of 12 numbers");
    }
  }
  if (!take_word(line).empty()) fail_at_line(file, number, "has more than 12 numbers");
  return CPose3D(matrix);
}

CPose3D read_T_camera_sensor(const std::string& file) {
  std::optional<CPose3D> T_camera_sensor;
  for_each_line(file, [&](std::size_t number, std::string_view line) {
    if (take_word(line) == "Tr:") T_camera_sensor = parse_matrix(file, number, line);
  });
  if (!T_camera_sensor) {
    throw ReadError(file + ": has no line 'Tr:', the pose of the sensor in the camera's frame");
  }
  return *T_camera_sensor;
}

/// Poses of the camera in the frame of its first pose, turned into poses of the sensor in the frame
/// that the sensor has there.
RowList read_camera_poses(const std::string& file, const std::string& calibration,
                          const CPose3D& T_robot_sensor) {
  const CPose3D T_camera_sensor = read_T_camera_sensor(calibration);
  RowList list{file, {}};
  for_each_line(file, [&](std::size_t number, std::string_view line) {
    const CPose3D T_start_camera = parse_matrix(file, number, line);
    const CPose3D T_map_sensor = (-T_camera_sensor) + T_start_camera + T_camera_sensor;
    list.rows.push_back({std::nullopt, T_map_sensor + (-T_robot_sensor)});
  });
  return list;
}

RowList read_tum_poses(const std::string& file, const CPose3D& T_robot_sensor) {
  const Trajectory trajectory = load_tum(file, T_robot_sensor);
  RowList list{file, {}};
  for (std::size_t k = 0; k < trajectory.size(); ++k) {
    list.rows.push_back({trajectory.stamps()[k], trajectory.pose(k)});
  }
  return list;
}

/// A KITTI folder, its lists read, its scans not.
class KittiFolder {
 public:
  KittiFolder(const std::string& folder, const CPose3D& T_robot_sensor)
      : folder_(folder), scans_(find_kitti_scans(folder)) {
    if (exists("poses.tum")) {
      poses_ = read_tum_poses(path("poses.tum"), T_robot_sensor);
    } else if (exists("poses.txt")) {
      poses_ = read_camera_poses(path("poses.txt"), path("calib.txt"), T_robot_sensor);
    }
    if (exists("times.txt")) times_ = read_times(path("times.txt"));
  }

  [[nodiscard]] std::size_t size() const { return scans_.size(); }

  [[nodiscard]] FileCloud cloud(std::size_t scan) const {
    FileCloud cloud = read_kitti_scan(scans_[scan]);
    if (exists("labels")) {
      const fs::path name = fs::path(scans_[scan]).stem().string() + ".label";
      cloud.labels =
          read_labels((fs::path(folder_) / "labels" / name).string(), cloud.points.size());
    }
    return cloud;
  }

  [[nodiscard]] std::optional<CPose3D> T_map_robot(std::size_t scan) const {
    return poses_ ? row(*poses_, scan).T_map_robot : std::nullopt;
  }

  [[nodiscard]] double stamp(std::size_t scan, double period) const {
    std::optional<double> stamp;
    if (poses_) stamp = row(*poses_, scan).stamp;
    if (times_) stamp = row(*times_, scan).stamp;
    return stamp.value_or(static_cast<double>(scan) * period);
  }

 private:
  [[nodiscard]] std::string path(const char* name) const {
    return (fs::path(folder_) / name).string();
  }
  [[nodiscard]] bool exists(const char* name) const { return fs::exists(fs::path(folder_) / name); }

  [[nodiscard]] const Row& row(const RowList& list, std::size_t scan) const {
    if (list.rows.size() == scans_.size()) return list.rows[scan];
    std::size_t number = 0;
    const std::string stem = fs::path(scans_[scan]).stem().string();
    if (!parse_number(stem, number) || number >= list.rows.size()) {
      throw ReadError(list.file + ": holds " + std::to_string(list.rows.size()) + " rows for " +
                      std::to_string(scans_.size()) + " scans, and none for " + scans_[scan]);
    }
    return list.rows[number];
  }

  std::string folder_;
  std::vector<std::string> scans_;
  std::optional<RowList> poses_, times_;
};

}  // namespace

ImportSummary import_kitti(const std::string& folder, const ImportOptions& options,
                           const std::string& rawlog) {
  const KittiFolder source(folder, options.T_robot_sensor);
  return import_scans(source.size(), options, rawlog, [&](std::size_t k, ImportWriter& writer) {
    writer.add(source.cloud(k), source.stamp(k, options.period), source.T_map_robot(k));
  });
}

}  // namespace mrpt_terrain::io
