// SPDX-License-Identifier: BSD-3-Clause
#include "dump.h"

#include <filesystem>
#include <iomanip>
#include <sstream>

#include "mrpt_terrain/eval/labelled_scans.h"
#include "mrpt_terrain/io/label_file.h"
#include "mrpt_terrain/sim/truth.h"
#include "mrpt_terrain/sim/truth_files.h"

using namespace mrpt_terrain;
namespace fs = std::filesystem;

namespace {

std::string place(const std::string& folder, const std::string& kind, const std::string& file) {
  const fs::path path = fs::path(folder) / kind;
  fs::create_directories(path);
  return (path / file).string();
}

std::string six_digits(std::size_t number) {
  std::ostringstream text;
  text << std::setw(6) << std::setfill('0') << number;
  return text.str();
}

/// Labels of the truth files: support, and the number of the solid.
std::vector<std::uint32_t> truth_labels(const eval::ScanTruth& truth) {
  sim::PointTruth points;
  points.support = truth.support;
  for (const std::int32_t thing : truth.thing) {
    points.solid.push_back(truth.things[static_cast<std::size_t>(thing)].id);
  }
  return sim::labels_of(points);
}

}  // namespace

void dump(const std::string& folder, const DumpedScan& scan) {
  if (scan.points != nullptr) {
    eval::write_kitti_points(place(folder, "velodyne", scan.name + ".bin"), *scan.points);
  }
  const std::string label = scan.name + ".label";
  if (!scan.truth.empty()) io::write_labels(place(folder, "labels", label), scan.truth);
  io::write_labels(place(folder, "predictions", label), scan.predictions);
}

void dump_scan(const std::string& folder, const eval::ScoredScan& scored) {
  const eval::DrivenWorld& world = scored.world;
  const fs::path own = fs::path(folder) / (world.family + "_" + std::to_string(world.seed));
  DumpedScan scan{six_digits(scored.sweep), &scored.scan.points, truth_labels(scored.scan.truth),
                  eval::prediction_labels(scored.description.labels)};
  dump(own.string(), scan);
  sim::write_object_truth(own.string(), sim::truth_of_objects(world.world));
}
