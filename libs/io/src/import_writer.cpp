// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/io/import_writer.h"

#include <mrpt/core/Clock.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "cloud_map.h"
#include "mrpt_terrain/files/whole_file.h"
#include "mrpt_terrain/io/label_file.h"
#include "mrpt_terrain/io/rawlog_writer.h"
#include "mrpt_terrain/io/trajectory.h"

namespace mrpt_terrain::io {
namespace {

namespace fs = std::filesystem;

std::string without_extension(const std::string& file) {
  return fs::path(file).replace_extension().string();
}

/// Listed first, since a folder must not change while it is walked through.
std::vector<fs::path> label_files(const std::string& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".label") files.push_back(entry.path());
  }
  return files;
}

/// Folder of label files that gets its name when it is complete.
class LabelsFolder {
 public:
  explicit LabelsFolder(std::string folder)
      : folder_(std::move(folder)), part_(folder_ + ".part") {}
  ~LabelsFolder() {
    std::error_code ignored;
    if (used_) fs::remove_all(part_, ignored);
  }

  void write(std::size_t scan, const std::vector<std::uint32_t>& labels) {
    if (!used_) start();
    char name[32];
    std::snprintf(name, sizeof(name), "%06zu.label", scan);
    write_labels((fs::path(part_) / name).string(), labels);
  }

  /// Replaces the label files of an earlier import; other files in the folder stay.
  void commit() {
    if (!used_) return;
    fs::create_directories(folder_);
    for (const fs::path& old : label_files(folder_)) fs::remove(old);
    for (const fs::path& file : label_files(part_)) {
      fs::rename(file, fs::path(folder_) / file.filename());
    }
    fs::remove(part_);
  }

  [[nodiscard]] bool used() const { return used_; }
  [[nodiscard]] const std::string& folder() const { return folder_; }

 private:
  void start() {
    std::error_code error;
    fs::remove_all(part_, error);
    fs::create_directories(part_, error);
    if (error) throw std::runtime_error(part_ + ": cannot be created: " + error.message());
    used_ = true;
  }
  std::string folder_, part_;
  bool used_ = false;
};

}  // namespace

struct ImportWriter::Impl {
  Impl(const std::string& file, const ImportOptions& import_options)
      : options(import_options),
        rawlog(file),
        tum(without_extension(file) + ".tum"),
        labels(without_extension(file) + "_labels") {
    summary.rawlog = file;
  }

  void write_pose(double stamp, const mrpt::poses::CPose3D& T_map_robot) {
    mrpt::obs::CObservationRobotPose pose;
    pose.timestamp = mrpt::Clock::fromDouble(stamp);
    pose.sensorLabel = "pose";
    pose.pose.mean = T_map_robot;
    rawlog.write(pose);
    poses.add(stamp, T_map_robot);
    ++summary.poses;
  }

  void write_scan(const FileCloud& cloud, double stamp) {
    mrpt::obs::CObservationPointCloud scan;
    scan.timestamp = mrpt::Clock::fromDouble(stamp);
    scan.sensorLabel = options.sensor_label;
    scan.sensorPose = options.T_robot_sensor;
    scan.pointcloud = to_map(cloud);
    rawlog.write(scan);
    if (!cloud.labels.empty()) {
      labels.write(summary.scans, cloud.labels);
      ++summary.labelled_scans;
    }
    summary.points += cloud.points.size();
    ++summary.scans;
  }

  const ImportOptions options;
  RawlogWriter rawlog;
  files::WholeFile tum;
  LabelsFolder labels;
  Trajectory poses;
  ImportSummary summary;
};

ImportWriter::ImportWriter(const std::string& rawlog, const ImportOptions& options)
    : impl_(std::make_unique<Impl>(rawlog, options)) {}
ImportWriter::~ImportWriter() = default;

void ImportWriter::add(const FileCloud& cloud, double stamp,
                       const std::optional<mrpt::poses::CPose3D>& T_map_robot) {
  if (T_map_robot) impl_->write_pose(stamp, *T_map_robot);
  impl_->write_scan(cloud, stamp);
}

ImportSummary ImportWriter::commit() {
  ImportSummary& summary = impl_->summary;
  impl_->labels.commit();
  if (impl_->labels.used()) summary.labels_folder = impl_->labels.folder();
  if (!impl_->poses.empty()) {
    save_tum(impl_->poses, impl_->tum.part());
    impl_->tum.commit();
    summary.poses_file = impl_->tum.file();
  }
  // Last, so that a rawlog is there only with what belongs to it.
  impl_->rawlog.commit();
  return summary;
}

ImportSummary import_scans(std::size_t available, const ImportOptions& options,
                           const std::string& rawlog,
                           const std::function<void(std::size_t k, ImportWriter& writer)>& add) {
  const std::size_t total =
      options.max_scans == 0 ? available : std::min(available, options.max_scans);
  ImportWriter writer(rawlog, options);
  for (std::size_t k = 0; k < total; ++k) {
    if (options.progress && !options.progress(k, total)) {
      ImportSummary stopped;
      stopped.stopped = true;
      return stopped;
    }
    add(k, writer);
  }
  return writer.commit();
}

}  // namespace mrpt_terrain::io
