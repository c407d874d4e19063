// SPDX-License-Identifier: BSD-3-Clause
// `terrain-rawlog map`.
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <octomap/OcTree.h>

#include <chrono>
#include <thread>

#include "maps.h"
#include "mrpt_terrain/map/map_file.h"

namespace mrpt_terrain::test {
namespace {

using std::filesystem::exists;

/// Parameters with which the shipped rawlogs show things of several classes, for either command:
/// key, section of `process`, section of a map's definition.
struct Setting {
  std::string process_section, map_section, assignment;
};
const std::vector<Setting> kSettings = {
    {"grid", "creationOpts", "length=20"},     {"grid", "creationOpts", "width=20"},
    {"grid", "creationOpts", "cell_size=0.2"}, {"grid", "creationOpts", "max_height=3"},
    {"ground", "ground", "t_low=-0.1"},        {"clusters", "clusters", "t_c=2"},
    {"input", "insertOpts", "max_range=25"},   {"classes", "classes", "all_features=true"},
    {"slope", "slope", "inlier_distance=0.05"}};

Arguments settings_of(bool for_map) {
  Arguments arguments;
  for (const Setting& setting : kSettings) {
    arguments.push_back("--set");
    arguments.push_back((for_map ? setting.map_section : setting.process_section) + "." +
                        setting.assignment);
  }
  return arguments;
}

/// Bytes of a labelled cloud without the coordinates: support, class, cluster and colour per point.
std::string labels_in(const std::filesystem::path& file) {
  const std::string ply = read_file(file);
  const std::string end = "end_header\n";
  constexpr std::size_t kPoint = 21, kCoordinates = 12;
  std::string labels;
  for (std::size_t at = ply.find(end) + end.size(); at + kPoint <= ply.size(); at += kPoint) {
    labels += ply.substr(at + kCoordinates, kPoint - kCoordinates);
  }
  return labels;
}

/// A shipped rawlog and how many scans it has.
struct Drive {
  std::string name;
  std::size_t scans = 0;
};
std::ostream& operator<<(std::ostream& out, const Drive& drive) { return out << drive.name; }
std::string name_of_test(const testing::TestParamInfo<Drive>& test) { return test.param.name; }

class MapOfDrive : public testing::TestWithParam<Drive> {
 protected:
  const std::filesystem::path folder_ = fresh_folder();
  const std::string rawlog_ = shipped(GetParam().name + ".rawlog");
  const Arguments poses_ = {"--poses", shipped(GetParam().name + ".tum")};

  [[nodiscard]] ProgramResult build(const Arguments& more) const {
    return build_map(folder_, rawlog_, poses_ + more);
  }
  [[nodiscard]] CTerrainMap map() const {
    return load_map_file((folder_ / "built" / "map.metricmap").string());
  }
};

TEST_P(MapOfDrive, DescribesTheLastScanAsProcessDoes) {
  ASSERT_EQ(process(folder_, rawlog_, poses_ + settings_of(false)).exit_code, 0);
  ASSERT_EQ(build(settings_of(true)).exit_code, 0);
  const std::string last = std::to_string(GetParam().scans - 1);
  std::vector<std::map<std::string, std::string>> expected;
  for (const auto& row : read_csv(folder_ / "out" / "clusters.csv")) {
    if (row.at("scan") == last) expected.push_back(row);
  }
  const auto rows = read_csv(folder_ / "built" / "map_clusters.csv");
  ASSERT_FALSE(rows.empty());
  ASSERT_EQ(rows.size(), expected.size());
  const std::map<std::string, std::string> names = {
      {"cluster", "cluster"},  {"class", "class"}, {"cells", "cells"},        {"points", "points"},
      {"height_index", "h_f"}, {"rough", "rough"}, {"slope_deg", "angle_deg"}};
  for (std::size_t k = 0; k < rows.size(); ++k) {
    for (const auto& [own, other] : names) EXPECT_EQ(rows[k].at(own), expected[k].at(other)) << own;
  }
  const std::string ply = (folder_ / "last.ply").string();
  ASSERT_EQ(
      export_map(folder_, (folder_ / "built/map.metricmap").string(), {"--points", ply}).exit_code,
      0);
  const std::string labels = labels_in(ply);
  EXPECT_GT(labels.size(), 10000u);
  EXPECT_EQ(labels, labels_in(folder_ / "out" / ("scan_00000" + last + ".ply")));
}

TEST_P(MapOfDrive, FusesAllScans) {
  const ProgramResult result = build(kRolling);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  const std::string scans = std::to_string(GetParam().scans);
  EXPECT_TRUE(contains(result.out, scans + (scans == "1" ? " scan" : " scans") + " inserted in "))
      << result.out;
  const TerrainSnapshotPtr now = map().snapshot();
  EXPECT_EQ(now->revision, GetParam().scans);
  EXPECT_EQ(now->fused.scans, GetParam().scans);
  for (const std::string& form : kMapForms) EXPECT_TRUE(exists(folder_ / "built" / ("map" + form)));
  EXPECT_EQ(files_ending_in(folder_ / "built", ".part"), Arguments());
}

TEST_P(MapOfDrive, ItsFileHoldsAllThatItWasSavedAs) {
  for (const Arguments& mode : {kRolling, Arguments{}}) {
    ASSERT_EQ(build(mode).exit_code, 0);
    const std::string file = (folder_ / "built" / "map.metricmap").string();
    const ProgramResult result = export_map(folder_, file);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    for (const std::string& form : kMapForms) {
      const std::string built = read_file(folder_ / "built" / ("map" + form));
      EXPECT_GT(built.size(), 50u) << form;
      EXPECT_EQ(read_file(folder_ / "exported" / ("map" + form)), built) << form;
    }
    const std::string again = (folder_ / "again.metricmap").string();
    save_map_file(map(), again);
    EXPECT_EQ(read_file(again), read_file(file));
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, MapOfDrive,
                         testing::Values(Drive{"ramp_parade", 1}, Drive{"pothole_road", 3},
                                         Drive{"curbs", 2}),
                         name_of_test);

TEST(MapCommand, MrptAndOctomapReadItsFiles) {
  const auto folder = fresh_folder();
  ASSERT_EQ(build_map(folder, shipped("pothole_road.rawlog"), kRolling).exit_code, 0);
  mrpt::io::CFileGZInputStream stream((folder / "built/map.metricmap").string());
  CTerrainMap map;
  mrpt::serialization::archiveFrom(stream) >> map;
  EXPECT_EQ(map.snapshot()->revision, 3u);
  std::ostringstream with_odds, binary;
  map.octree()->write(with_odds);
  map.octree()->writeBinaryConst(binary);
  EXPECT_EQ(read_file(folder / "built/map.ot"), with_odds.str());
  EXPECT_EQ(read_file(folder / "built/map.bt"), binary.str());
}

TEST(MapCommand, TakesTheDefinitionThatMrptProgramsTake) {
  const auto folder = fresh_folder();
  const std::string config = MRPT_TERRAIN_SOURCE_DIR "/params/mrpt/terrain_map.ini";
  const ProgramResult result = build_map(folder, shipped("curbs.rawlog"),
                                         {"-c", config, "--set", "creationOpts.octree=false"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const CTerrainMap map = load_map_file((folder / "built/map.metricmap").string());
  EXPECT_EQ(map.params().description.grid.length, 60.0);
  EXPECT_EQ(map.params().description.clusters.t_c, 3);
  EXPECT_EQ(map.octree(), nullptr);
  EXPECT_FALSE(exists(folder / "built/map.ot"));
  EXPECT_TRUE(contains(result.out, "OctoMap: none\n"));
  EXPECT_FALSE(contains(result.out, ".ot"));
}

// What `process` is told is all that a map needs to be described in field mode.
TEST(MapCommand, TakesTheParametersOfProcess) {
  const auto folder = fresh_folder();
  const std::string config = MRPT_TERRAIN_SOURCE_DIR "/params/field.ini";
  for (const char* fusion : {"scan", "rolling"}) {
    const ProgramResult result =
        build_map(folder, shipped("pothole_road.rawlog"),
                  {"-c", config, "--set", std::string("creationOpts.fusion=") + fusion});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const CTerrainMap map = load_map_file((folder / "built/map.metricmap").string());
    EXPECT_EQ(map.params().description.description.mode, DescriptionMode::kField);
    EXPECT_EQ(map.params().description.grid.cell_size, 0.2);
    EXPECT_EQ(map.params().creation.octree_resolution, 0.2);
    const TerrainSnapshotPtr now = map.snapshot();
    const auto potholes =
        std::count_if(now->clusters.begin(), now->clusters.end(), [](const ClusterView& cluster) {
          return cluster.description.terrain_class == TerrainClass::kPothole;
        });
    EXPECT_GE(potholes, 3) << "the road has four";
  }
}

TEST(MapCommand, OutputIsAFolderOrTheBeginningOfNames) {
  const auto folder = fresh_folder();
  std::filesystem::create_directories(folder / "there");
  const std::string input = write_file(folder / "drive.rawlog", drive_bytes(1));
  const std::map<std::string, std::string> cases = {{"there", "there/map"},
                                                    {"new/", "new/map"},
                                                    {"a/b/drive", "a/b/drive"},
                                                    {"c/drive.metricmap", "c/drive"}};
  for (const auto& [given, prefix] : cases) {
    const ProgramResult result =
        terrain_rawlog(folder, {"map", input, "-o", (folder / given).string()});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(exists(folder / (prefix + ".metricmap"))) << given;
    EXPECT_TRUE(exists(folder / (prefix + "_cost.yaml"))) << given;
  }
}

TEST(MapCommand, SimpleMapsBringTheirPoses) {
  const auto folder = fresh_folder();
  mrpt::maps::CSimpleMap keyframes;
  for (int k = 0; k < 3; ++k) {
    mrpt::obs::CSensoryFrame frame;
    frame.insert(std::make_shared<Cloud>(drive_scan(k)));
    mrpt::poses::CPose3DPDFGaussian pose;
    pose.mean = mrpt::poses::CPose3D(10 * k, 0, 0, 0, 0, 0);
    keyframes.insert(pose, frame);
  }
  const std::string file = write_file(folder / "map.simplemap", gzip(stored(keyframes)));
  const ProgramResult result = build_map(folder, file, kRolling);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const CTerrainMap map = load_map_file((folder / "built/map.metricmap").string());
  EXPECT_EQ(map.snapshot()->revision, 3u);
  EXPECT_EQ(map.snapshot()->T_map_robot.translation().x(), 20.0);
  for (const double x : {0.0, 10.0, 20.0}) {
    EXPECT_EQ(map.cell_at(x - 1.1, -0.5).status, PlaceStatus::kKnown) << x;
  }
  EXPECT_EQ(map.cell_at(5.1, -0.5).status, PlaceStatus::kUnknown);
}

TEST(MapCommand, FusedScansNeedPoses) {
  const auto folder = fresh_folder();
  const std::string input = write_file(folder / "drive.rawlog", drive_bytes(3));
  const ProgramResult none = build_map(folder, input, kRolling);
  EXPECT_EQ(none.exit_code, 4);
  EXPECT_TRUE(contains(none.err, input + ": entry 0: there is no pose for its time 1000.000000 s; "
                                         "not inserted"))
      << none.err;
  EXPECT_TRUE(contains(none.err, "error: no scan was inserted; nothing was written\n  3 x no pose"))
      << none.err;
  EXPECT_FALSE(exists(folder / "built/map.metricmap"));
  const std::string poses =
      write_file(folder / "poses.tum", "999.9 0 0 0 0 0 0 1\n1000.15 1 0 0 0 0 0 1\n");
  const ProgramResult two = build_map(folder, input, kRolling + Arguments{"--poses", poses});
  EXPECT_EQ(two.exit_code, 4);
  EXPECT_TRUE(contains(two.err, poses + " has no pose for its time 1000.200000 s; not inserted"))
      << two.err;
  EXPECT_TRUE(contains(two.out, "2 scans inserted in ")) << two.out;
  EXPECT_TRUE(contains(two.out, "not inserted:\n  1 x no pose\n")) << two.out;
}

// Poses that the file itself holds count up to where it is damaged, as its scans do.
TEST(MapCommand, ADamagedFileKeepsItsPosesBeforeTheDamage) {
  const auto folder = fresh_folder();
  std::string bytes;
  for (int k = 0; k < 4; ++k) {
    mrpt::obs::CObservationOdometry odometry;
    odometry.timestamp = mrpt::Clock::fromDouble(1000.0 + 0.1 * k);
    odometry.odometry = mrpt::poses::CPose2D(10.0 * k, 0.0, 0.0);
    bytes += stored(odometry) + stored(drive_scan(k));
  }
  const std::string input =
      write_file(folder / "drive.rawlog", bytes.substr(0, bytes.size() - 1000));
  const ProgramResult result = build_map(folder, input, kRolling);
  EXPECT_EQ(result.exit_code, 3) << result.err;
  EXPECT_TRUE(contains(result.err, "error: " + input)) << result.err;
  EXPECT_TRUE(contains(result.out, "3 scans inserted in ")) << result.out;
  const CTerrainMap map = load_map_file((folder / "built/map.metricmap").string());
  EXPECT_EQ(map.snapshot()->revision, 3U);
  EXPECT_EQ(map.snapshot()->T_map_robot.translation().x(), 20.0);
}

TEST(MapCommand, FusedScansNeedNoFurtherSettings) {
  const auto folder = fresh_folder();
  const std::string fused = "creationOpts.fusion=rolling";
  const std::string input = shipped("pothole_road.rawlog"), poses = shipped("pothole_road.tum");
  const std::vector<std::pair<Arguments, double>> cases = {
      {{}, 0.2},
      {{"--set", "creationOpts.cell_size=0.3"}, 0.3},
      {{"--set", "creationOpts.octree_resolution=0.4"}, 0.4}};
  for (const auto& [settings, size] : cases) {
    const ProgramResult result = build_map(
        folder, input, Arguments{"--poses", poses, "--to-index", "1", "--set", fused} + settings);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const CTerrainMap map = load_map_file((folder / "built/map.metricmap").string());
    EXPECT_EQ(map.params().description.grid.cell_size, size);
    EXPECT_EQ(map.params().creation.octree_resolution, size);
  }
}

TEST(MapCommand, SingleScansDoWithoutPoses) {
  const auto folder = fresh_folder();
  const std::string input = write_file(folder / "drive.rawlog", drive_bytes(2));
  const ProgramResult result = build_map(folder, input);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_TRUE(contains(result.out, "2 without a pose: inserted at the origin\n")) << result.out;
}

TEST(MapCommand, SelectsAsProcessDoes) {
  const auto folder = fresh_folder();
  const std::string input = write_file(folder / "drive.rawlog", drive_bytes(5));
  const ProgramResult result =
      build_map(folder, input, {"--from-index", "1", "--only-first-n", "2", "-v", "debug"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  for (const std::string entry : {"1", "2"}) {
    EXPECT_TRUE(contains(result.out, input + ": entry " + entry + ": inserted in ")) << result.out;
  }
  EXPECT_EQ(load_map_file((folder / "built/map.metricmap").string()).snapshot()->revision, 2u);
}

TEST(MapCommand, AnEmptySelectionWritesNothing) {
  const auto folder = fresh_folder();
  const std::string input = write_file(folder / "drive.rawlog", drive_bytes(2));
  const std::map<std::string, Arguments> cases = {
      {"2 x sensor label not asked for", {"--sensor-label", "radar"}},
      {"--from-index is 7, the last entry of the inputs is 1", {"--from-index", "7"}}};
  for (const auto& [reason, options] : cases) {
    const ProgramResult result = build_map(folder, input, options);
    EXPECT_EQ(result.exit_code, 4);
    EXPECT_EQ(result.err, "error: no scan was inserted; nothing was written\n  " + reason + "\n");
    EXPECT_TRUE(std::filesystem::is_empty(folder / "built"));
  }
}

TEST(MapCommand, ADamagedRawlogGivesTheMapUpToThere) {
  const auto folder = fresh_folder();
  const std::string bytes = drive_bytes(3);
  const std::string input = write_file(folder / "drive.rawlog", bytes.substr(0, bytes.size() - 99));
  const ProgramResult result = build_map(folder, input);
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_TRUE(contains(result.err, "drive.rawlog: entry 2 ")) << result.err;
  EXPECT_EQ(load_map_file((folder / "built/map.metricmap").string()).snapshot()->revision, 2u);
}

TEST(MapCommand, WrongUseIsNamedAndNothingIsDone) {
  const auto folder = fresh_folder();
  const std::string input = write_file(folder / "drive.rawlog", drive_bytes(1));
  const std::string robot = MRPT_TERRAIN_SOURCE_DIR "/params/robots/husky.ini";
  const std::string typo =
      write_file(folder / "typo.ini", "[map_terrainMap_00_creationOpts]\nfusoin = rolling\n");
  const std::string twice =
      write_file(folder / "twice.ini", "[map_terrainMap_00_ground]\nt_high = 1\nt_high = 2\n");
  const std::vector<std::pair<Arguments, std::string>> cases = {
      {{"-c", robot}, robot + ": defines no terrain map: there is no section [map_terrainMap_00_"},
      {{"-c", typo},
       "[map_terrainMap_00_creationOpts] fusoin = rolling: unknown key; did you mean"},
      {{"-c", twice}, twice + ":3: [map_terrainMap_00_ground] t_high = 2: is given twice"},
      {{"-c", "none.ini"}, "none.ini: cannot be read: No such file or directory"},
      {{"--set", "creationOpts.fusion=roling"}, "--set: [creationOpts] fusion = roling: "},
      {{"--set", "grid.length=3"}, "--set: [grid]: unknown section"},
      {{"--set", "creationOpts.fusion=rolling", "--set", "creationOpts.cell_size=0.3", "--set",
        "creationOpts.octree_resolution=0.2"},
       "--set: octree_resolution: must go into cell_size"},
      {{"--from-index", "3", "--to-index", "2"}, "--from-index 3 is behind --to-index 2"},
      {{"--sensor-pose", "1 2"}, "--sensor-pose: \"1 2\" is no pose"}};
  for (const auto& [options, message] : cases) {
    const ProgramResult result = build_map(folder, input, options);
    EXPECT_EQ(result.exit_code, 2) << message;
    EXPECT_TRUE(contains(result.err, message)) << message << "\n" << result.err;
    EXPECT_FALSE(exists(folder / "built"));
  }
}

TEST(MapCommand, MissingInput) {
  const auto folder = fresh_folder();
  const std::string file = (folder / "none.rawlog").string();
  const ProgramResult result = build_map(folder, file);
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.err, "error: " + file + ": no such file\n");
  EXPECT_FALSE(exists(folder / "built"));
}

TEST(MapCommand, OutputsThatCannotBeWritten) {
  const auto folder = fresh_folder();
  const std::string input = write_file(folder / "drive.rawlog", drive_bytes(1));
  const ProgramResult below_a_file = terrain_rawlog(folder, {"map", input, "-o", input + "/map"});
  EXPECT_EQ(below_a_file.exit_code, 5);
  EXPECT_EQ(below_a_file.err, "error: " + input + ": cannot be made: Not a directory\n");
  if (!exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  ASSERT_EQ(build_map(folder, input).exit_code, 0);
  const std::string before = read_file(folder / "built/map.metricmap");
  std::filesystem::create_symlink("/dev/full", folder / "built/map.metricmap.part");
  const ProgramResult full = build_map(folder, input, kRolling);
  EXPECT_EQ(full.exit_code, 4) << "no poses: nothing to write";
  const ProgramResult disk = build_map(folder, input, {"--set", "creationOpts.cell_size=0.1"});
  EXPECT_EQ(disk.exit_code, 5);
  EXPECT_TRUE(contains(disk.err, "map.metricmap: cannot be written: No space left on device"))
      << disk.err;
  EXPECT_EQ(read_file(folder / "built/map.metricmap"), before);
}

TEST(MapCommand, InterruptionKeepsWhatWasBuilt) {
  const auto folder = fresh_folder();
  constexpr std::size_t kScans = 400;
  std::string bytes;
  for (std::size_t k = 0; k < kScans / 4; ++k) bytes += drive_bytes(4);
  const std::string input = write_file(folder / "long.rawlog", bytes);
  Program program(folder,
                  {TERRAIN_RAWLOG, "map", input, "-o", (folder / "map").string(), "-v", "debug"});
  for (int k = 0; k < 1000 && read_file(folder / "stdout.txt").empty(); ++k) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  program.send(SIGINT);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.exit_code, 130);
  EXPECT_EQ(result.err, "warning: interrupted; the map holds the scans up to here\n");
  const CTerrainMap map = load_map_file((folder / "map.metricmap").string());
  EXPECT_GE(map.snapshot()->revision, 1u);
  EXPECT_LT(map.snapshot()->revision, kScans);
  EXPECT_TRUE(exists(folder / "map_clusters.csv"));
}

}  // namespace
}  // namespace mrpt_terrain::test
