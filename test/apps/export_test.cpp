// SPDX-License-Identifier: BSD-3-Clause
// `terrain-rawlog export`, and what `info` says of stored maps.
#include <mrpt/maps/CSimplePointsMap.h>
#include <sys/stat.h>

#include "maps.h"
#include "mrpt_terrain/map/terrain_map.h"

namespace mrpt_terrain::test {
namespace {

using std::filesystem::exists;

/// A map of two scans; its file is FOLDER/built/map.metricmap.
std::string built_map(const std::filesystem::path& folder) {
  const std::string input = write_file(folder / "drive.rawlog", drive_bytes(2));
  const ProgramResult result = build_map(folder, input);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return (folder / "built" / "map.metricmap").string();
}

TEST(Export, SettingsChangeWhatTheSceneShows) {
  const auto folder = fresh_folder();
  const std::string file = built_map(folder);
  ASSERT_EQ(export_map(folder, file, {"--set", "renderOpts.colouring=cost"}).exit_code, 0);
  for (const std::string& form : kMapForms) {
    const bool same = read_file(folder / "exported" / ("map" + form)) ==
                      read_file(folder / "built" / ("map" + form));
    EXPECT_EQ(same, form != ".3Dscene") << form;
  }
}

TEST(Export, PointsAreThoseOfTheLastScanInTheMap) {
  const auto folder = fresh_folder();
  const std::string input = write_file(folder / "drive.rawlog", drive_bytes(1));
  ASSERT_EQ(process(folder, input).exit_code, 0);
  ASSERT_EQ(build_map(folder, input).exit_code, 0);
  const std::string ply = (folder / "points.ply").string();
  const ProgramResult result =
      export_map(folder, (folder / "built/map.metricmap").string(), {"--points", ply});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "points of the last scan: " + ply + "\n"));
  EXPECT_EQ(read_file(ply), read_file(folder / "out/scan_000000.ply")) << "at the map's origin";
}

/// A file that is not the map it should be.
struct BadMap {
  std::string name;
  std::string bytes;
  std::string reason;
};

std::vector<BadMap> bad_maps(const std::string& good_file) {
  const std::string packed = read_file(good_file), plain = gunzip_file(good_file);
  const std::string no_object = "is no terrain map: it does not begin with an MRPT object";
  std::string flipped = plain, damaged = packed, later = plain;
  flipped[plain.size() / 2] = static_cast<char>(flipped[plain.size() / 2] ^ 1);
  damaged[packed.size() / 2] = static_cast<char>(damaged[packed.size() / 2] ^ 0x55);
  later[1 + std::string("mrpt_terrain::CTerrainMap").size()] = 9;
  return {
      {"empty", "", "is empty"},
      {"gzip of nothing", gzip(""), no_object},
      {"text", "Dear diary\n", no_object},
      {"gzip of text", gzip("Dear diary\n"), no_object},
      {"zeros", std::string(10000, '\0'), no_object},
      {"foreign", gzip(stored(mrpt::maps::CSimplePointsMap())),
       "is no terrain map: it holds a mrpt::maps::CSimplePointsMap"},
      {"rawlog", drive_bytes(1), "is no terrain map: it holds a mrpt::obs::CObservationPointCloud"},
      {"cut off", packed.substr(0, packed.size() / 2), "the gzip data is cut off"},
      {"without its last byte", packed.substr(0, packed.size() - 1), "the gzip data is cut off"},
      {"cut off within", gzip(plain.substr(0, plain.size() / 2)), "the map in it is cut off"},
      {"cut off at the start", gzip(plain.substr(0, 40)), "the map in it is cut off"},
      {"damaged", damaged, "damaged"},
      {"flipped", gzip(flipped), "it is damaged (the checksum is wrong)"},
      {"two", gzip(plain + plain), "there is more in it than a map"},
      {"later", gzip(later), "written by a later version of this class (9)"},
  };
}

TEST(Export, FilesThatHoldNoTerrainMapAreRefused) {
  const auto folder = fresh_folder();
  const std::string good = built_map(folder);
  for (const BadMap& bad : bad_maps(good)) {
    const std::string file = write_file(folder / "bad.metricmap", bad.bytes);
    const ProgramResult result = export_map(folder, file);
    EXPECT_EQ(result.exit_code, 3) << bad.name;
    EXPECT_EQ(result.err.substr(0, 7 + file.size() + 2), "error: " + file + ": ") << bad.name;
    EXPECT_TRUE(contains(result.err, bad.reason)) << bad.name << "\n" << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_FALSE(exists(folder / "exported")) << bad.name;
  }
}

TEST(Export, FilesThatCannotBeReadAreRefused) {
  const auto folder = fresh_folder();
  const std::string missing = (folder / "none.metricmap").string();
  EXPECT_EQ(export_map(folder, missing).err, "error: " + missing + ": no such file\n");
  EXPECT_EQ(export_map(folder, missing).exit_code, 3);
  EXPECT_EQ(export_map(folder, folder.string()).err,
            "error: " + folder.string() + ": is a folder, not a file\n");
  const std::string pipe = (folder / "pipe").string();
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(export_map(folder, pipe).err,
            "error: " + pipe + ": is a pipe or a device, not a file\n");
}

TEST(Export, TheMapNeedNotBeCompressed) {
  const auto folder = fresh_folder();
  const std::string file = write_file(folder / "plain.metricmap", gunzip_file(built_map(folder)));
  EXPECT_EQ(export_map(folder, file).exit_code, 0);
  EXPECT_EQ(read_file(folder / "exported/map.bt"), read_file(folder / "built/map.bt"));
}

TEST(Export, AMapWithoutScansHasFewerForms) {
  const auto folder = fresh_folder();
  const std::string file = write_file(folder / "empty.metricmap", gzip(stored(CTerrainMap())));
  const ProgramResult result = export_map(folder, file);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "\nempty\n")) << result.out;
  EXPECT_TRUE(exists(folder / "exported/map_clusters.csv"));
  EXPECT_FALSE(exists(folder / "exported/map_classes.png"));
}

TEST(Export, WrongUse) {
  const auto folder = fresh_folder();
  const std::string file = built_map(folder);
  const std::vector<std::pair<Arguments, std::string>> cases = {
      {{"--set", "creationOpts.length=3"},
       "--set: [creationOpts]: unknown section; there are [renderOpts]"},
      {{"--set", "renderOpts.colouring=green"}, "--set: [renderOpts] colouring = green: "},
      {{"--set", "colouring=cost"}, "must be written section.key=value"}};
  for (const auto& [options, message] : cases) {
    const ProgramResult result = export_map(folder, file, options);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_TRUE(contains(result.err, message)) << result.err;
    EXPECT_FALSE(exists(folder / "exported"));
  }
}

TEST(Export, OutputsThatCannotBeWritten) {
  const auto folder = fresh_folder();
  const std::string file = built_map(folder);
  const ProgramResult below = terrain_rawlog(folder, {"export", file, "-o", file + "/map"});
  EXPECT_EQ(below.exit_code, 5);
  EXPECT_EQ(below.err, "error: " + file + ": cannot be made: Not a directory\n");
  const std::string ply = file + "/points.ply";
  const ProgramResult points = export_map(folder, file, {"--points", ply});
  EXPECT_EQ(points.exit_code, 5);
  EXPECT_TRUE(contains(points.err, ply + ": cannot be written: Not a directory")) << points.err;
}

TEST(Info, SaysWhatAStoredMapHolds) {
  const auto folder = fresh_folder();
  const std::string map = built_map(folder);
  const ProgramResult result = terrain_rawlog(folder, {"info", map});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  for (const std::string line :
       {"terrain map, fusion = scan: the last scan by itself\n",
        "scans: 2, the last with 14 464 points, t = 1000.100 s, robot at 0.00 0.00 0.00 m\n",
        " of 0.05 m, x -2.4 to 2.4 m, y -2.4 to 2.4 m of the map\n",
        "OctoMap: ", " nodes, voxels of 0.2 m\n", "1 cluster"}) {
    EXPECT_TRUE(contains(result.out, line)) << line << "\n" << result.out;
  }
  const std::string cut = write_file(folder / "cut.metricmap", gunzip_file(map).substr(0, 1000));
  const ProgramResult damaged = terrain_rawlog(folder, {"info", cut, map});
  EXPECT_EQ(damaged.exit_code, 3);
  EXPECT_EQ(damaged.err, "error: " + cut + ": the map in it is cut off\n");
  EXPECT_TRUE(contains(damaged.out, "scans: 2")) << "the other file is told: " << damaged.out;
}

}  // namespace
}  // namespace mrpt_terrain::test
