// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/eval/labelled_scans.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "mrpt_terrain/files/atomic_file.h"
#include "mrpt_terrain/io/label_file.h"
#include "mrpt_terrain/io/observation_reader.h"
#include "mrpt_terrain/sim/truth_files.h"

namespace mrpt_terrain::eval {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPointBytes = 4 * sizeof(float);

// SemanticKITTI: road, parking, sidewalk, other ground, lane marking, terrain; unlabelled, outlier
// and vegetation do not count.
constexpr std::array<std::uint16_t, 6> kKittiGround{40, 44, 48, 49, 60, 72};
constexpr std::array<std::uint16_t, 3> kKittiIgnored{0, 1, 70};
// RELLIS-3D: dirt, grass, water, asphalt, concrete, puddle, mud, rubble; tree, pole, vehicle,
// object, building, log, person, fence, bush, barrier.
constexpr std::array<std::uint16_t, 8> kRellisGround{1, 3, 6, 10, 23, 31, 33, 34};
constexpr std::array<std::uint16_t, 10> kRellisObstacle{4, 5, 8, 9, 12, 15, 17, 18, 19, 27};

template <std::size_t N>
bool is_in(std::uint16_t id, const std::array<std::uint16_t, N>& ids) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

Support support_of_terrain(std::uint16_t id) {
  if (id == sim::kLabelGround) return Support::kGround;
  return id == sim::kLabelAbove || id == sim::kLabelBelow ? Support::kAbove : Support::kUnknown;
}

std::uint32_t label_of(Support support) {
  switch (support) {
    case Support::kGround:
      return sim::kLabelGround;
    case Support::kAbove:
      return sim::kLabelAbove;
    case Support::kBelow:
      return sim::kLabelBelow;
    case Support::kUnknown:
      break;
  }
  return sim::kLabelNotCounted;
}

std::string read_points(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw io::ReadError(file + ": cannot be opened");
  std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (bytes.size() % kPointBytes != 0) {
    throw io::ReadError(file + ": cut off: " + std::to_string(bytes.size()) +
                        " bytes are no whole number of points (x, y, z, intensity as float32)");
  }
  return bytes;
}

}  // namespace

Support support_of_label(LabelSet set, std::uint32_t label) {
  const std::uint16_t id = io::label_class(label);
  switch (set) {
    case LabelSet::kSemanticKitti:
      if (is_in(id, kKittiGround)) return Support::kGround;
      return is_in(id, kKittiIgnored) ? Support::kUnknown : Support::kAbove;
    case LabelSet::kRellis:
      if (is_in(id, kRellisGround)) return Support::kGround;
      return is_in(id, kRellisObstacle) ? Support::kAbove : Support::kUnknown;
    case LabelSet::kTerrain:
      break;
  }
  return support_of_terrain(id);
}

std::vector<LabelledFiles> find_labelled_scans(const std::string& folder) {
  std::error_code error;
  const fs::path scans = fs::path(folder) / "velodyne", labels = fs::path(folder) / "labels";
  std::vector<LabelledFiles> files;
  for (const auto& entry : fs::directory_iterator(scans, error)) {
    if (entry.path().extension() != ".bin") continue;
    const fs::path label = labels / entry.path().stem().concat(".label");
    if (!fs::exists(label)) throw io::ReadError(label.string() + ": is missing");
    files.push_back({entry.path().string(), label.string()});
  }
  if (files.empty()) throw io::ReadError(folder + ": has no velodyne/*.bin");
  std::sort(files.begin(), files.end(),
            [](const LabelledFiles& a, const LabelledFiles& b) { return a.points < b.points; });
  return files;
}

LabelledScan read_labelled_scan(const LabelledFiles& files, LabelSet set) {
  const std::string bytes = read_points(files.points);
  LabelledScan scan;
  scan.slots = bytes.size() / kPointBytes;
  const std::vector<std::uint32_t> labels = io::read_labels(files.labels, scan.slots);
  for (std::size_t k = 0; k < scan.slots; ++k) {
    std::array<float, 3> at{};
    std::memcpy(at.data(), bytes.data() + kPointBytes * k, sizeof at);
    if (at[0] == 0.0F && at[1] == 0.0F && at[2] == 0.0F) continue;
    scan.points.push_back(at[0], at[1], at[2]);
    scan.support.push_back(support_of_label(set, labels[k]));
    scan.slot.push_back(static_cast<std::uint32_t>(k));
  }
  return scan;
}

std::vector<std::uint32_t> prediction_labels(const PointLabels& labels) {
  std::vector<std::uint32_t> result;
  result.reserve(labels.support.size());
  for (std::size_t k = 0; k < labels.support.size(); ++k) {
    const auto terrain_class = static_cast<std::uint32_t>(labels.terrain_class[k]);
    result.push_back(terrain_class << 16U | label_of(labels.support[k]));
  }
  return result;
}

void write_kitti_points(const std::string& file, const Points& points) {
  std::string bytes(kPointBytes * points.size(), '\0');
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::array<float, 4> point{points.x[k], points.y[k], points.z[k], 0.0F};
    std::memcpy(bytes.data() + kPointBytes * k, point.data(), sizeof point);
  }
  files::write_atomically(file, bytes);
}

}  // namespace mrpt_terrain::eval
