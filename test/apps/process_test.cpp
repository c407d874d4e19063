// SPDX-License-Identifier: BSD-3-Clause
// What `terrain-rawlog process` writes and prints.
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include <chrono>
#include <thread>

#include "scans.h"

namespace mrpt_terrain::test {
namespace {

using std::filesystem::exists;
using Names = std::vector<std::string>;

std::size_t sum_of_column(const std::filesystem::path& csv, const std::string& name) {
  std::size_t sum = 0;
  for (const auto& row : read_csv(csv)) sum += std::stoul(row.at(name));
  return sum;
}

/// The numbers of the scans that have rows.
Names scans_of(const std::filesystem::path& folder, const std::string& column) {
  Names entries;
  for (const auto& row : read_csv(folder / "out" / "scans.csv")) entries.push_back(row.at(column));
  return entries;
}

TEST(Process, TablesAgreeWithEachOther) {
  const auto folder = fresh_folder();
  const ProgramResult result = process_bytes(folder, drive_bytes(5));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  expect_tables_of(folder, 5);
  const auto out = folder / "out";
  const auto summary = summary_of(folder);
  EXPECT_EQ(summary["points"], sum_of_column(out / "scans.csv", "points"));
  std::map<std::string, std::size_t> clusters;
  for (const auto& row : read_csv(out / "clusters.csv")) ++clusters[row.at("class")];
  for (const std::string name : {"obstacle", "slope", "pothole", "other"}) {
    EXPECT_EQ(summary["clusters"][name], clusters[name]) << name;
    EXPECT_EQ(sum_of_column(out / "scans.csv", "clusters_" + name), clusters[name]) << name;
  }
  for (const auto& row : read_csv(out / "clusters.csv")) {
    EXPECT_NEAR(std::stod(row.at("x")), 1.25, 0.03);
    EXPECT_NEAR(std::stod(row.at("y")), 0.75, 0.03);
  }
}

TEST(Process, LabelledCloudHoldsThePointsOfItsScan) {
  const auto folder = fresh_folder();
  ASSERT_EQ(process_bytes(folder, drive_bytes(1)).exit_code, 0);
  const auto row = read_csv(folder / "out" / "scans.csv").at(0);
  const std::string ply = read_file(folder / "out" / "scan_000000.ply");
  EXPECT_TRUE(contains(ply, "element vertex " + row.at("points") + "\n")) << ply.substr(0, 300);
  const std::string png = read_file(folder / "out" / "scan_000000.png");
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_EQ(png.substr(png.size() - 8, 4), "IEND");
  EXPECT_TRUE(exists(folder / "out" / "scan_000000.3Dscene"));
}

TEST(Process, DrawsTheFirstTheWorstAndTheLastScan) {
  const auto folder = fresh_folder();
  std::string bytes = drive_bytes(2);
  // A second block: fewer points are ground.
  PointList worst = ground_with_block(0.3F);
  for (auto& point : worst) {
    if (point[0] < -1.0F) point[2] = 0.4F;
  }
  bytes += stored(cloud_of(worst, 1000.5)) + stored(drive_scan(6)) + stored(drive_scan(7));
  const ProgramResult result = process_bytes(folder, bytes);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  for (const std::string ending : {".png", ".3Dscene", ".ply"}) {
    EXPECT_EQ(files_ending_in(folder / "out", ending),
              (Names{"scan_000000" + ending, "scan_000002" + ending, "scan_000004" + ending}));
  }
  EXPECT_EQ(summary_of(folder)["worst_scan"]["scan"], 2);
  for (const std::string line :
       {"first scan: ", "worst scan: ", "last scan: ", "5 scans described in "}) {
    EXPECT_TRUE(contains(result.out, "\n" + line)) << line << "\n" << result.out;
  }
}

TEST(Process, DrawsEveryNthScan) {
  const auto folder = fresh_folder();
  ASSERT_EQ(process_bytes(folder, drive_bytes(5), {"--every", "2"}).exit_code, 0);
  EXPECT_EQ(files_ending_in(folder / "out", ".png"),
            (Names{"scan_000000.png", "scan_000002.png", "scan_000004.png"}));
}

TEST(Process, TakesTheEntriesThatWereAskedFor) {
  const auto folder = fresh_folder();
  ASSERT_EQ(
      process_bytes(folder, drive_bytes(6), {"--from-index", "2", "--to-index", "4"}).exit_code, 0);
  EXPECT_EQ(scans_of(folder, "entry"), (Names{"2", "3", "4"}));
  EXPECT_EQ(scans_of(folder, "scan"), (Names{"0", "1", "2"}));
  ASSERT_EQ(
      process_bytes(folder, drive_bytes(6), {"--from-index", "1", "--only-first-n", "2"}).exit_code,
      0);
  EXPECT_EQ(scans_of(folder, "entry"), (Names{"1", "2"}));
}

TEST(Process, SaysThatTheFirstEntryIsBehindTheLast) {
  const auto folder = fresh_folder();
  const ProgramResult result = process_bytes(folder, drive_bytes(3), {"--from-index", "7"});
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_EQ(result.err,
            "error: no scan was described\n"
            "  --from-index is 7, the last entry of the inputs is 2\n");
}

TEST(Process, TakesTheSensorsThatWereAskedFor) {
  const auto folder = fresh_folder();
  Cloud front = drive_scan(0), rear = drive_scan(1);
  front.sensorLabel = "lidar_front";
  rear.sensorLabel = "lidar_rear";
  const std::string bytes = stored(front) + stored(rear) + stored(front);
  ASSERT_EQ(process_bytes(folder, bytes, {"--sensor-label", ".*_front"}).exit_code, 0);
  EXPECT_EQ(scans_of(folder, "sensor_label"), (Names{"lidar_front", "lidar_front"}));
  const ProgramResult part = process_bytes(folder, bytes, {"--sensor-label", "front"});
  EXPECT_EQ(part.exit_code, 4) << "the whole label must match";
  EXPECT_TRUE(contains(part.err, "3 x sensor label not asked for")) << part.err;
}

TEST(Process, SensorPoseReplacesThatOfTheObservations) {
  const auto folder = fresh_folder();
  // A sensor 0.8 m above the ground, turned to the left, whose rawlog does not know it.
  PointList seen = ground_with_block(0.3F);
  for (auto& point : seen) point = {point[1], -point[0], point[2] - 0.8F};
  const ProgramResult lost = process_bytes(folder, stored(cloud_of(seen)));
  EXPECT_TRUE(contains(lost.err, "hardly any ground at z = 0 of the robot frame")) << lost.err;
  for (const std::string pose : {"0 0 0.8 90 0 0", "[0, 0, 0.8, 90, 0, 0]"}) {
    const ProgramResult result =
        process_bytes(folder, stored(cloud_of(seen)), {"--sensor-pose", pose});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto clusters = read_csv(folder / "out" / "clusters.csv");
    ASSERT_EQ(clusters.size(), 1u) << pose;
    EXPECT_NEAR(std::stod(clusters[0].at("x")), 1.25, 0.03);
    EXPECT_NEAR(std::stod(clusters[0].at("y")), 0.75, 0.03);
    EXPECT_NEAR(std::stod(clusters[0].at("h_max")), 0.3, 1e-6);
  }
}

TEST(Process, FindsTheGround) {
  const auto folder = fresh_folder();
  PointList seen = ground_with_block(0.3F);
  for (auto& point : seen) point[2] -= 0.8F;
  const ProgramResult result = process_bytes(folder, stored(cloud_of(seen)), {"--find-ground"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "entry 0: ground found at z = -0.80 m of the robot frame"))
      << result.out;
  expect_tables_of(folder, 1);
}

TEST(Process, PosesOfAFileAreUsed) {
  const auto folder = fresh_folder();
  const std::string poses =
      write_file(folder / "poses.tum", "999.9 0 0 0 0 0 0 1\n1000.2 1 0 0 0 0 0 1\n");
  const ProgramResult result = process_bytes(folder, drive_bytes(2), {"--poses", poses});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expect_tables_of(folder, 2);
}

TEST(Process, ExternallyStoredCloudsAreFound) {
  const auto folder = fresh_folder();
  std::filesystem::create_directories(folder / "drive_Images");
  std::filesystem::create_directories(folder / "elsewhere");
  std::vector<float> values;
  for (const auto& point : ground_with_block(0.3F)) {
    values.insert(values.end(), {point[0], point[1], point[2], 0.5F});
  }
  write_file(folder / "elsewhere" / "cloud.bin",
             {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)});
  Cloud cloud;
  cloud.sensorLabel = "lidar";
  cloud.setAsExternalStorage("cloud.bin", Cloud::ExternalStorageFormat::KittiBinFile);
  EXPECT_EQ(process_bytes(folder, stored(cloud)).exit_code, 4) << "not yet where tools look";
  EXPECT_EQ(
      process_bytes(folder, stored(cloud), {"--externals-dir", (folder / "elsewhere").string()})
          .exit_code,
      0);
  expect_tables_of(folder, 1);
  std::filesystem::rename(folder / "elsewhere" / "cloud.bin", folder / "drive_Images/cloud.bin");
  EXPECT_EQ(process_bytes(folder, stored(cloud)).exit_code, 0);
  expect_tables_of(folder, 1);
  EXPECT_TRUE(exists(folder / "drive_Images/cloud.bin")) << "inputs stay";
}

TEST(Process, SimpleMapsAreInputToo) {
  const auto folder = fresh_folder();
  mrpt::maps::CSimpleMap map;
  for (int k = 0; k < 3; ++k) {
    mrpt::obs::CSensoryFrame frame;
    frame.insert(std::make_shared<Cloud>(drive_scan(k)));
    mrpt::poses::CPose3DPDFGaussian pose;
    pose.mean = mrpt::poses::CPose3D(k, 0, 0, 0, 0, 0);
    map.insert(pose, frame);
  }
  const std::string file = write_file(folder / "map.simplemap", gzip(stored(map)));
  const ProgramResult result = process(folder, file);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expect_tables_of(folder, 3);
}

TEST(Process, AMissingInputAmongOthersIsReportedAndTheOthersAreDescribed) {
  const auto folder = fresh_folder();
  const std::string first = write_file(folder / "a.rawlog", stored(drive_scan(0)));
  const std::string last = write_file(folder / "c.rawlog", stored(drive_scan(1)));
  const std::string missing = (folder / "b.rawlog").string();
  const ProgramResult result = process(folder, first, {missing, last});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.err, "error: " + missing + ": no such file\n");
  expect_tables_of(folder, 2);
  EXPECT_EQ(scans_of(folder, "file"), (Names{first, last}));
}

TEST(Process, QuietPrintsNothing) {
  const auto folder = fresh_folder();
  const ProgramResult result = process_bytes(folder, drive_bytes(2), {"-q"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out + result.err, "");
  expect_tables_of(folder, 2);
}

TEST(Process, DebugPrintsMilliseconds) {
  const auto folder = fresh_folder();
  const std::string bytes = drive_bytes(1);
  EXPECT_FALSE(contains(process_bytes(folder, bytes).out, "milliseconds"));
  EXPECT_TRUE(contains(process_bytes(folder, bytes, {"-v", "debug"}).out, "milliseconds: reading"));
}

TEST(Process, NoProgressBarOutsideOfATerminal) {
  const auto folder = fresh_folder();
  const ProgramResult result = process_bytes(folder, drive_bytes(3));
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(result.out.find_first_of("\r\033"), std::string::npos) << result.out;
}

TEST(Process, TheSameRunWritesTheSameBytes) {
  const auto folder = fresh_folder();
  const auto out = folder / "out";
  ASSERT_EQ(process_bytes(folder, drive_bytes(3)).exit_code, 0);
  const std::string clusters = read_file(out / "clusters.csv");
  const std::string ply = read_file(out / "scan_000002.ply");
  ASSERT_EQ(process_bytes(folder, drive_bytes(3)).exit_code, 0);
  EXPECT_EQ(read_file(out / "clusters.csv"), clusters);
  EXPECT_EQ(read_file(out / "scan_000002.ply"), ply);
}

TEST(Process, TheWrittenConfigurationRepeatsTheRun) {
  const auto folder = fresh_folder();
  const auto out = folder / "out";
  const std::string bytes = drive_bytes(2);
  ASSERT_EQ(process_bytes(folder, bytes).exit_code, 0);
  const std::string by_default = read_file(out / "clusters.csv");
  ASSERT_EQ(process_bytes(folder, bytes,
                          {"--set", "grid.cell_size=0.1", "--set", "slope.seed=7", "--set",
                           "classes.slope_max_deg=33.3"})
                .exit_code,
            0);
  const std::string clusters = read_file(out / "clusters.csv");
  const std::string params = read_file(out / "params.ini");
  ASSERT_NE(clusters, by_default);
  const std::string config = write_file(folder / "again.ini", params);
  ASSERT_EQ(process_bytes(folder, bytes, {"-c", config}).exit_code, 0);
  EXPECT_EQ(read_file(out / "clusters.csv"), clusters);
  EXPECT_EQ(read_file(out / "params.ini"), params);
}

/// Waits until a file has more than `bytes` bytes.
bool grows_beyond(const std::filesystem::path& file, std::size_t bytes) {
  for (int k = 0; k < 1000; ++k) {
    if (exists(file) && std::filesystem::file_size(file) > bytes) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

TEST(Process, InterruptionLeavesWholeFiles) {
  const auto folder = fresh_folder();
  constexpr std::size_t kScans = 400;
  std::string bytes;
  for (std::size_t k = 0; k < kScans / 4; ++k) bytes += drive_bytes(4);
  const std::string input = write_file(folder / "long.rawlog", bytes);
  const auto out = folder / "out";
  Program program(folder, {TERRAIN_RAWLOG, "process", input, "-o", out.string()});
  ASSERT_TRUE(grows_beyond(out / "clusters.csv.part", 1000));
  program.send(SIGINT);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.exit_code, 130);
  EXPECT_TRUE(contains(result.err, "warning: interrupted; the files hold the scans up to here"));
  EXPECT_EQ(files_ending_in(out, ".part"), Names());
  const std::size_t scans = scans_of(folder, "scan").size();
  EXPECT_GE(scans, 1u);
  EXPECT_LT(scans, kScans);
  EXPECT_EQ(read_csv(out / "clusters.csv").size(), scans);
  EXPECT_EQ(summary_of(folder)["scans_processed"], scans);
  EXPECT_GE(files_ending_in(out, ".png").size(), 2u) << "first and last scan";
}

TEST(Process, ResidentSizeStaysConstant) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers keep what was freed, so that the resident size says nothing";
#endif
  const auto folder = fresh_folder();
  std::string twenty;
  for (int k = 0; k < 5; ++k) twenty += drive_bytes(4);
  const ProgramResult first = process_bytes(folder, twenty);
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const ProgramResult all = process_bytes(folder, twenty + twenty + twenty);
  ASSERT_EQ(all.exit_code, 0) << all.err;
  EXPECT_EQ(summary_of(folder)["scans_processed"], 60);
  EXPECT_LT(static_cast<double>(all.max_resident_kib),
            1.05 * static_cast<double>(first.max_resident_kib));
}

}  // namespace
}  // namespace mrpt_terrain::test
