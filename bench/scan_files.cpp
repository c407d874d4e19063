// SPDX-License-Identifier: BSD-3-Clause
#include "scan_files.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <vector>

#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain::bench {
namespace {

constexpr float kSensorHeight = 1.73F;  // of KITTI's car

Points read_kitti(const std::string& file_name) {
  std::ifstream file(file_name, std::ios::binary);
  Points points;
  std::array<float, 4> xyzi{};
  while (file.read(reinterpret_cast<char*>(xyzi.data()), sizeof(xyzi))) {
    points.push_back(xyzi[0], xyzi[1], xyzi[2] + kSensorHeight);
  }
  return points;
}

struct Box {
  std::array<double, 3> low, high;
};

// A street between two rows of houses, with cars and poles along it.
std::vector<Box> street() {
  std::vector<Box> boxes = {{{-80, 12, 0}, {80, 20, 8}}, {{-80, -20, 0}, {80, -12, 8}}};
  RandomGenerator random(1);
  for (double x = -60; x < 60; x += 7) {
    const double shift = 2 * random.uniform();
    boxes.push_back({{x, 5 + shift, 0}, {x + 4.2, 6.8 + shift, 1.5}});
    boxes.push_back({{x + 3, -7 - shift, 0}, {x + 3.2, -6.8 - shift, 4}});
  }
  return boxes;
}

double range_to(const Box& box, const std::array<double, 3>& origin,
                const std::array<double, 3>& ray) {
  double enter = 0.0;
  double leave = 120.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double a = (box.low[k] - origin[k]) / ray[k];
    const double b = (box.high[k] - origin[k]) / ray[k];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave ? enter : 120.0;
}

Points made_up_street() {
  constexpr int kBeams = 64;
  constexpr int kAzimuths = 2080;
  const std::vector<Box> boxes = street();
  const std::array<double, 3> origin = {0, 0, double{kSensorHeight}};
  RandomGenerator random(2);
  Points points;
  for (int beam = 0; beam < kBeams; ++beam) {
    const double elevation = (2.0 - 26.8 * beam / (kBeams - 1)) * 0.017453292519943295;
    for (int k = 0; k < kAzimuths; ++k) {
      const double azimuth = 6.283185307179586 * (k + 0.5) / kAzimuths;
      const std::array<double, 3> ray = {std::cos(elevation) * std::cos(azimuth),
                                         std::cos(elevation) * std::sin(azimuth),
                                         std::sin(elevation)};
      double range = ray[2] < 0 ? -origin[2] / ray[2] : 120.0;
      for (const Box& box : boxes) range = std::min(range, range_to(box, origin, ray));
      if (range >= 120.0) continue;
      range += 0.02 * (random.uniform() + random.uniform() - 1.0);
      points.push_back(static_cast<float>(range * ray[0]), static_cast<float>(range * ray[1]),
                       static_cast<float>(origin[2] + range * ray[2]));
    }
  }
  return points;
}

}  // namespace

const BenchmarkScan& benchmark_scan() {
  static const BenchmarkScan scan = [] {
    const char* given = std::getenv("TERRAIN_DATA_DIR");
    const std::string folder = given != nullptr ? given : MRPT_TERRAIN_SOURCE_DIR "/../shared/data";
    BenchmarkScan real{read_kitti(folder + "/kitti_raw_0001/velodyne/000000.bin"),
                       "kitti_raw_0001 scan 0"};
    return real.points.size() > 0 ? real : BenchmarkScan{made_up_street(), "made-up street"};
  }();
  return scan;
}

}  // namespace mrpt_terrain::bench
