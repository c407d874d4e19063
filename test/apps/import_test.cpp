// SPDX-License-Identifier: BSD-3-Clause
// `terrain-rawlog import`, and that `process` takes what it makes.
#include "scans.h"

namespace mrpt_terrain::test {
namespace {

using std::filesystem::exists;

/// Three scans seen by a sensor 0.8 m above the ground, with poses and times.
std::string kitti_folder(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder / "set" / "velodyne");
  for (int k = 0; k < 3; ++k) {
    PointList seen = ground_with_block(0.3F + 0.01F * static_cast<float>(k));
    for (auto& point : seen) point[2] -= 0.8F;
    write_file(folder / "set" / "velodyne" / ("00000" + std::to_string(k) + ".bin"),
               kitti_bytes(seen));
  }
  write_file(folder / "set" / "times.txt", "0.0\n0.1\n0.2\n");
  write_file(folder / "set" / "poses.tum",
             "0 0 0 0.8 0 0 0 1\n0.1 1 0 0.8 0 0 0 1\n0.2 2 0 0.8 0 0 0 1\n");
  return (folder / "set").string();
}

std::string ply_text(const PointList& points) {
  std::ostringstream text;
  text << "ply\nformat ascii 1.0\nelement vertex " << points.size()
       << "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  for (const auto& point : points) text << point[0] << " " << point[1] << " " << point[2] << "\n";
  return text.str();
}

TEST(Import, KittiFolderIsProcessedLikeARawlog) {
  const auto folder = fresh_folder();
  const std::string rawlog = (folder / "kitti.rawlog").string();
  const ProgramResult result = terrain_rawlog(
      folder, {"import", kitti_folder(folder), "-o", rawlog, "--sensor-pose", "0 0 0.8"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_TRUE(contains(result.out, rawlog + ": 3 scans, 43 923 points, 3 with a pose, 0 with "
                                            "labels\n"))
      << result.out;
  EXPECT_TRUE(contains(result.out, "poses: " + (folder / "kitti.tum").string() + "\n"));
  EXPECT_EQ(process(folder, rawlog).exit_code, 0);
  expect_tables_of(folder, 3);
  EXPECT_EQ(process(folder, rawlog, {"--poses", (folder / "kitti.tum").string()}).exit_code, 0);
  const ProgramResult info = terrain_rawlog(folder, {"info", rawlog});
  EXPECT_TRUE(contains(info.out, "robot poses: 3 from CObservationRobotPose")) << info.out;
}

TEST(Import, PlyFilesBecomeScans) {
  const auto folder = fresh_folder();
  const std::string rawlog = (folder / "two.rawlog").string();
  const ProgramResult result = terrain_rawlog(
      folder, {"import", write_file(folder / "a.PLY", ply_text(ground_with_block(0.3F))),
               write_file(folder / "b.ply", ply_text(ground_with_block(0.31F))), "-o", rawlog,
               "--sensor-label", "survey"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  ASSERT_EQ(process(folder, rawlog, {"--sensor-label", "survey"}).exit_code, 0);
  expect_tables_of(folder, 2);
}

TEST(Import, OnlyTheFirstScans) {
  const auto folder = fresh_folder();
  const std::string rawlog = (folder / "kitti.rawlog").string();
  const ProgramResult result = terrain_rawlog(
      folder, {"import", kitti_folder(folder), "-o", rawlog, "--only-first-n", "2", "-q"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out + result.err, "");
  EXPECT_TRUE(
      contains(terrain_rawlog(folder, {"info", rawlog}).out, "2 x mrpt::obs::CObservationP"));
}

/// Imports and expects an exit code, a message, and that no rawlog appears.
void expect_refused(const std::filesystem::path& folder, std::vector<std::string> arguments,
                    int exit_code, const std::string& message) {
  arguments.insert(arguments.begin(), "import");
  const ProgramResult result = terrain_rawlog(folder, arguments);
  EXPECT_EQ(result.exit_code, exit_code) << result.err;
  EXPECT_TRUE(contains(result.err, message)) << result.err;
  EXPECT_EQ(files_ending_in(folder, ".rawlog"), std::vector<std::string>());
  EXPECT_EQ(files_ending_in(folder, ".part"), std::vector<std::string>());
}

TEST(Import, MissingInput) {
  const auto folder = fresh_folder();
  const std::string missing = (folder / "none").string();
  expect_refused(folder, {missing, "-o", (folder / "a.rawlog").string()}, 3,
                 "error: " + missing + ": no such file or folder\n");
}

TEST(Import, AFileOfAnotherKind) {
  const auto folder = fresh_folder();
  const std::string file = write_file(folder / "a.las", "LASF");
  expect_refused(folder, {file, "-o", (folder / "a.rawlog").string()}, 2,
                 "error: " + file + ": neither a folder (KITTI) nor a .pcd or .ply file");
}

TEST(Import, DamagedScanIsNamed) {
  const auto folder = fresh_folder();
  const std::string whole = ply_text(ground_with_block(0.3F));
  const std::string good = write_file(folder / "a.ply", whole);
  const std::string bad = write_file(folder / "b.ply", whole.substr(0, whole.size() / 2));
  expect_refused(folder, {good, bad, "-o", (folder / "a.rawlog").string()}, 3, "error: " + bad);
}

TEST(Import, FolderWithoutScans) {
  const auto folder = fresh_folder();
  std::filesystem::create_directories(folder / "set");
  expect_refused(folder, {(folder / "set").string(), "-o", (folder / "a.rawlog").string()}, 3,
                 "error: " + (folder / "set").string());
}

TEST(Import, UnwritableOutput) {
  const auto folder = fresh_folder();
  const std::string output = (folder / "no_folder" / "a.rawlog").string();
  expect_refused(folder, {kitti_folder(folder), "-o", output}, 5,
                 "error: " + output + ": cannot be written: No such file or directory\n");
}

TEST(Import, DoesNotReplaceItsInput) {
  const auto folder = fresh_folder();
  const std::string text = ply_text({{1, 2, 3}});
  const std::string file = write_file(folder / "a.ply", text);
  expect_refused(folder, {file, "-o", file}, 2, "--output: " + file + " is one of the inputs");
  EXPECT_EQ(read_file(file), text);
}

TEST(Import, WrongSensorPose) {
  const auto folder = fresh_folder();
  expect_refused(folder,
                 {kitti_folder(folder), "-o", (folder / "a.rawlog").string(), "--sensor-pose", "1"},
                 2, "error: --sensor-pose: \"1\" is no pose");
}

}  // namespace
}  // namespace mrpt_terrain::test
