// SPDX-License-Identifier: BSD-3-Clause
// What a person sees in real scans, written down from plots of the raw points (and of the camera
// image, for the depth camera) before looking at any result, and looked up in the files that
// `terrain-rawlog process` writes. Positions are in the levelled robot frame, metres.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "mrpt_terrain/core/labels.h"
#include "test_files.h"

namespace mrpt_terrain {
namespace {

enum class Seen {
  kObstacle,        ///< a thing of its own, by the centre of its outline
  kPartOfObstacle,  ///< a place on something long, such as a wall
  kGround           ///< a place that a wheel can stand on
};

struct Thing {
  Seen seen;
  double x, y;
  const char* what;
};

constexpr double kTolerance = 0.5;  // metres

struct LabelledPoint {
  float x, y, z;
  Support support;
  TerrainClass terrain_class;
};

std::vector<LabelledPoint> read_points(const std::string& file) {
  const std::string bytes = test::read_file(file);
  const std::string end = "end_header\n";
  constexpr std::size_t kBytesPerPoint = 21;
  std::vector<LabelledPoint> points;
  std::size_t at = bytes.find(end);
  if (at == std::string::npos) return points;
  for (at += end.size(); at + kBytesPerPoint <= bytes.size(); at += kBytesPerPoint) {
    LabelledPoint point{};
    std::memcpy(&point, &bytes[at], 14);  // x, y, z, support, class
    points.push_back(point);
  }
  return points;
}

std::vector<std::map<std::string, std::string>> read_csv(const std::string& file) {
  std::istringstream lines(test::read_file(file));
  const auto fields = [](const std::string& line) {
    std::vector<std::string> result(1);
    for (const char c : line) {
      if (c == ',') {
        result.emplace_back();
      } else {
        result.back() += c;
      }
    }
    return result;
  };
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> names = fields(line);
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(lines, line)) {
    const std::vector<std::string> values = fields(line);
    std::map<std::string, std::string> row;
    for (std::size_t k = 0; k < names.size(); ++k) row[names[k]] = values.at(k);
    rows.push_back(row);
  }
  return rows;
}

/// What `process` has made of the first scan.
struct Result {
  std::vector<std::map<std::string, std::string>> clusters;
  std::vector<LabelledPoint> points;
};

Result process(const std::string& folder, const std::string& rawlog, const std::string& options) {
  const std::string command = "\"" TERRAIN_RAWLOG "\" process \"" + rawlog + "\" -q -o \"" +
                              folder + "\" --only-first-n 1 " + options;
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  return {read_csv(folder + "/clusters.csv"), read_points(folder + "/scan_000000.ply")};
}

std::string import_set(const std::string& folder, const std::string& name,
                       const std::string& sensor_height) {
  const std::string rawlog = folder + name + ".rawlog";
  const std::string command = "\"" TERRAIN_RAWLOG "\" import \"" +
                              (test::data_folder() / name).string() + "\" -q -o \"" + rawlog +
                              "\" --only-first-n 1 --sensor-pose \"0 0 " + sensor_height + "\"";
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  return rawlog;
}

bool is_outlined(const Result& result, const Thing& thing) {
  return std::any_of(result.clusters.begin(), result.clusters.end(), [&thing](const auto& cluster) {
    const auto number = [&cluster](const char* name) { return std::stod(cluster.at(name)); };
    const double x = (number("min_x") + number("max_x")) / 2;
    const double y = (number("min_y") + number("max_y")) / 2;
    return cluster.at("class") == "obstacle" && std::hypot(x - thing.x, y - thing.y) <= kTolerance;
  });
}

struct Around {
  int points = 0;
  int obstacle = 0;
  int ground = 0;
};

Around look_around(const Result& result, const Thing& thing) {
  Around around;
  for (const LabelledPoint& point : result.points) {
    if (point.support == Support::kUnknown) continue;
    if (std::hypot(point.x - thing.x, point.y - thing.y) > kTolerance) continue;
    ++around.points;
    around.obstacle += point.terrain_class == TerrainClass::kObstacle ? 1 : 0;
    around.ground += point.support == Support::kGround ? 1 : 0;
  }
  return around;
}

void expect_seen(const Result& result, const std::vector<Thing>& things) {
  ASSERT_FALSE(result.clusters.empty());
  ASSERT_FALSE(result.points.empty());
  for (const Thing& thing : things) {
    SCOPED_TRACE(std::string(thing.what) + " at " + std::to_string(thing.x) + ", " +
                 std::to_string(thing.y));
    const Around around = look_around(result, thing);
    switch (thing.seen) {
      case Seen::kObstacle:
        EXPECT_TRUE(is_outlined(result, thing));
        break;
      case Seen::kPartOfObstacle:
        EXPECT_GE(around.obstacle, 3);
        break;
      case Seen::kGround:
        EXPECT_GE(around.points, 5);
        EXPECT_GE(around.ground, 0.9 * around.points);
        break;
    }
  }
}

const std::string kOutdoor =
    "-c \"" MRPT_TERRAIN_SOURCE_DIR "/params/paper_outdoor.ini\" --find-ground";

#define SKIP_WITHOUT(path) \
  if (!std::filesystem::exists(path)) GTEST_SKIP() << (path) << " is not on this machine"

TEST(ThingsSeen, Vlp16BetweenHedgesAndTrees) {
  const auto rawlog = test::mrpt_datasets() / "test_velodyne_VLP16.rawlog";
  SKIP_WITHOUT(rawlog);
  const std::string folder = test::empty_test_folder();
  expect_seen(process(folder, rawlog.string(), kOutdoor),
              {{Seen::kPartOfObstacle, 0.0, -11.4, "wall along the right"},
               {Seen::kPartOfObstacle, 10.0, -10.8, "the same wall ahead"},
               {Seen::kPartOfObstacle, 0.0, -5.0, "hedge right"},
               {Seen::kPartOfObstacle, 8.0, -3.5, "hedge right, ahead"},
               {Seen::kPartOfObstacle, 2.0, 3.5, "tree left"},
               {Seen::kPartOfObstacle, 13.0, -13.5, "second wall, far right"},
               {Seen::kPartOfObstacle, -11.0, -5.0, "tree behind, right"},
               {Seen::kGround, 7.7, 0.0, "path ahead"},
               {Seen::kGround, 12.3, 2.0, "path ahead"},
               {Seen::kGround, -9.0, 0.0, "path behind"},
               {Seen::kGround, -13.0, 2.0, "path behind"}});
}

TEST(ThingsSeen, DepthCameraBeforeABookcase) {
  const auto rawlog = test::mrpt_datasets() / "tests_rgbd.rawlog";
  SKIP_WITHOUT(rawlog);
  const std::string folder = test::empty_test_folder();
  // The camera looks up by 11 degrees (the wall says so); its height is not recorded.
  expect_seen(process(folder, rawlog.string(), "--sensor-pose \"0 0 1.2 0 -11 0\""),
              {{Seen::kPartOfObstacle, 1.9, 0.6, "bookcase, left end"},
               {Seen::kPartOfObstacle, 1.95, 0.0, "bookcase, middle post"},
               {Seen::kPartOfObstacle, 2.0, -0.6, "bookcase, right end"},
               {Seen::kPartOfObstacle, 2.1, -1.0, "wall right of it"}});
}

TEST(ThingsSeen, KittiRaw0001ParkedCarsAndWall) {
  SKIP_WITHOUT(test::data_folder() / "kitti_raw_0001");
  const std::string folder = test::empty_test_folder();
  expect_seen(process(folder, import_set(folder, "kitti_raw_0001", "1.73"), kOutdoor),
              {{Seen::kObstacle, -1.7, 9.0, "parked car, left"},
               {Seen::kObstacle, -7.9, 9.0, "parked car, left behind"},
               {Seen::kObstacle, -12.5, 9.0, "parked car, farther behind"},
               {Seen::kObstacle, 25.1, 8.5, "van ahead"},
               {Seen::kObstacle, 19.2, -9.9, "tree right"},
               {Seen::kObstacle, -16.6, 12.4, "tree trunk left behind"},
               {Seen::kPartOfObstacle, 0.0, -14.0, "wall right"},
               {Seen::kPartOfObstacle, 10.0, -15.0, "wall right, ahead"},
               {Seen::kPartOfObstacle, -20.0, -13.9, "wall right, behind"},
               {Seen::kPartOfObstacle, 8.0, 14.3, "hedge left"},
               {Seen::kGround, 8.0, 0.0, "street"},
               {Seen::kGround, 5.0, 6.0, "street"},
               {Seen::kGround, -10.0, 2.0, "street"},
               {Seen::kGround, -3.0, -6.0, "tram track"}});
}

TEST(ThingsSeen, Kitti00CarsHedgesAndWalls) {
  SKIP_WITHOUT(test::data_folder() / "kitti_00");
  const std::string folder = test::empty_test_folder();
  expect_seen(process(folder, import_set(folder, "kitti_00", "1.73"), kOutdoor),
              {{Seen::kObstacle, 9.5, -3.0, "car right"},
               {Seen::kObstacle, 5.5, 7.0, "car left"},
               {Seen::kObstacle, -18.2, 10.5, "car left behind"},
               {Seen::kObstacle, 11.3, 7.5, "hedge left"},
               {Seen::kObstacle, 15.0, -2.8, "bush right"},
               {Seen::kPartOfObstacle, 10.0, 12.1, "wall left"},
               {Seen::kPartOfObstacle, 3.0, -9.5, "wall right"},
               {Seen::kGround, 10.0, 0.0, "street"},
               {Seen::kGround, -6.0, 4.0, "crossing"},
               {Seen::kGround, -5.0, -6.0, "crossing"}});
}

TEST(ThingsSeen, Rellis104TrailBesideBushes) {
  SKIP_WITHOUT(test::data_folder() / "rellis_104");
  const std::string folder = test::empty_test_folder();
  expect_seen(process(folder, import_set(folder, "rellis_104", "1.28"), kOutdoor),
              {{Seen::kObstacle, -10.4, -2.1, "post behind"},
               {Seen::kPartOfObstacle, -8.2, 5.7, "tree line left"},
               {Seen::kPartOfObstacle, -3.0, 13.3, "tree line left"},
               {Seen::kPartOfObstacle, -15.4, 2.6, "tree behind"},
               {Seen::kPartOfObstacle, -19.7, -11.5, "trees far behind"},
               {Seen::kGround, 8.0, 5.0, "trail"},
               {Seen::kGround, 3.0, -8.0, "trail"},
               {Seen::kGround, -6.0, -3.0, "grass behind"}});
}

}  // namespace
}  // namespace mrpt_terrain
