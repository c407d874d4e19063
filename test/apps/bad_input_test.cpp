// SPDX-License-Identifier: BSD-3-Clause
// Bad input gets a clear message with file and position and an exit code, and loses nothing.
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>

#include <limits>

#include "scans.h"

namespace mrpt_terrain::test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

using std::filesystem::exists;

TEST(BadInput, MissingFile) {
  const auto folder = fresh_folder();
  const std::string file = (folder / "none.rawlog").string();
  const ProgramResult result = process(folder, file);
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.err, "error: " + file + ": no such file\n");
  EXPECT_EQ(result.out, "");
  EXPECT_FALSE(exists(folder / "out")) << "nothing was done";
}

TEST(BadInput, MissingFileLeavesTheResultsOfAnEarlierRun) {
  const auto folder = fresh_folder();
  ASSERT_EQ(process_bytes(folder, drive_bytes(2)).exit_code, 0);
  EXPECT_EQ(process(folder, (folder / "none.rawlog").string()).exit_code, 3);
  expect_tables_of(folder, 2);
}

TEST(BadInput, EmptyFile) {
  const auto folder = fresh_folder();
  const ProgramResult result = process_bytes(folder, "");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.err, "error: " + (folder / "drive.rawlog").string() + ": is empty\n");
}

TEST(BadInput, AFileThatIsNoRawlog) {
  const auto folder = fresh_folder();
  for (const std::string& bytes :
       {std::string("Dear diary\n"), std::string(100000, '\0'), gzip("Dear diary\n")}) {
    const ProgramResult result = process_bytes(folder, bytes);
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_TRUE(contains(result.err, "drive.rawlog: is neither a rawlog nor a simple map"))
        << result.err;
  }
}

TEST(BadInput, AFolder) {
  const auto folder = fresh_folder();
  const ProgramResult result = process(folder, folder.string());
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.err, "error: " + folder.string() + ": is a folder, not a file\n");
}

TEST(BadInput, TruncatedRawlog) {
  const auto folder = fresh_folder();
  const std::string whole = drive_bytes(4);
  const std::size_t fourth = drive_bytes(3).size();
  const ProgramResult result = process_bytes(folder, whole.substr(0, fourth + 1000));
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_TRUE(contains(result.err,
                       "drive.rawlog: entry 3 (mrpt::obs::CObservationPointCloud) at "
                       "byte " +
                           std::to_string(fourth)))
      << result.err;
  EXPECT_TRUE(contains(result.err, std::to_string(fourth + 1000))) << "where it ends";
  expect_tables_of(folder, 3);
  EXPECT_EQ(files_ending_in(folder / "out", ".png").size(), 2u) << "first and last scan";
}

TEST(BadInput, TruncatedCompressedRawlog) {
  const auto folder = fresh_folder();
  const std::string whole = gzip(drive_bytes(8));
  const ProgramResult result = process_bytes(folder, whole.substr(0, whole.size() / 2));
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_TRUE(contains(result.err, " at byte ")) << result.err;
  const std::size_t scans = read_csv(folder / "out" / "scans.csv").size();
  EXPECT_GE(scans, 2u);
  EXPECT_LE(scans, 5u);
  expect_tables_of(folder, scans);
}

TEST(BadInput, CorruptedRawlog) {
  const auto folder = fresh_folder();
  std::string bytes = drive_bytes(4);
  const std::size_t third = drive_bytes(2).size();
  std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(third), 64, '\x55');
  const ProgramResult result = process_bytes(folder, bytes);
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_TRUE(contains(result.err, "drive.rawlog: entry 2 at byte " + std::to_string(third)))
      << result.err;
  EXPECT_TRUE(contains(result.err, "damaged")) << result.err;
  expect_tables_of(folder, 2);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST(BadInput, CorruptedLengthDoesNotTakeTheMemoryOfTheMachine) {
  const auto folder = fresh_folder();
  const std::size_t second = drive_bytes(1).size();
  std::string bytes = drive_bytes(2);
  // The number of points precedes the x of the first one.
  const std::size_t points = ground_with_block(0).size();
  std::string count(4, '\0');
  for (std::size_t k = 0; k < 4; ++k) count[k] = static_cast<char>(points >> (8 * k));
  const std::size_t at = bytes.find(count, second);
  ASSERT_NE(at, std::string::npos);
  bytes.replace(at, 4, "\xff\xff\xff\xff");
  const ProgramResult result = process_bytes(folder, bytes);
  EXPECT_EQ(result.exit_code, 3) << result.err;
  EXPECT_TRUE(contains(
      result.err, "entry 1 (mrpt::obs::CObservationPointCloud) at byte " + std::to_string(second)))
      << result.err;
  expect_tables_of(folder, 1);
  const long machine_kib = sysconf(_SC_PHYS_PAGES) * (sysconf(_SC_PAGESIZE) / 1024);
  EXPECT_LT(result.max_resident_kib, machine_kib / 2);
}
#endif

TEST(BadInput, UnknownObservationClassesAreCountedAndNamed) {
  const auto folder = fresh_folder();
  std::string unknown = stored(mrpt::obs::CObservationIMU());
  const std::string name = "CObservationIMU";
  unknown.replace(unknown.find(name), name.size(), "CObservationXYZ");
  const std::string bytes =
      stored(drive_scan(0)) + unknown + stored(drive_scan(1)) + unknown + stored(drive_scan(2));
  const ProgramResult result = process_bytes(folder, bytes);
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_TRUE(contains(result.err,
                       "drive.rawlog: 2 objects of the unknown class "
                       "mrpt::obs::CObservationXYZ passed over"))
      << result.err;
  expect_tables_of(folder, 3);
  EXPECT_EQ(summary_of(folder)["unknown_classes"]["mrpt::obs::CObservationXYZ"], 2);
}

TEST(BadInput, NanAndInfinitePointsAreCounted) {
  const auto folder = fresh_folder();
  PointList points = ground_with_block(0.3F);
  points.push_back({kNan, 1, 0});
  points.push_back({1, 1, -kInfinity});
  points.push_back({kInfinity, kNan, 0});
  const ProgramResult result = process_bytes(folder, stored(cloud_of(points)));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expect_tables_of(folder, 1);
  EXPECT_EQ(read_csv(folder / "out" / "scans.csv").at(0).at("left_out_not_finite"), "3");
  EXPECT_EQ(summary_of(folder)["left_out"]["not_finite"], 3);
}

TEST(BadInput, ZeroReturnsAreCounted) {
  const auto folder = fresh_folder();
  PointList points = ground_with_block(0.3F);
  // The lattice of the ground holds the origin itself.
  points.insert(points.end(), 6, {0, 0, 0});
  const ProgramResult result = process_bytes(folder, stored(cloud_of(points)));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expect_tables_of(folder, 1);
  EXPECT_EQ(read_csv(folder / "out" / "scans.csv").at(0).at("left_out_no_return"), "7");
  EXPECT_EQ(summary_of(folder)["left_out"]["no_return"], 7);
}

/// A scan in whose place another one has nothing to describe.
struct UselessScan {
  std::string name;
  PointList points;
  std::string message;  ///< after file and entry
  std::string left_out;
};
class ScanWithoutUsablePoints : public testing::TestWithParam<UselessScan> {};

TEST_P(ScanWithoutUsablePoints, IsReportedAndTheOthersAreDescribed) {
  const auto folder = fresh_folder();
  const std::string bytes =
      stored(drive_scan(0)) + stored(cloud_of(GetParam().points)) + stored(drive_scan(1));
  const ProgramResult result = process_bytes(folder, bytes);
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_TRUE(contains(result.err, "drive.rawlog: entry 1: " + GetParam().message)) << result.err;
  expect_tables_of(folder, 2);
  const auto summary = summary_of(folder);
  EXPECT_EQ(summary["scans_skipped"], 1);
  EXPECT_GE(summary["left_out"][GetParam().left_out], 2);
}

const std::string kCloud = "mrpt::obs::CObservationPointCloud 'lidar' ";
INSTANTIATE_TEST_SUITE_P(
    BadInput, ScanWithoutUsablePoints,
    testing::Values(UselessScan{"NanAndInfinitePoints",
                                {{kNan, 0, 0}, {1, kInfinity, 0}},
                                kCloud + "holds no usable point: 0 without return, 2 not finite, "
                                         "0 out of range",
                                "not_finite"},
                    UselessScan{"ZeroReturns",
                                {{0, 0, 0}, {0, 0, 0}},
                                kCloud + "holds no usable point: 2 without return, 0 not finite, "
                                         "0 out of range",
                                "no_return"},
                    UselessScan{"NoPointsInRange",
                                {{500, 0, 0}, {0.1F, 0, 0}},
                                kCloud + "holds no usable point: 0 without return, 0 not finite, "
                                         "2 out of range",
                                "out_of_range"}),
    [](const auto& test) { return test.param.name; });

TEST(BadInput, ScanWithoutPointsInTheMapIsReported) {
  const auto folder = fresh_folder();
  const ProgramResult result =
      process_bytes(folder, stored(drive_scan(0)) + stored(cloud_of({{50, 0, 0}, {60, 0, 0}})));
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_TRUE(contains(result.err, "drive.rawlog: entry 1: none of its 2 points lies in the map"))
      << result.err;
  EXPECT_EQ(read_csv(folder / "out" / "scans.csv").size(), 2u);
}

TEST(BadInput, ManyUselessScansAreNamedAFewTimesAndCounted) {
  const auto folder = fresh_folder();
  std::string bytes = stored(drive_scan(0));
  for (int k = 1; k <= 20; ++k) {
    bytes += stored(cloud_of(PointList(static_cast<std::size_t>(k), {0, 0, 0})));
  }
  const ProgramResult result = process_bytes(folder, bytes);
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 4) << result.err;
  EXPECT_TRUE(contains(result.err, "drive.rawlog: entry 1: and 17 more of this kind\n"))
      << result.err;
  EXPECT_EQ(summary_of(folder)["skipped_because"].size(), 1u);
  EXPECT_EQ(summary_of(folder)["scans_skipped"], 20);
  const ProgramResult all = process(folder, (folder / "drive.rawlog").string(), {"-v", "DEBUG"});
  EXPECT_EQ(std::count(all.err.begin(), all.err.end(), '\n'), 20) << all.err;
}

TEST(BadInput, EveryKindOfUnusableObservationIsNamed) {
  const auto folder = fresh_folder();
  mrpt::obs::CObservation2DRangeScan level;
  level.sensorLabel = "sick";
  level.resizeScanAndAssign(10, 1.0F, true);
  Cloud none;
  none.sensorLabel = "front";
  const std::string bytes =
      stored(none) + stored(level) + stored(level) + stored(cloud_of({{0, 0, 0}}));
  const ProgramResult result = process_bytes(folder, bytes);
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_TRUE(contains(result.err, "entry 0: mrpt::obs::CObservationPointCloud 'front'"));
  EXPECT_TRUE(contains(result.err, "entry 1: mrpt::obs::CObservation2DRangeScan 'sick'"));
  EXPECT_FALSE(contains(result.err, "entry 2:")) << "the same again";
  EXPECT_TRUE(contains(result.err, "entry 1: and 1 more of this kind"));
  EXPECT_TRUE(contains(result.err, "entry 3: " + kCloud));
  EXPECT_TRUE(contains(result.err, "error: no scan was described\n")) << result.err;
}

TEST(BadInput, ScanWithoutPose) {
  const auto folder = fresh_folder();
  // Scans at 1000.0, 1000.1 and 1000.2 s.
  const std::string poses =
      write_file(folder / "poses.tum", "999.9 0 0 0 0 0 0 1\n1000.15 1 0 0 0 0 0 1\n");
  const ProgramResult result = process_bytes(folder, drive_bytes(3), {"--poses", poses});
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_TRUE(contains(
      result.err, "drive.rawlog: entry 2: " + poses + " has no pose for its time 1000.200000 s"))
      << result.err;
  EXPECT_FALSE(contains(result.err, "entry 1")) << result.err;
  expect_tables_of(folder, 3);
}

TEST(BadInput, DamagedPosesAreRefusedWithFileAndLine) {
  const auto folder = fresh_folder();
  const std::string poses =
      write_file(folder / "poses.tum", "999.9 0 0 0 0 0 0 1\n1000.15 1 0 zero 0 0 0 1\n");
  const ProgramResult result = process_bytes(folder, drive_bytes(1), {"--poses", poses});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(contains(result.err, "error: " + poses + ":2")) << result.err;
  EXPECT_FALSE(exists(folder / "out"));
}

TEST(BadInput, ExternalFilesMissing) {
  const auto folder = fresh_folder();
  std::string bytes = stored(drive_scan(0));
  for (int k = 0; k < 5; ++k) {
    Cloud cloud;
    cloud.sensorLabel = "lidar";
    cloud.setAsExternalStorage("cloud_" + std::to_string(k) + ".bin",
                               Cloud::ExternalStorageFormat::KittiBinFile);
    bytes += stored(cloud);
  }
  const ProgramResult result = process_bytes(folder, bytes);
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_TRUE(contains(result.err,
                       "drive.rawlog: entry 1: mrpt::obs::CObservationPointCloud 'lidar': "
                       "external file '"))
      << result.err;
  EXPECT_TRUE(contains(result.err, "cloud_0.bin' does not exist")) << result.err;
  expect_tables_of(folder, 1);
  EXPECT_EQ(summary_of(folder)["skipped_because"].size(), 1u);
  EXPECT_EQ(summary_of(folder)["scans_skipped"], 5);
}

TEST(BadInput, UnwritableOutputFolder) {
  const auto folder = fresh_folder();
  const std::string input = write_file(folder / "drive.rawlog", drive_bytes(1));
  const std::string below_a_file = input + "/out";
  const ProgramResult result = terrain_rawlog(folder, {"process", input, "-o", below_a_file});
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_EQ(result.err, "error: " + below_a_file + ": cannot be made: Not a directory\n");
}

TEST(BadInput, FullDiskKeepsTheResultsOfAnEarlierRun) {
  if (!exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  const auto folder = fresh_folder();
  ASSERT_EQ(process_bytes(folder, drive_bytes(2)).exit_code, 0);
  std::filesystem::create_symlink("/dev/full", folder / "out" / "clusters.csv.part");
  const ProgramResult result = process_bytes(folder, drive_bytes(3));
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_TRUE(contains(result.err, "cannot be written")) << result.err;
  EXPECT_EQ(read_csv(folder / "out" / "clusters.csv").size(), 2u);
}

TEST(BadInput, ConfigurationWithATypo) {
  const auto folder = fresh_folder();
  const std::string config =
      write_file(folder / "mine.ini", "[ground]\nt_dif = 0.1\n[slope]\ninlier_distance = -3\n");
  const ProgramResult result = process_bytes(folder, drive_bytes(1), {"-c", config});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(contains(result.err, config + ": [ground] t_dif = 0.1: unknown key"));
  EXPECT_TRUE(contains(result.err, "did you mean `t_diff`")) << result.err;
  EXPECT_TRUE(contains(result.err, config + ": [slope] inlier_distance = -3: must be within"))
      << "all problems at once: " << result.err;
  EXPECT_FALSE(exists(folder / "out"));
}

TEST(BadInput, ConfigurationWhoseValuesDoNotGoTogether) {
  const auto folder = fresh_folder();
  const std::string config = write_file(folder / "mine.ini",
                                        "[classes]\nslope_min_deg = 50\nslope_max_deg = 45\n"
                                        "[input]\nmin_range = 20\nmax_range = 20\n"
                                        "[grid]\nlength = 1000\nwidth = 1000\ncell_size = 0.05\n"
                                        "[ground_plane]\nrange = 1000\ncell_size = 0.05\n");
  const ProgramResult result = process_bytes(folder, drive_bytes(1), {"-c", config});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.err,
            "error: " + config +
                ": [classes] slope_min_deg = 50: must be at most slope_max_deg = 45\n" + config +
                ": [input] min_range = 20: must be less than max_range = 20\n" + config +
                ": [grid] cell_size = 0.05: makes 4e+08 cells, must be at most 1e+08\n" + config +
                ": [ground_plane] cell_size = 0.05: makes 1.6e+09 cells, must be at most "
                "1e+08\n");
  const ProgramResult set = process_bytes(folder, drive_bytes(1), {"--set", "input.max_range=0.2"});
  EXPECT_EQ(set.exit_code, 2);
  EXPECT_EQ(set.err, "error: --set: [input] min_range = 0.3: must be less than max_range = 0.2\n");
  EXPECT_EQ(process_bytes(folder, drive_bytes(1), {"--set", "classes.slope_min_deg=45"}).exit_code,
            0)
      << "equal bounds are permitted";
}

}  // namespace
}  // namespace mrpt_terrain::test
