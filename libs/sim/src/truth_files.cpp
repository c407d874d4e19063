// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/sim/truth_files.h"

#include <cmath>
#include <filesystem>
#include <iomanip>
#include <sstream>
#include <stdexcept>

#include "mrpt_terrain/files/atomic_file.h"
#include "npy_file.h"

namespace mrpt_terrain::sim {
namespace {

/// FOLDER/name; makes the folder that it lies in.
std::string place_of(const std::string& folder, const std::string& name) {
  const auto file = std::filesystem::path(folder) / name;
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  if (error) throw std::runtime_error(file.string() + ": cannot be written: " + error.message());
  return file.string();
}

/// "key": {"number": "name", ...} of JSON.
template <class Enum>
std::string names_in_json(const char* key) {
  std::string text = std::string("  \"") + key + "\": {";
  const char* separator = "";
  for (const auto& entry : enum_names(Enum{})) {
    text += separator + ("\"" + std::to_string(static_cast<int>(entry.value)) + "\": \"") +
            entry.name + '"';
    separator = ", ";
  }
  return text + "}";
}

std::uint16_t label_class_of(Support support) {
  switch (support) {
    case Support::kGround:
      return kLabelGround;
    case Support::kAbove:
      return kLabelAbove;
    case Support::kBelow:
      return kLabelBelow;
    case Support::kUnknown:
      break;
  }
  return kLabelNotCounted;
}

std::string file_of_scan(std::size_t scan, const char* extension) {
  std::ostringstream name;
  name << std::setw(6) << std::setfill('0') << scan << extension;
  return name.str();
}

double degrees(double radians) { return radians * 180.0 / M_PI; }

/// Roll, pitch and yaw of Rz(yaw) Ry(pitch) Rx(roll).
Eigen::Vector3d angles_of(const Eigen::Matrix3d& axes) {
  return {std::atan2(axes(2, 1), axes(2, 2)),
          std::atan2(-axes(2, 0), std::hypot(axes(2, 1), axes(2, 2))),
          std::atan2(axes(1, 0), axes(0, 0))};
}

}  // namespace

std::vector<std::uint32_t> labels_of(const PointTruth& truth) {
  std::vector<std::uint32_t> labels;
  labels.reserve(truth.solid.size());
  for (std::size_t k = 0; k < truth.solid.size(); ++k) {
    labels.push_back(static_cast<std::uint32_t>(truth.solid[k]) << 16U |
                     label_class_of(truth.support[k]));
  }
  return labels;
}

void write_truth_format(const std::string& folder) {
  std::ostringstream text;
  text << "{\n  \"format\": \"mrpt_terrain truth\",\n  \"version\": " << kTruthVersion << ",\n"
       << "  \"labels\": {\"" << kLabelNotCounted << "\": \"not counted\", \"" << kLabelGround
       << "\": \"ground\", \"" << kLabelAbove << "\": \"above\", \"" << kLabelBelow
       << "\": \"below\"},\n"
       << names_in_json<Support>("support") << ",\n"
       << names_in_json<TerrainClass>("class") << "\n}\n";
  files::write_atomically(place_of(folder, "format.json"), text.str());
}

void write_object_truth(const std::string& folder, const std::vector<ObjectTruth>& objects) {
  std::ostringstream text;
  text << "id,type,class,support,height,length,width,slope_deg,x,y,z,roll_deg,pitch_deg,yaw_deg\n"
       << std::fixed << std::setprecision(6);
  for (const ObjectTruth& object : objects) {
    const Eigen::Vector3d at = object.T_map_object.translation();
    const Eigen::Vector3d angles = angles_of(object.T_map_object.linear());
    text << object.id << ',' << object.type << ',' << name_of(object.terrain_class) << ','
         << name_of(object.support) << ',' << object.height << ',' << object.length << ','
         << object.width << ',' << degrees(object.slope) << ',' << at.x() << ',' << at.y() << ','
         << at.z() << ',' << degrees(angles.x()) << ',' << degrees(angles.y()) << ','
         << degrees(angles.z()) << '\n';
  }
  files::write_atomically(place_of(folder, "objects.csv"), text.str());
}

void write_cell_truth(const std::string& folder, const Eigen::Isometry3d& T_map_grid,
                      const CellTruth& truth) {
  const int rows = truth.geometry.cells_l(), columns = truth.geometry.cells_w();
  NpyRecords records({{"x", "<f4"},
                      {"y", "<f4"},
                      {"min", "<f4"},
                      {"mean", "<f4"},
                      {"max", "<f4"},
                      {"ground", "<f4"},
                      {"slope", "<f4"},
                      {"slope_direction", "<f4"},
                      {"support", "|u1"},
                      {"class", "|u1"}},
                     {static_cast<std::size_t>(rows), static_cast<std::size_t>(columns)});
  const double yaw = std::atan2(T_map_grid(1, 0), T_map_grid(0, 0));
  const Eigen::Rotation2Dd turn(yaw);
  const Eigen::Vector3d origin = T_map_grid.translation();
  const auto add = [&records](double value) { records.add(static_cast<float>(value)); };
  std::size_t k = 0;
  for (int l = 0; l < rows; ++l) {
    for (int w = 0; w < columns; ++w, ++k) {
      const Position2 own = truth.geometry.centre_of({l, w});
      const Eigen::Vector2d centre = origin.head<2>() + turn * Eigen::Vector2d(own.x, own.y);
      add(centre.x());
      add(centre.y());
      for (const auto* heights : {&truth.min, &truth.mean, &truth.max, &truth.ground_height}) {
        add(static_cast<double>((*heights)[k]) + origin.z());
      }
      records.add(truth.slope[k]);
      add(std::remainder(static_cast<double>(truth.slope_direction[k]) + yaw, 2.0 * M_PI));
      records.add(static_cast<std::uint8_t>(truth.support[k]));
      records.add(static_cast<std::uint8_t>(truth.terrain_class[k]));
    }
  }
  records.write(place_of(folder, "cells.npy"));
}

void write_point_truth(const std::string& folder, std::size_t scan, const PointTruth& truth) {
  std::string bytes;
  for (const std::uint32_t label : labels_of(truth)) append_little_endian(label, bytes);
  files::write_atomically(place_of(folder, "labels/" + file_of_scan(scan, ".label")), bytes);

  NpyRecords records(
      {{"solid", "<i4"}, {"range", "<f4"}, {"height", "<f4"}, {"support", "|u1"}, {"class", "|u1"}},
      {truth.solid.size()});
  for (std::size_t k = 0; k < truth.solid.size(); ++k) {
    records.add(truth.solid[k]);
    records.add(truth.true_range[k]);
    records.add(truth.height[k]);
    records.add(static_cast<std::uint8_t>(truth.support[k]));
    records.add(static_cast<std::uint8_t>(truth.terrain_class[k]));
  }
  records.write(place_of(folder, "points/" + file_of_scan(scan, ".npy")));
}

}  // namespace mrpt_terrain::sim
