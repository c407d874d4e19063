// SPDX-License-Identifier: BSD-3-Clause
// A long drive into one map: time, memory and OctoMap must not grow with the way. The long form,
// which scripts/soak.sh runs, drives farther and judges times, too.
#include <gtest/gtest.h>
#include <octomap/OcTree.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>
#include <vector>

#include "mrpt_terrain/core/random.h"
#include "mrpt_terrain/map/terrain_map.h"
#include "scenes.h"
#include "sim_drive.h"

namespace mrpt_terrain {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kMemoryIsReal = false;  // sanitizers keep what was freed
#else
constexpr bool kMemoryIsReal = true;
#endif

/// Metres of the long form; 0: the short one.
double long_way() {
  const char* text = std::getenv("TERRAIN_SOAK_METRES");
  return text == nullptr ? 0.0 : std::atof(text);
}

// --- The road -----------------------------------------------------------------------------------

constexpr double kPiece = 100.0;   ///< metres of road that are one world
constexpr double kMargin = 75.0;   ///< of that world before and behind
constexpr double kSpacing = 10.0;  ///< metres of road with things of their own
constexpr double kSight = 70.0;    ///< metres, of the sensor

/// Puts what stands along 10 m of road: the same things in every world that reaches there.
void put_things(int place, sim::Scene& scene) {
  RandomGenerator random(static_cast<std::uint64_t>(place + 1000000));
  const auto between = [&random](double low, double high) {
    return low + (high - low) * random.uniform();
  };
  const double x = place * kSpacing;
  for (const double side : {-1.0, 1.0}) {
    sim::Box box;
    box.length = between(0.3, 2.0);
    box.height = between(0.2, 1.8);
    worlds::put(scene, box, x + between(2.0, 3.0), side * between(4.0, 7.0), between(-1.0, 1.0));
    sim::Pole pole;
    pole.height = between(2.0, 5.0);
    worlds::put(scene, pole, x + 7.0, side * between(2.5, 8.0));
    sim::Wall wall;
    wall.length = between(3.0, 9.0);
    wall.height = between(0.5, 2.5);
    worlds::put(scene, wall, x + 5.0, side * between(10.0, 14.0), between(-0.1, 0.1));
  }
  sim::Pothole hole;
  hole.length = hole.width = between(0.3, 0.8);
  if (random.below(4) == 0) worlds::put(scene, hole, x + 5.0, between(-1.5, 1.5));
}

/// A robot on one piece of road.
worlds::SimDrive drive_on(int piece) {
  sim::Scene scene = worlds::level_scene();
  const double begin = piece * kPiece - kMargin, end = (piece + 1) * kPiece + kMargin;
  scene.ground.x = 0.5 * (begin + end);
  scene.ground.length = end - begin;
  scene.ground.width = 50.0;
  const int first = static_cast<int>(std::ceil(begin / kSpacing));
  const int last = static_cast<int>(std::floor(end / kSpacing)) - 1;
  for (int place = first; place < last; ++place) put_things(place, scene);
  worlds::SimDrive drive;
  drive.world = std::make_unique<sim::World>(sim::build_world(scene));
  drive.caster = std::make_unique<sim::RayCaster>(*drive.world);
  drive.sensor.model = sensors::resolve_sensor("hdl32e", MRPT_TERRAIN_SOURCE_DIR "/params/sensors");
  drive.sensor.model.max_range = kSight;
  drive.sensor.model.noise.sub_rays = 1;
  drive.sensor.T_robot_sensor.translation().z() = 1.2;
  return drive;
}

Eigen::Isometry3d pose_at(double way) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Eigen::Vector3d(way, std::sin(way / 20.0), 0.0);
  T.rotate(Eigen::AngleAxisd(std::atan(std::cos(way / 20.0) / 20.0), Eigen::Vector3d::UnitZ()));
  return T;
}

// --- What is measured ---------------------------------------------------------------------------

double resident_mib() {
  std::ifstream file("/proc/self/statm");
  double total = 0.0, resident = 0.0;
  file >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1048576.0;
}

double processor_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// What a run looked like, per scan; `nodes` and `area` at every `kLook`-th.
struct Record {
  std::vector<double> way, ms, mib;
  std::vector<double> nodes, area;

  /// Those values whose place in the run lies in [from, to) of it.
  [[nodiscard]] static std::vector<double> part(const std::vector<double>& values, double from,
                                                double to) {
    const auto at = [&values](double share) {
      return values.begin() +
             static_cast<std::ptrdiff_t>(std::lround(share * static_cast<double>(values.size())));
    };
    return {at(from), at(to)};
  }
};

constexpr std::size_t kLook = 5;

/// Square metres of the tiles of a map.
double area_of(const TerrainSnapshot& snapshot) {
  double tiles = 0.0;
  snapshot.fused.tiles.for_each([&tiles](TileIndex, const Tile&) { ++tiles; });
  const double cell = snapshot.fusion.cell_size;
  return tiles * static_cast<double>(kTileCells) * cell * cell;
}

void print_row(const Record& record, double from, double to) {
  const auto of = [&](const std::vector<double>& values) {
    return median(Record::part(values, from, to));
  };
  std::printf("%8.0f m %8.1f ms/scan %8.1f MiB %10.0f nodes %8.0f m2\n",
              Record::part(record.way, from, to).back(), of(record.ms), of(record.mib),
              of(record.nodes), of(record.area));
}

Record drive(CTerrainMap& map, double way, double step) {
  Record record;
  worlds::SimDrive piece;
  int number = -1;
  const auto scans = static_cast<std::size_t>(way / step);
  for (std::size_t k = 0; k < scans; ++k) {
    const double at = static_cast<double>(k) * step;
    const auto now = static_cast<int>(at / kPiece);
    if (now != number) piece = drive_on(number = now);
    piece.motion = sim::Motion(pose_at(at));
    io::Scan scan = worlds::scan_at(piece, 0.0, k);
    scan.stamp = 1000.0 + 0.1 * static_cast<double>(k);
    const mrpt::poses::CPose3D pose(at, std::sin(at / 20.0), 0.0,
                                    std::atan(std::cos(at / 20.0) / 20.0), 0.0, 0.0);
    const double begin = processor_ms();
    EXPECT_TRUE(map.insert_scan(scan, pose));
    record.ms.push_back(processor_ms() - begin);
    record.way.push_back(at);
    record.mib.push_back(resident_mib());
    if (k % kLook != 0) continue;
    const auto tree = map.octree();
    record.nodes.push_back(tree ? static_cast<double>(tree->size()) : 0.0);
    record.area.push_back(area_of(*map.snapshot()));
  }
  for (int tenth = 0; tenth < 10; ++tenth) print_row(record, 0.1 * tenth, 0.1 * (tenth + 1));
  return record;
}

MapParams road_params(double window, double octree_range) {
  MapParams params;
  params.creation.fusion = Fusion::kRolling;
  params.octree.max_range = octree_range;
  GridParams& grid = params.description.grid;
  grid.length = grid.width = window;
  grid.cell_size = 0.2;
  grid.max_height = params.fusion.max_height = 3.0;
  params.fusion.length = params.fusion.width = window;
  return params;
}

double largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

TEST(Soak, ARollingMapDoesNotGrowWithTheWay) {
  const bool is_long = long_way() > 0.0;
  CTerrainMap map(is_long ? road_params(60.0, 20.0) : road_params(24.0, 10.0));
  const Record record = is_long ? drive(map, long_way(), 1.0) : drive(map, 200.0, 2.0);
  const double first = median(Record::part(record.ms, 0.0, 0.1));
  const double last = median(Record::part(record.ms, 0.9, 1.0));
  std::printf("last tenth / first tenth of the times: %.1f / %.1f ms = %.2f\n", last, first,
              last / first);
  const auto settled = [](const std::vector<double>& values) {
    return largest(Record::part(values, 0.5, 1.0)) / median(Record::part(values, 0.12, 0.18));
  };
  std::printf("most in the second half / after 15 %%: memory %.3f, nodes %.3f, area %.3f\n",
              settled(record.mib), settled(record.nodes), settled(record.area));
  EXPECT_GT(record.nodes.back(), 1000.0);
  EXPECT_GT(record.area.back(), 300.0);
  EXPECT_LE(settled(record.mib), kMemoryIsReal ? 1.1 : 10.0);
  // Some places of the road hold more than others.
  const auto grown = [](const std::vector<double>& values) {
    return median(Record::part(values, 0.75, 1.0)) / median(Record::part(values, 0.25, 0.5));
  };
  EXPECT_LE(grown(record.nodes), 1.1);
  EXPECT_LE(grown(record.area), 1.05);
  EXPECT_LE(last / first, is_long ? 1.2 : 10.0);
}

TEST(Soak, AGrowingMapTakesMemoryForTheAreaOnly) {
  const bool is_long = long_way() > 0.0;
  MapParams params = is_long ? road_params(60.0, 20.0) : road_params(24.0, 10.0);
  params.fusion.extent = FusionExtent::kGrowing;
  params.fusion.max_range = 15.0;
  CTerrainMap map(params);
  const Record record = is_long ? drive(map, 0.25 * long_way(), 1.0) : drive(map, 200.0, 2.0);
  // Of what came on top per square metre, in the second half by that in the first.
  const auto steadiness = [&record](const std::vector<double>& values) {
    const auto at = [](const std::vector<double>& of, double share) {
      return median(Record::part(of, share - 0.03, share + 0.03));
    };
    const auto density = [&](double from, double to) {
      return (at(values, to) - at(values, from)) / (at(record.area, to) - at(record.area, from));
    };
    return density(0.56, 0.97) / density(0.15, 0.56);
  };
  const double middle_area = median(Record::part(record.area, 0.45, 0.55));
  const double megabytes = record.mib.back() - record.mib.front();
  std::printf(
      "%.1f MiB for %.0f m2; per m2 in the second half / first half: memory %.3f, nodes "
      "%.3f\n",
      megabytes, record.area.back(), steadiness(record.mib), steadiness(record.nodes));
  EXPECT_GT(record.area.back(), 1.5 * middle_area);
  EXPECT_NEAR(steadiness(record.nodes), 1.0, 0.15);
  // The system gives memory in pieces, which count in the short form.
  EXPECT_LE(is_long ? steadiness(record.mib) : 1.0, 1.2);
}

}  // namespace
}  // namespace mrpt_terrain
