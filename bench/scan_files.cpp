// SPDX-License-Identifier: BSD-3-Clause
#include "scan_files.h"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>

namespace mrpt_terrain::bench {

std::string data_folder() {
  const char* given = std::getenv("TERRAIN_DATA_DIR");
  return given != nullptr ? given : MRPT_TERRAIN_SOURCE_DIR "/../shared/data";
}

std::optional<Points> kitti_scan(int number) {
  constexpr float kSensorHeight = 1.73F;
  std::array<char, 16> name{};
  std::snprintf(name.data(), name.size(), "%06d.bin", number);
  std::ifstream file(data_folder() + "/kitti_raw_0001/velodyne/" + name.data(), std::ios::binary);
  if (!file) return std::nullopt;
  Points points;
  std::array<float, 4> xyzi{};
  while (file.read(reinterpret_cast<char*>(xyzi.data()), sizeof(xyzi))) {
    points.push_back(xyzi[0], xyzi[1], xyzi[2] + kSensorHeight);
  }
  return points;
}

}  // namespace mrpt_terrain::bench
