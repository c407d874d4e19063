// SPDX-License-Identifier: BSD-3-Clause
// The fused grid on a real drive: 40 scans of a 64-beam sensor along 45 m of a street.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "mrpt_terrain/core/describe_fused.h"
#include "mrpt_terrain/core/fused_cell.h"
#include "test_files.h"

namespace mrpt_terrain {
namespace {

constexpr double kSensorHeight = 1.73;

struct RealScan {
  Points points;  ///< frame of the robot, z = 0 on the ground
  Eigen::Isometry3d T_map_robot = Eigen::Isometry3d::Identity();
  double time = 0.0;
};

std::vector<RealScan> read_drive() {
  const auto folder = test::data_folder() / "kitti_raw_0001";
  std::vector<RealScan> scans;
  std::ifstream poses(folder / "poses.tum");
  for (std::string line; std::getline(poses, line);) {
    if (line.empty() || line[0] == '#') continue;
    RealScan scan;
    Eigen::Vector3d t;
    Eigen::Quaterniond q;
    std::istringstream(line) >> scan.time >> t.x() >> t.y() >> t.z() >> q.x() >> q.y() >> q.z() >>
        q.w();
    scan.T_map_robot.linear() = q.normalized().toRotationMatrix();
    scan.T_map_robot.translation() = t;
    scan.T_map_robot.translate(Eigen::Vector3d(0.0, 0.0, -kSensorHeight));
    std::array<char, 16> name{};
    std::snprintf(name.data(), name.size(), "%06zu.bin", scans.size());
    std::ifstream file(folder / "velodyne" / name.data(), std::ios::binary);
    std::array<float, 4> xyzi{};
    while (file.read(reinterpret_cast<char*>(xyzi.data()), sizeof(xyzi))) {
      scan.points.push_back(xyzi[0], xyzi[1], xyzi[2] + static_cast<float>(kSensorHeight));
    }
    scans.push_back(std::move(scan));
  }
  return scans;
}

PosedScan posed(const RealScan& scan) { return {scan.points.view(), scan.T_map_robot, scan.time}; }

bool is_flat(const FusedCell& cell) { return cell.high - cell.low < 0.1 && cell.moments.n >= 3.0; }

/// Height differences between two maps in the cells that both know as flat.
std::vector<double> differences(const FusedSnapshot& a, const FusedSnapshot& b,
                                const FusionParams& params) {
  std::vector<double> found;
  a.tiles.for_each([&](TileIndex index, const Tile&) {
    for (std::size_t place = 0; place < kTileCells; ++place) {
      FusedCell in_a, in_b;
      const MapCell where = cell_of(index, place);
      if (!read_cell(a, where, params, in_a) || !read_cell(b, where, params, in_b)) continue;
      if (is_flat(in_a) && is_flat(in_b)) found.push_back(std::abs(in_a.height - in_b.height));
    }
  });
  return found;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Splits the drive in two maps by `goes_to_a`, and compares them.
template <class GoesToA>
std::vector<double> compare(const std::vector<RealScan>& drive, double range, GoesToA&& goes_to_a) {
  FusionParams params;
  params.extent = FusionExtent::kGrowing;
  params.max_range = range;
  FusedGrid a(params), b(params);
  FusionWorkspace workspace;
  for (std::size_t k = 0; k < drive.size(); ++k) {
    fuse_scan(posed(drive[k]), params, workspace, goes_to_a(k) ? a : b);
  }
  return differences(a.now(), b.now(), params);
}

TEST(FusedDrive, TheGroundRepeatsWithinTwoCentimetres) {
  const std::vector<RealScan> drive = read_drive();
  if (drive.size() != 40) {
    GTEST_SKIP() << "no kitti_raw_0001 in " << test::data_folder() << " (TERRAIN_DATA_DIR)";
  }
  const auto every_other = [](std::size_t k) { return k % 2 == 0; };
  const auto first_half = [](std::size_t k) { return k < 20; };
  const std::vector<double> interleaved = compare(drive, 70.0, every_other);
  const std::vector<double> halves_near = compare(drive, 10.0, first_half);
  const std::vector<double> halves_middle = compare(drive, 20.0, first_half);
  const std::vector<double> halves_far = compare(drive, 70.0, first_half);
  std::printf("every other scan, 70 m: %zu ground cells, median %.2f cm\n", interleaved.size(),
              100 * median(interleaved));
  std::printf("first and last 20 scans, 10 m: %zu ground cells, median %.2f cm\n",
              halves_near.size(), 100 * median(halves_near));
  std::printf("first and last 20 scans, 20 m: %zu ground cells, median %.2f cm\n",
              halves_middle.size(), 100 * median(halves_middle));
  std::printf("first and last 20 scans, 70 m: %zu ground cells, median %.2f cm\n",
              halves_far.size(), 100 * median(halves_far));
  EXPECT_GT(interleaved.size(), 20000U);
  EXPECT_LT(median(interleaved), 0.02);
  EXPECT_GT(halves_near.size(), 4000U);
  EXPECT_LT(median(halves_near), 0.02);
  // Far away, half a degree of tilt in the poses is what differs: 2.4 cm between single scans one
  // second apart, too. The bound only keeps it from growing.
  EXPECT_LT(median(halves_middle), 0.025);
  EXPECT_LT(median(halves_far), 0.05);
}

TEST(FusedDrive, AWindowKnowsMoreThanAScanAndIsDescribed) {
  const std::vector<RealScan> drive = read_drive();
  if (drive.size() != 40) {
    GTEST_SKIP() << "no kitti_raw_0001 in " << test::data_folder() << " (TERRAIN_DATA_DIR)";
  }
  FusionParams fusion;
  DescriptionParams params;
  params.grid.length = params.grid.width = 40.0;
  params.grid.cell_size = 0.2;
  params.ground.t_diff = 0.15;
  params.ground.t_high = 0.3;
  params.ground.t_low = -0.3;
  FusedGrid grid(fusion);
  FusionWorkspace workspace;
  for (const RealScan& scan : drive) fuse_scan(posed(scan), fusion, workspace, grid);
  FusedDescription fused;
  FusedDescriptionWorkspace fused_workspace;
  describe_fused(grid.now(), {posed(drive.back()), {}, 0}, {params, fusion}, fused_workspace,
                 fused);
  Description single;
  DescriptionWorkspace single_workspace;
  describe(drive.back().points.view(), params, single_workspace, single);
  const auto ground = [](const Description& d) {
    return std::count(d.ground.rule.begin(), d.ground.rule.end(), GroundRule::kGround);
  };
  EXPECT_GT(fused.description.grid.observed(), 2 * single.grid.observed());
  EXPECT_GT(ground(fused.description), 2 * ground(single));
  const double share = static_cast<double>(ground(fused.description)) /
                       static_cast<double>(fused.description.grid.observed());
  const double single_share =
      static_cast<double>(ground(single)) / static_cast<double>(single.grid.observed());
  EXPECT_GT(share, single_share - 0.05)
      << "noise of many scans does not turn ground into obstacles";
  EXPECT_GT(fused.description.things.size(), 10U);
  const FusedMemory memory = memory_of(grid);
  const double area = static_cast<double>(memory.cells) * fusion.cell_size * fusion.cell_size;
  const double bytes_per_m2 = static_cast<double>(memory.tiles) / area;
  std::printf("%zu cells, %zu bins, %.0f m2, %.0f bytes per m2\n", memory.cells, memory.bins, area,
              bytes_per_m2);
  EXPECT_LT(bytes_per_m2, 8000.0);
}

}  // namespace
}  // namespace mrpt_terrain
