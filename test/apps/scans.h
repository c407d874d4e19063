// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/core/Clock.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "program.h"
#include "stored_objects.h"

/// \file
/// Rawlogs of a few scans, and what terrain-rawlog writes about them.
namespace mrpt_terrain::test {

using Cloud = mrpt::obs::CObservationPointCloud;
using PointList = std::vector<std::array<float, 3>>;

/// Level ground, a point every 4 cm, with a block of 0.5 m x 0.5 m on it whose middle is at
/// (1.25, 0.75).
inline PointList ground_with_block(float block_height) {
  PointList points;
  for (int i = -60; i <= 60; ++i) {
    for (int j = -60; j <= 60; ++j) {
      const float x = 0.04F * static_cast<float>(i), y = 0.04F * static_cast<float>(j);
      const bool on_block = x >= 1.0F && x <= 1.5F && y >= 0.5F && y <= 1.0F;
      points.push_back({x, y, on_block ? block_height : 0.0F});
    }
  }
  return points;
}

inline Cloud cloud_of(const PointList& points, double stamp = 1000.0) {
  Cloud cloud;
  cloud.sensorLabel = "lidar";
  cloud.timestamp = mrpt::Clock::fromDouble(stamp);
  cloud.pointcloud = mrpt::maps::CSimplePointsMap::Create();
  cloud.pointcloud->resize(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    cloud.pointcloud->setPointFast(k, points[k][0], points[k][1], points[k][2]);
  }
  return cloud;
}

/// The points of a KITTI scan.
inline std::string kitti_bytes(const PointList& points) {
  std::vector<float> values;
  for (const auto& point : points) {
    values.insert(values.end(), {point[0], point[1], point[2], 0.5F});
  }
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)};
}

/// The k-th scan of a drive: ten scans a second, the block a centimetre higher each time.
inline Cloud drive_scan(int k) {
  return cloud_of(ground_with_block(0.3F + 0.01F * static_cast<float>(k)), 1000.0 + 0.1 * k);
}

/// A rawlog, not compressed, so that tests know where its objects begin.
inline std::string drive_bytes(int scans) {
  std::string bytes;
  for (int k = 0; k < scans; ++k) bytes += stored(drive_scan(k));
  return bytes;
}

inline ProgramResult terrain_rawlog(const std::filesystem::path& folder,
                                    std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), TERRAIN_RAWLOG);
  return Program(folder, std::move(arguments)).wait();
}

/// `terrain-rawlog process INPUT -o FOLDER/out ...`
inline ProgramResult process(const std::filesystem::path& folder, const std::string& input,
                             const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = {"process", input, "-o", (folder / "out").string()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return terrain_rawlog(folder, std::move(arguments));
}

/// The same for bytes that make up a rawlog.
inline ProgramResult process_bytes(const std::filesystem::path& folder, const std::string& bytes,
                                   const std::vector<std::string>& more = {}) {
  return process(folder, write_file(folder / "drive.rawlog", bytes), more);
}

/// Lines of a CSV file whose fields hold no commas, as column name -> text.
inline std::vector<std::map<std::string, std::string>> read_csv(const std::filesystem::path& file) {
  const auto fields_of = [](const std::string& line) {
    std::vector<std::string> fields(1);
    for (const char c : line) {
      if (c == ',') {
        fields.emplace_back();
      } else {
        fields.back().push_back(c);
      }
    }
    return fields;
  };
  std::istringstream text(read_file(file));
  std::string line;
  std::getline(text, line);
  const std::vector<std::string> names = fields_of(line);
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(text, line)) {
    const std::vector<std::string> fields = fields_of(line);
    EXPECT_EQ(fields.size(), names.size()) << line;
    std::map<std::string, std::string>& row = rows.emplace_back();
    for (std::size_t k = 0; k < std::min(fields.size(), names.size()); ++k) {
      row[names[k]] = fields[k];
    }
  }
  return rows;
}

inline nlohmann::json summary_of(const std::filesystem::path& folder) {
  return nlohmann::json::parse(read_file(folder / "out" / "summary.json"), nullptr, false);
}

/// Checks that the tables in FOLDER/out are about the first `scans` scans of a drive.
inline void expect_tables_of(const std::filesystem::path& folder, std::size_t scans) {
  const auto rows = read_csv(folder / "out" / "scans.csv");
  ASSERT_EQ(rows.size(), scans);
  const auto clusters = read_csv(folder / "out" / "clusters.csv");
  ASSERT_EQ(clusters.size(), scans) << "one block per scan";
  for (std::size_t k = 0; k < scans; ++k) {
    EXPECT_EQ(rows[k].at("scan"), std::to_string(k));
    EXPECT_EQ(clusters[k].at("scan"), std::to_string(k));
    EXPECT_NEAR(std::stod(clusters[k].at("h_max")), 0.3 + 0.01 * static_cast<double>(k), 1e-6);
  }
  EXPECT_EQ(summary_of(folder)["scans_processed"], scans);
}

/// Names of the files of a folder that end in `ending`, sorted.
inline std::vector<std::string> files_ending_in(const std::filesystem::path& folder,
                                                const std::string& ending) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.size() >= ending.size() &&
        name.compare(name.size() - ending.size(), ending.size(), ending) == 0) {
      names.push_back(name);
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace mrpt_terrain::test
