// SPDX-License-Identifier: BSD-3-Clause
// What terrain-sim writes, read back by terrain-rawlog and by the libraries.
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "scans.h"
#include "sim_runs.h"

namespace mrpt_terrain::test {
namespace {

using mrpt::obs::CObservation2DRangeScan;
using mrpt::obs::CObservationOdometry;
using mrpt::obs::CObservationPointCloud;
using mrpt::obs::CObservationVelodyneScan;
using Names = std::vector<std::string>;

/// Bytes of all files below a folder, by their name in it.
std::map<std::string, std::string> bytes_below(const std::filesystem::path& folder) {
  std::map<std::string, std::string> result;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().lexically_relative(folder).string();
    if (entry.is_regular_file()) result[name] = read_file(entry.path());
  }
  for (const char* own : {"yard.yaml", "stdout.txt", "stderr.txt"}) result.erase(own);
  return result;
}

/// Checks that `terrain-rawlog process` describes all sweeps with all their points.
void expect_processed(const std::filesystem::path& folder, std::size_t sweeps,
                      const Names& more = {}) {
  const ProgramResult result = process(folder, (folder / "run.rawlog").string(), more);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(summary_of(folder)["scans_processed"], sweeps);
}

TEST(TerrainSim, CloudsAreReadByTerrainRawlog) {
  const auto folder = fresh_folder();
  const ProgramResult result = simulate_yard(folder, {"--sweeps", "3"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "run.rawlog: 3 sweeps of VLP-16, ")) << result.out;
  EXPECT_EQ(observations<CObservationPointCloud>(folder / "run.rawlog").size(), 3U);
  expect_processed(folder, 3);
}

TEST(TerrainSim, PacketsAreReadByTerrainRawlogAndHoldTheSamePoints) {
  const auto folder = fresh_folder();
  ASSERT_EQ(simulate_yard(folder, {"--sweeps", "2"}).exit_code, 0);
  const auto clouds = observations<CObservationPointCloud>(folder / "run.rawlog");
  ASSERT_EQ(simulate_yard(folder, {"--sweeps", "2", "--packets"}).exit_code, 0);
  const auto packets = observations<CObservationVelodyneScan>(folder / "run.rawlog");
  expect_processed(folder, 2, {"--poses", (folder / "run.tum").string()});
  ASSERT_EQ(clouds.size(), 2U);
  ASSERT_EQ(packets.size(), 2U);
  io::SensorPoints of_cloud, of_packets;
  io::InputParams all;
  all.min_range = 0.0;
  ASSERT_EQ(io::convert_observation(*clouds[1], all, {}, of_cloud).status,
            io::ConversionStatus::kOk);
  ASSERT_EQ(io::convert_observation(*packets[1], all, {}, of_packets).status,
            io::ConversionStatus::kOk);
  ASSERT_EQ(of_cloud.points.size(), of_packets.points.size());
  const Points &a = of_cloud.points, &b = of_packets.points;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double difference = std::hypot(a.x[k] - b.x[k], a.y[k] - b.y[k], a.z[k] - b.z[k]);
    // Half a step of the range, a step of the azimuth (0.01 deg).
    ASSERT_LE(difference, 0.0012 + 1.8e-4 * std::hypot(a.x[k], a.y[k], a.z[k])) << k;
  }
}

/// Greatest distance between a point and the nearest surface, beyond what the format explains:
/// half a step of 2 mm, 0.01 deg of azimuth, rounded coordinates.
double worst_excess(const MapPoints& map) {
  double worst = 0.0;
  for (std::size_t k = 0; k < map.points.size(); ++k) {
    worst = std::max(worst, off_surface(map.points[k]) - 0.0015 - 2e-4 * map.ranges[k]);
  }
  return worst;
}

TEST(TerrainSim, AnalyticPosesUndoTheMotionOfPackets) {
  const auto folder = fresh_folder();
  ASSERT_EQ(simulate_yard(folder, {"--packets", "--perfect"}).exit_code, 0);
  const auto poses = io::load_tum((folder / "run.tum").string());
  const auto scans = observations<CObservationVelodyneScan>(folder / "run.rawlog");
  ASSERT_GT(scans.size(), 30U);
  double skewed = 0.0;
  for (const auto& scan : scans) {
    const MapPoints map = map_points(*scan, poses, true);
    ASSERT_TRUE(map.deskewed);
    ASSERT_GT(map.points.size(), 5000U);
    EXPECT_LE(worst_excess(map), 0.0) << mrpt::Clock::toDouble(scan->timestamp);
    skewed = std::max(skewed, worst_excess(map_points(*scan, poses, false)));
  }
  EXPECT_GT(skewed, 0.05) << "the robot moved";
}

TEST(TerrainSim, AnalyticDeskewedCloudsLieOnTheSurfaces) {
  const auto folder = fresh_folder();
  ASSERT_EQ(simulate_yard(folder, {"--deskewed", "--perfect", "--every", "0.5"}).exit_code, 0);
  const auto poses = io::load_tum((folder / "run.tum").string());
  const auto scans = observations<CObservationPointCloud>(folder / "run.rawlog");
  ASSERT_GE(scans.size(), 9U);
  ASSERT_LE(scans.size(), 11U);
  for (const auto& scan : scans) EXPECT_LE(worst_excess(map_points(*scan, poses, true)), 0.0);
  ASSERT_EQ(simulate_yard(folder, {"--perfect", "--every", "0.5"}).exit_code, 0);
  double skewed = 0.0;
  for (const auto& scan : observations<CObservationPointCloud>(folder / "run.rawlog")) {
    skewed = std::max(skewed, worst_excess(map_points(*scan, poses, true)));
  }
  EXPECT_GT(skewed, 0.05) << "clouds have no times";
}

TEST(TerrainSim, AnalyticPlanarScannerWritesPlanarScans) {
  const auto folder = fresh_folder();
  // From the origin the front of box 9 is out of the field of view, box 7 is met at x = 3.5.
  const Names how = {"--sensor", "lms111", "--perfect",           "--path", "0,0", "--sweeps",
                     "1",        "--set",  "vehicle.sensor_z=0.3"};
  ASSERT_EQ(simulate_yard(folder, how).exit_code, 0);
  const auto scans = observations<CObservation2DRangeScan>(folder / "run.rawlog");
  ASSERT_EQ(scans.size(), 1U);
  const CObservation2DRangeScan& scan = *scans[0];
  EXPECT_NEAR(scan.sensorPose.z(), 0.3, 1e-9);
  std::size_t hits = 0;
  for (std::size_t k = 0; k < scan.getScanSize(); ++k) {
    const double angle = scan.getScanAngle(k);
    const double y = 3.5 * std::tan(angle);
    if (std::abs(angle) > 1.0 || y > -1.01 || y < -2.99) continue;
    ASSERT_TRUE(scan.getScanRangeValidity(k));
    EXPECT_NEAR(scan.getScanRange(k), 3.5 / std::cos(angle), 1e-4);
    ++hits;
  }
  EXPECT_GT(hits, 80U);
}

/// Odometry without errors is the way on level ground.
TEST(TerrainSim, AnalyticOdometryWithoutErrorsIsTheWay) {
  const auto folder = fresh_folder();
  ASSERT_EQ(simulate_yard(folder, {"--set", "odometry.scale_sigma=0", "--set",
                                   "odometry.way_sigma=0", "--set", "odometry.turn_sigma_deg=0"})
                .exit_code,
            0);
  const auto readings = observations<CObservationOdometry>(folder / "run.rawlog");
  ASSERT_GT(readings.size(), 60U);
  const auto poses = io::load_tum((folder / "run.tum").string());
  for (const auto& reading : readings) {
    const auto truth = poses.at(mrpt::Clock::toDouble(reading->timestamp));
    ASSERT_TRUE(truth.has_value());
    EXPECT_NEAR(reading->odometry.x(), truth->x(), 1e-3);  // chords instead of arcs
    EXPECT_NEAR(reading->odometry.y(), truth->y(), 1e-3);
    EXPECT_NEAR(reading->odometry.phi(), truth->yaw(), 1e-5);
  }
}

TEST(TerrainSim, SameSeedSameBytesOtherSeedOtherBytes) {
  const auto folder = fresh_folder();
  const Names how = {"--sweeps", "2", "--preview", (folder / "plan.png").string()};
  const auto run = [&](Names more) {
    more.insert(more.end(), how.begin(), how.end());
    EXPECT_EQ(simulate_yard(folder, more).exit_code, 0);
    return bytes_below(folder);
  };
  const auto first = run({"--seed", "5"});
  EXPECT_GE(first.size(), 4U) << "rawlog, poses, picture, truth";
  EXPECT_EQ(first, run({"--seed", "5"}));
  const auto other = run({"--seed", "6"});
  EXPECT_NE(first.at("run.rawlog"), other.at("run.rawlog"));
  EXPECT_EQ(first.at("run.tum"), other.at("run.tum")) << "the way does not depend on it";
}

TEST(TerrainSim, NeitherLocaleNorTimeZoneNorFolderGetIntoTheBytes) {
  const auto folder = fresh_folder();
  ASSERT_EQ(simulate_yard(folder, {"--sweeps", "1", "--packets"}).exit_code, 0);
  const auto first = bytes_below(folder);
  const auto elsewhere = folder.parent_path() / "another folder";
  std::filesystem::remove_all(elsewhere);
  std::filesystem::create_directories(elsewhere);
  write_file(elsewhere / "yard.yaml", kYard);
  const std::string command = "cd '" + elsewhere.string() +
                              "' && LC_ALL=de_DE.UTF-8 TZ=Asia/Tokyo OMP_NUM_THREADS=1 "
                              "'" TERRAIN_SIM "' yard.yaml -o run.rawlog --sweeps 1 --packets";
  ASSERT_EQ(Program(elsewhere, {"/bin/sh", "-c", command}).wait().exit_code, 0);
  EXPECT_EQ(first, bytes_below(elsewhere));
}

TEST(TerrainSim, PreviewNeedsNoRawlog) {
  const auto folder = fresh_folder();
  const std::string scene = write_file(folder / "yard.yaml", kYard);
  const std::string picture = (folder / "plan.png").string();
  const ProgramResult result = terrain_sim(folder, {scene, "--preview", picture});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(read_file(picture).substr(1, 3), "PNG");
  EXPECT_EQ(files_ending_in(folder, ".rawlog"), Names());
}

TEST(TerrainSim, TooShortAPathIsSaid) {
  const auto folder = fresh_folder();
  const ProgramResult result =
      simulate_yard(folder, {"--path", "0,0; 1,0", "--sweeps", "50", "--no-truth"});
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_TRUE(contains(result.err, " of 50 sweeps")) << result.err;
  EXPECT_LT(observations<CObservationPointCloud>(folder / "run.rawlog").size(), 50U);
}

/// Arguments that are refused, and what the message says. YARD stands for the scene.
struct WrongSimUse {
  std::string name;
  Names arguments;
  std::string message;
  int exit_code = 2;
};
class WrongTerrainSim : public testing::TestWithParam<WrongSimUse> {};

TEST_P(WrongTerrainSim, IsRefusedAndNothingIsWritten) {
  const auto folder = fresh_folder();
  const std::string scene = write_file(folder / "yard.yaml", kYard);
  write_file(folder / "odd.path", "0 0\n1 one\n");
  Names arguments = GetParam().arguments;
  for (std::string& argument : arguments) {
    if (argument == "YARD") argument = scene;
    if (argument.rfind("DIR/", 0) == 0) argument = (folder / argument.substr(4)).string();
  }
  const ProgramResult result = terrain_sim(folder, arguments);
  EXPECT_EQ(result.exit_code, GetParam().exit_code) << result.err;
  EXPECT_TRUE(contains(result.err, GetParam().message)) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(bytes_below(folder).size(), 1U) << "only the file with the odd path";
}

WrongSimUse wrong(const std::string& name, Names more, const std::string& message) {
  more.insert(more.begin(), {"YARD", "-o", "DIR/run.rawlog"});
  return {name, std::move(more), message};
}

INSTANTIATE_TEST_SUITE_P(
    TerrainSim, WrongTerrainSim,
    testing::Values(
        WrongSimUse{"Nothing", {}, "give a scene file, or a family with --family"},
        WrongSimUse{"NothingToDo", {"YARD"}, "give -o OUT.rawlog, or --preview"},
        WrongSimUse{"NoScene", {"DIR/none.yaml", "-o", "DIR/run.rawlog"}, "none.yaml"},
        WrongSimUse{"NoFamily", {"--family", "nowhere", "-o", "DIR/run.rawlog"}, "nowhere"},
        WrongSimUse{"OutputIsTheScene", {"YARD", "-o", "DIR/yard.yaml"}, "would be overwritten"},
        WrongSimUse{"OutputIsCalledAsThePoses", {"YARD", "-o", "DIR/run.tum"}, "run.tum"},
        WrongSimUse{"NoOutputFolder",
                    {"YARD", "-o", "DIR/none/run.rawlog"},
                    "run.rawlog: cannot be written",
                    5},
        WrongSimUse{"NoPictureFolder",
                    {"YARD", "--preview", "DIR/none/plan.png"},
                    "plan.png: cannot be written",
                    5},
        wrong("SceneAndFamily", {"--family", "nowhere"}, "scene file, or a family"),
        wrong("UnknownOption", {"--sweps", "3"}, "--sweps"),
        wrong("NoSweeps", {"--sweeps", "0"}, "--sweeps"),
        wrong("NegativeDuration", {"--duration", "-1"}, "--duration"),
        wrong("TooShortForASweep", {"--duration", "0.01"}, "no time for a single sweep"),
        wrong("SeedOfWords", {"--seed", "lucky"}, "--seed"),
        wrong("UnknownSensor", {"--sensor", "hdl33e"}, "--sensor = 'hdl33e'"),
        wrong("NoSensorFile", {"--sensor", "DIR/none.yaml"}, "none.yaml"),
        wrong("PacketsOfAnOuster", {"--sensor", "os1-64", "--packets"},
              "--packets: sensor OS1-64: has no packets; VLP-16, HDL-32E and HDL-64E have"),
        wrong("DeskewedPackets", {"--packets", "--deskewed"}, "exclude each other"),
        wrong("DeskewedPlanarScan", {"--sensor", "lms111", "--deskewed"}, "--deskewed: a planar"),
        wrong("PathOfWords", {"--path", "0,0; 1,north"}, "--path: \" 1,north\" is no waypoint"),
        wrong("PathFileWithWords", {"--path", "DIR/odd.path"}, "odd.path:2: \"1 one\""),
        wrong("NoPathFile", {"--path", "DIR/none.path"}, "none.path: cannot be read"),
        wrong("PathThatLeavesTheTerrain", {"--path", "0,0; 30,0"}, "--path: leaves the terrain"),
        wrong("UnknownParameter", {"--set", "noise.range_sigm=1"},
              "--set: [noise] range_sigm = 1: unknown key; did you mean `range_sigma`?"),
        wrong("ParameterOutOfRange", {"--set", "noise.range_sigma=-1"}, "must be within [0, 1] m"),
        wrong("ThreeSubRays", {"--set", "noise.sub_rays=3"}, "must be 1 or 5")),
    [](const auto& test) { return test.param.name; });

TEST(TerrainSim, WrongScenesAreRefusedWithFileKeyValueAndRule) {
  const auto folder = fresh_folder();
  const std::string scene = write_file(folder / "bad.yaml", kYard + "lamp: {height: 2}\n");
  const ProgramResult result = terrain_sim(folder, {scene, "-o", (folder / "run.rawlog").string()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(contains(result.err, "bad.yaml")) << result.err;
  EXPECT_TRUE(contains(result.err, "lamp")) << result.err;
}

/// Waits until the program has begun to write.
bool appears(const std::filesystem::path& file) {
  for (int k = 0; k < 1000; ++k) {
    if (std::filesystem::exists(file)) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

TEST(TerrainSim, InterruptionLeavesNoFiles) {
  const auto folder = fresh_folder();
  const std::string scene = write_file(folder / "yard.yaml", kYard);
  Program program(folder, {TERRAIN_SIM, scene, "-o", (folder / "run.rawlog").string(), "--path",
                           "0,0", "--sensor", "hdl64e", "--sweeps", "5000"});
  ASSERT_TRUE(appears(folder / "run.rawlog.part"));
  program.send(SIGINT);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.exit_code, 130);
  EXPECT_TRUE(contains(result.err, "interrupted; nothing was written")) << result.err;
  EXPECT_EQ(bytes_below(folder).size(), 0U);
}

TEST(TerrainSim, AClosedPipeDoesNotStopTheRun) {
  const auto folder = fresh_folder();
  const std::string scene = write_file(folder / "yard.yaml", kYard);
  const std::string command = "('" TERRAIN_SIM "' '" + scene + "' -o '" +
                              (folder / "run.rawlog").string() +
                              "' --sweeps 1; echo $? >&2) | true";
  const ProgramResult result = Program(folder, {"/bin/sh", "-c", command}).wait();
  EXPECT_EQ(result.err, "0\n");
  EXPECT_EQ(observations<CObservationPointCloud>(folder / "run.rawlog").size(), 1U);
}

TEST(TerrainSim, HelpNamesOptionsAndExitCodes) {
  const ProgramResult result = terrain_sim(fresh_folder(), {"--help"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
  for (const std::string part :
       {"--sensor", "--path", "--speed", "--seed", "--sweeps", "--duration", "--every", "--output",
        "--packets", "--deskewed", "--set", "--perfect", "--max-range", "--no-truth", "--preview",
        "--family", "--family-seed", "Exit codes: 0 all well; 2 "}) {
    EXPECT_TRUE(contains(result.out, part)) << part;
  }
}

}  // namespace
}  // namespace mrpt_terrain::test
