// SPDX-License-Identifier: BSD-3-Clause
// terrain-eval labelled: describes scans with labels and compares with them.
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <filesystem>

#include "dump.h"
#include "eval_params.h"
#include "exit_code.h"
#include "mrpt_terrain/files/atomic_file.h"
#include "mrpt_terrain/io/observation_reader.h"
#include "options.h"
#include "report.h"
#include "stop_signal.h"

using namespace mrpt_terrain;

namespace {

constexpr double kDegree = M_PI / 180.0;

/// Turns the plane upright, so that x keeps its heading, and lifts it to z = 0.
Eigen::Isometry3d levelling(const GroundPlane& plane) {
  const Eigen::Vector3d& n = plane.normal;
  const double roll = std::atan2(n.y(), n.z());
  const double pitch = std::atan2(-n.x(), std::hypot(n.y(), n.z()));
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = (Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
                   .toRotationMatrix();
  T.translation().z() = -n.z() * plane.height;
  return T;
}

void transform(const Eigen::Isometry3d& T_to_from, Points& points) {
  const Eigen::Isometry3f T = T_to_from.cast<float>();
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Eigen::Vector3f p = T * Eigen::Vector3f(points.x[k], points.y[k], points.z[k]);
    points.x[k] = p.x();
    points.y[k] = p.y();
    points.z[k] = p.z();
  }
}

/// Scores scans one by one; keeps the memory of the last one.
class Scorer {
 public:
  Scorer(const LabelledOptions& options, const AppParams& params)
      : options_(options), params_(params) {}

  eval::SupportScore score(const eval::LabelledFiles& files) {
    eval::LabelledScan scan = eval::read_labelled_scan(files, options_.classes);
    leave_out_beyond_radius(scan);
    const Eigen::Isometry3d T_given_sensor = pose(scan.points);
    transform(T_given_sensor, scan.points);
    const Eigen::Vector3f at = T_given_sensor.translation().cast<float>();
    const std::array<float, 3> origin{at.x(), at.y(), at.z()};
    describe({scan.points.view(), {&origin, nullptr}}, params_.description, workspace_,
             description_);
    if (!options_.common.dump.empty()) dump_predictions(files, scan);
    eval::ScanTruth truth;
    truth.support = scan.support;
    eval::SupportScore result;
    eval::add_support(scan.points.view(), truth, description_.labels.support, result);
    return result;
  }

 private:
  void leave_out_beyond_radius(eval::LabelledScan& scan) const {
    const double radius = options_.common.radius;
    if (radius <= 0.0) return;
    for (std::size_t k = 0; k < scan.points.size(); ++k) {
      const float reach = std::max(std::abs(scan.points.x[k]), std::abs(scan.points.y[k]));
      if (static_cast<double>(reach) > radius) scan.support[k] = Support::kUnknown;
    }
  }

  [[nodiscard]] Eigen::Isometry3d pose(const Points& in_sensor) {
    Eigen::Isometry3d T_robot_sensor = Eigen::Isometry3d::Identity();
    T_robot_sensor.translation().z() = options_.sensor_height;
    if (options_.find_ground) {
      Points points = in_sensor;
      transform(T_robot_sensor, points);
      GroundPlaneWorkspace workspace;
      const GroundPlane plane = find_ground_plane(points.view(), params_.ground_plane, workspace);
      if (plane.found) T_robot_sensor = levelling(plane) * T_robot_sensor;
    }
    const Eigen::Translation3d raise(0.0, 0.0, options_.common.raise);
    const Eigen::AngleAxisd turn(options_.common.pitch_deg * kDegree, Eigen::Vector3d::UnitY());
    return raise * turn * T_robot_sensor;
  }

  // Predictions of all slots of the file, zero returns unknown.
  void dump_predictions(const eval::LabelledFiles& files, const eval::LabelledScan& scan) const {
    namespace fs = std::filesystem;
    const fs::path file(files.points);
    const std::vector<std::uint32_t> labels = eval::prediction_labels(description_.labels);
    DumpedScan dumped;
    dumped.name = file.stem().string();
    dumped.predictions.assign(scan.slots, 0);
    for (std::size_t k = 0; k < labels.size(); ++k) dumped.predictions[scan.slot[k]] = labels[k];
    const fs::path set = fs::canonical(file.parent_path().parent_path()).filename();
    dump((fs::path(options_.common.dump) / set).string(), dumped);
  }

  const LabelledOptions& options_;
  AppParams params_;
  DescriptionWorkspace workspace_;
  Description description_;
};

std::vector<eval::LabelledFiles> find_all(const std::vector<std::string>& folders) {
  std::vector<eval::LabelledFiles> all;
  for (const std::string& folder : folders) {
    const auto files = eval::find_labelled_scans(folder);
    all.insert(all.end(), files.begin(), files.end());
  }
  return all;
}

int score_all(const LabelledOptions& options, const AppParams& params, Messages& messages) {
  const std::vector<eval::LabelledFiles> files = find_all(options.folders);
  Scorer scorer(options, params);
  std::vector<NamedSupport> scores;
  NamedSupport pooled{"pooled", {}};
  for (const eval::LabelledFiles& file : files) {
    if (stop_requested()) {
      messages.warn("interrupted; nothing was written");
      return kExitInterrupted;
    }
    messages.bar().show(static_cast<double>(scores.size()) / static_cast<double>(files.size()),
                        file.points);
    scores.push_back({file.points, scorer.score(file)});
    pooled.score.add(scores.back().score);
  }
  scores.push_back(pooled);
  if (!options.common.csv.empty()) {
    files::write_atomically(options.common.csv, std::string_view(support_csv(scores)));
  }
  std::string text;
  const std::vector<NamedSupport> only_pooled{pooled};
  for (const TextTable& table :
       support_tables(options.common.details || files.size() == 1 ? scores : only_pooled)) {
    text += as_text(table) + "\n";
  }
  messages.info(text);
  return kExitOk;
}

}  // namespace

int run_labelled(const LabelledOptions& options) {
  Messages messages(options.common.verbosity);
  AppParams params;
  try {
    params = load_params(options.common);
  } catch (const std::exception& error) {
    messages.error(error.what());
    return kExitUsage;
  }
  try {
    return score_all(options, params, messages);
  } catch (const io::ReadError& error) {
    messages.error(error.what());
    return kExitInput;
  }
}
