// SPDX-License-Identifier: BSD-3-Clause
// `terrain-rawlog label`: a label per point, in the order and number of the input.
#include <sys/stat.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

#include "mrpt_terrain/io/label_file.h"
#include "scans.h"

namespace mrpt_terrain::test {
namespace {

using Labels = std::vector<std::uint32_t>;
using Names = std::vector<std::string>;
namespace fs = std::filesystem;
using std::filesystem::exists;

constexpr std::uint32_t kGround = 40;
constexpr std::uint32_t kObstacle = 50 | 3U << 16;
constexpr std::uint32_t kPothole = 52 | 2U << 16;

/// `terrain-rawlog label INPUTS -o FOLDER/labels ...`
ProgramResult label(const fs::path& folder, Names arguments) {
  arguments.insert(arguments.begin(), {"label", "-o", (folder / "labels").string()});
  return terrain_rawlog(folder, std::move(arguments));
}

Labels labels_of(const fs::path& folder, const std::string& name) {
  const std::string file = (folder / "labels" / name).string();
  return exists(file) ? io::read_labels(file) : Labels();
}

/// Points and what their labels have to be; 1 where the method may decide either way.
struct KnownWorld {
  PointList points;
  Labels expected;

  void add(const std::array<float, 3>& point, std::uint32_t label) {
    points.push_back(point);
    expected.push_back(label);
  }
};
constexpr std::uint32_t kEither = 1;

/// Whether a place lies in the rectangle from (x, y) on, of 0.5 m x 0.5 m, made larger by `more`.
bool within(const std::array<float, 3>& p, float x, float y, float more) {
  return p[0] > x - more && p[0] < x + 0.5F + more && p[1] > y - more && p[1] < y + 0.5F + more;
}

/// Level ground with a block and a hole; zero returns, NaN, points that are too close or outside of
/// the map come before, between and behind. Cells are 5 cm wide: one of them at an edge may hold
/// points of both heights, and eq. (2) compares it with its neighbours.
KnownWorld known_world() {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  KnownWorld world;
  world.add({0, 0, 0}, 0);
  std::size_t k = 0;
  for (auto p : ground_with_block(0.3F)) {
    if (within(p, -1.5F, -1.0F, 0.001F)) p[2] = -0.3F;
    const bool on_block = within(p, 1.0F, 0.5F, -0.11F), in_hole = within(p, -1.5F, -1.0F, -0.11F);
    const bool near = within(p, 1.0F, 0.5F, 0.11F) || within(p, -1.5F, -1.0F, 0.11F);
    const bool too_close = std::hypot(p[0], p[1], p[2]) < 0.31F;
    const bool at_map_edge = std::max(std::abs(p[0]), std::abs(p[1])) > 2.3F;
    world.add(p, too_close || at_map_edge ? kEither
                 : on_block               ? kObstacle
                 : in_hole                ? kPothole
                 : near                   ? kEither
                                          : kGround);
    if (++k % 7 == 0) world.add({0, 0, 0}, 0);
    if (k % 31 == 0) world.add({kNan, 1, 0}, 0);
    if (k % 101 == 0) world.add({0.1F, 0, 0}, 0);
    if (k % 103 == 0) world.add({50, 0, 0}, 0);
  }
  world.add({kNan, kNan, kNan}, 0);
  return world;
}

void expect_labels(const Labels& labels, const KnownWorld& world) {
  ASSERT_EQ(labels.size(), world.points.size());
  std::size_t wrong = 0, ground = 0, obstacle = 0, pothole = 0;
  for (std::size_t k = 0; k < labels.size(); ++k) {
    if (world.expected[k] == kEither) continue;
    wrong += labels[k] != world.expected[k] ? 1 : 0;
    ground += labels[k] == kGround ? 1 : 0;
    obstacle += labels[k] == kObstacle ? 1 : 0;
    pothole += labels[k] == kPothole ? 1 : 0;
  }
  EXPECT_EQ(wrong, 0U);
  EXPECT_GT(ground, 1000U);
  EXPECT_GT(obstacle, 30U);
  EXPECT_GT(pothole, 30U);
}

TEST(Label, OneLabelPerPointInTheOrderOfTheFile) {
  const auto folder = fresh_folder();
  const KnownWorld world = known_world();
  const std::string file = write_file(folder / "000104.bin", kitti_bytes(world.points));
  const ProgramResult result = label(folder, {file});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  expect_labels(labels_of(folder, "000104.label"), world);
  EXPECT_EQ(files_ending_in(folder / "labels", ""), (Names{"000104.label", "params.ini"}));
  EXPECT_TRUE(contains(result.out, "1 scan labelled in ")) << result.out;
  EXPECT_TRUE(contains(result.out, " s: " + (folder / "labels" / "000104.label").string() + "\n"));
}

TEST(Label, ARawlogIsLabelledInTheOrderOfItsPoints) {
  const auto folder = fresh_folder();
  const KnownWorld world = known_world();
  const std::string file =
      write_file(folder / "drive.rawlog", stored(drive_scan(0)) + stored(cloud_of(world.points)));
  const ProgramResult result = label(folder, {file});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(labels_of(folder, "000000.label").size(), ground_with_block(0.3F).size());
  expect_labels(labels_of(folder, "000001.label"), world);
  EXPECT_TRUE(contains(result.out, "000000.label to 000001.label\n")) << result.out;
}

TEST(Label, CountsInTheReportAddUp) {
  const auto folder = fresh_folder();
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const std::string file = write_file(folder / "a.bin", kitti_bytes({{0, 0, 0},
                                                                     {1, 1, 0},
                                                                     {0, 0, 0},
                                                                     {kNan, 0, 0},
                                                                     {0.1F, 0, 0},
                                                                     {60, 0, 0},
                                                                     {1, 0, 40},
                                                                     {300, 0, 0}}));
  const ProgramResult result = label(folder, {file});
  EXPECT_TRUE(contains(result.out,
                       "\n8 points: 1 ground (40), 0 above (50), 0 below (52), 7 unknown (0)\n"
                       "unknown: 2 without return, 2 out of range, 1 not finite, 1 too high, 1 "
                       "outside map\n"))
      << result.out << result.err;
}

/// Three scans seen by a sensor 0.8 m above the ground, in FOLDER/set/velodyne.
std::string kitti_set(const fs::path& folder) {
  fs::create_directories(folder / "set" / "velodyne");
  for (const int k : {7, 8, 12}) {
    KnownWorld world = known_world();
    for (std::size_t i = 0; i < world.points.size(); ++i) {
      const bool is_return = world.expected[i] != 0;
      if (is_return) world.points[i][2] -= 0.8F + 0.01F * static_cast<float>(k);
    }
    const std::string name = k < 10 ? "00000" + std::to_string(k) : "0000" + std::to_string(k);
    write_file(folder / "set" / "velodyne" / (name + ".bin"), kitti_bytes(world.points));
  }
  return (folder / "set").string();
}

TEST(Label, FoldersKeepTheNamesOfTheirScans) {
  const auto folder = fresh_folder();
  const std::string set = kitti_set(folder);
  const Names pose = {"--sensor-pose", "0 0 0.88"};
  ASSERT_EQ(label(folder, {set, pose[0], pose[1]}).exit_code, 0);
  EXPECT_EQ(files_ending_in(folder / "labels", ".label"),
            (Names{"000007.label", "000008.label", "000012.label"}));
  expect_labels(labels_of(folder, "000008.label"), known_world());
  fs::remove_all(folder / "labels");
  ASSERT_EQ(
      label(folder, {set, pose[0], pose[1], "--from-index", "1", "--only-first-n", "1"}).exit_code,
      0);
  EXPECT_EQ(files_ending_in(folder / "labels", ".label"), Names{"000008.label"});
  fs::remove_all(folder / "labels");
  ASSERT_EQ(label(folder, {set + "/velodyne", pose[0], pose[1], "--to-index", "0"}).exit_code, 0);
  EXPECT_EQ(files_ending_in(folder / "labels", ".label"), Names{"000007.label"});
  fs::remove_all(folder / "labels");
  const ProgramResult none = label(folder, {set, "--from-index", "3"});
  EXPECT_EQ(none.exit_code, 4);
  EXPECT_EQ(none.err, "error: no scan was labelled\n  no input has an entry 3 (--from-index)\n");
  EXPECT_FALSE(exists(folder / "labels"));
}

TEST(Label, TheSameAsThroughARawlog) {
  const auto folder = fresh_folder();
  const std::string set = kitti_set(folder), rawlog = (folder / "set.rawlog").string();
  write_file(folder / "set" / "poses.tum", "0 0 0 0 0 0 0 1\n0.1 1 0 0 0 0 0 1\n1 9 0 0 0 0 0 1\n");
  ASSERT_EQ(label(folder, {set, "--sensor-pose", "0 0 0.88"}).exit_code, 0);
  fs::rename(folder / "labels", folder / "direct");
  ASSERT_EQ(
      terrain_rawlog(folder, {"import", set, "-o", rawlog, "--sensor-pose", "0 0 0.88"}).exit_code,
      0);
  ASSERT_EQ(label(folder, {rawlog}).exit_code, 0);
  const Names stems = {"000007", "000008", "000012"};
  for (std::size_t k = 0; k < stems.size(); ++k) {
    const std::string direct = read_file(folder / "direct" / (stems[k] + ".label"));
    EXPECT_EQ(direct.size(), 4 * known_world().points.size());
    EXPECT_EQ(direct, read_file(folder / "labels" / ("00000" + std::to_string(k) + ".label")));
  }
}

TEST(Label, SettingsAndConfigurationAreThoseOfProcess) {
  const auto folder = fresh_folder();
  const std::string file = write_file(folder / "a.bin", kitti_bytes(known_world().points));
  ASSERT_EQ(label(folder, {file}).exit_code, 0);
  const Labels before = labels_of(folder, "a.label");
  ASSERT_EQ(
      label(folder, {file, "--set", "ground.t_high=0.5", "--set", "ground.t_diff=0.5"}).exit_code,
      0);
  const Labels after = labels_of(folder, "a.label");
  EXPECT_NE(before, after);
  const std::string config =
      write_file(folder / "again.ini", read_file(folder / "labels" / "params.ini"));
  ASSERT_EQ(label(folder, {file}).exit_code, 0);
  EXPECT_EQ(labels_of(folder, "a.label"), before);
  ASSERT_EQ(label(folder, {file, "-c", config}).exit_code, 0);
  EXPECT_EQ(labels_of(folder, "a.label"), after);
}

TEST(Label, FindsTheGround) {
  const auto folder = fresh_folder();
  const ProgramResult result =
      label(folder, {kitti_set(folder) + "/velodyne/000008.bin", "--find-ground"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "000008.bin: ground found at z = -0.88 m")) << result.out;
  const Labels labels = labels_of(folder, "000008.label");
  EXPECT_GT(std::count(labels.begin(), labels.end(), kGround), 10000);
}

TEST(Label, AScanWithoutAnyReturnGetsZeros) {
  const auto folder = fresh_folder();
  const PointList nothing(5, {0, 0, 0});
  const std::string file = write_file(folder / "b.bin", kitti_bytes(nothing));
  const ProgramResult result =
      label(folder, {file, write_file(folder / "c.bin", kitti_bytes(known_world().points))});
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_EQ(labels_of(folder, "b.label"), Labels(5, 0));
  expect_labels(labels_of(folder, "c.label"), known_world());
  EXPECT_TRUE(contains(result.err, file + ": mrpt::obs::CObservationPointCloud 'lidar' holds no "
                                          "usable point: 5 without return"))
      << result.err;
  EXPECT_TRUE(contains(result.out, "2 scans labelled in "));
}

TEST(Label, ScansWithoutReturnsCountInARawlog) {
  const auto folder = fresh_folder();
  const std::string file = write_file(
      folder / "drive.rawlog",
      stored(drive_scan(0)) + stored(cloud_of(PointList(3, {0, 0, 0}))) + stored(drive_scan(1)));
  EXPECT_EQ(label(folder, {file}).exit_code, 4);
  EXPECT_EQ(files_ending_in(folder / "labels", ".label"),
            (Names{"000000.label", "000001.label", "000002.label"}));
  EXPECT_EQ(labels_of(folder, "000001.label"), Labels(3, 0));
}

TEST(Label, PacketsAreLabelledReturnByReturn) {
  const auto rawlog = mrpt_datasets() / "test_velodyne_VLP16.rawlog";
  if (!exists(rawlog)) GTEST_SKIP() << rawlog << " is not there";
  const auto folder = fresh_folder();
  ASSERT_EQ(label(folder, {rawlog.string()}).exit_code, 0);
  const Labels labels = labels_of(folder, "000000.label");
  EXPECT_EQ(labels.size(), 75U * 12 * 32) << "packets, blocks, returns";
}

struct BadScan {
  std::string bytes;
  std::string reason;
};

TEST(Label, ADamagedScanIsNamedAndTheOthersAreLabelled) {
  const auto folder = fresh_folder();
  const std::string set = kitti_set(folder);
  const fs::path bad = folder / "set" / "velodyne" / "000008.bin";
  const std::string whole = read_file(bad);
  for (const BadScan& scan :
       {BadScan{whole + "x", ": byte " + std::to_string(whole.size()) + ": cut off: "},
        BadScan{"", ": is empty\n"}}) {
    write_file(bad, scan.bytes);
    fs::remove_all(folder / "labels");
    const ProgramResult result = label(folder, {set, "--sensor-pose", "0 0 0.88"});
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_TRUE(contains(result.err, "error: " + bad.string() + scan.reason)) << result.err;
    EXPECT_EQ(files_ending_in(folder / "labels", ".label"),
              (Names{"000007.label", "000012.label"}));
  }
}

/// Labels and expects an exit code, a message, and that no folder of labels appears.
void expect_refused(const fs::path& folder, const Names& arguments, int exit_code,
                    const std::string& message) {
  const ProgramResult result = label(folder, arguments);
  EXPECT_EQ(result.exit_code, exit_code) << result.err;
  EXPECT_TRUE(contains(result.err, message)) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_FALSE(exists(folder / "labels"));
}

TEST(Label, InputsThatCannotBeRead) {
  const auto folder = fresh_folder();
  const std::string missing = (folder / "none.bin").string();
  expect_refused(folder, {missing}, 3, "error: " + missing + ": no such file\n");
  const std::string cut = write_file(folder / "cut.bin", std::string(17, 'x'));
  expect_refused(folder, {cut}, 3, "error: " + cut + ": byte 16: cut off: 17 bytes");
  fs::create_directories(folder / "set");
  expect_refused(folder, {(folder / "set").string()}, 3, "/set: is no KITTI folder");
  const std::string pipe = (folder / "pipe.bin").string();
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  expect_refused(folder, {pipe}, 3, "error: " + pipe + ": is a pipe or a device, not a file\n");
  const std::string text = write_file(folder / "a.rawlog", "Dear diary\n");
  expect_refused(folder, {text}, 3, "a.rawlog: is neither a rawlog nor a simple map");
}

TEST(Label, InputsThatDoNotGoTogether) {
  const auto folder = fresh_folder();
  const std::string set = kitti_set(folder);
  const std::string scan = set + "/velodyne/000007.bin";
  const std::string rawlog = write_file(folder / "drive.rawlog", drive_bytes(1));
  expect_refused(folder, {set, rawlog}, 2,
                 "error: " + set + " and " + rawlog + ": .bin files and recordings in one run");
  expect_refused(folder, {set, scan}, 2,
                 "error: " + scan + " and " + scan + ": both would be labelled in 000007.label");
  const std::string poses = write_file(folder / "poses.tum", "0 0 0 0 0 0 0 1\n");
  expect_refused(folder, {set, "--poses", poses}, 2, "error: --poses: .bin files hold no times");
}

TEST(Label, DoesNotReplaceTheTruth) {
  const auto folder = fresh_folder();
  const std::string set = kitti_set(folder);
  fs::create_directories(folder / "labels");
  const std::string truth = write_file(folder / "labels" / "000007.label", "true");
  const ProgramResult result = label(folder, {set});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(contains(result.err, "error: --output-dir: " + (folder / "labels").string() +
                                       " holds label files of another origin"))
      << result.err;
  EXPECT_EQ(read_file(truth), "true");
  fs::remove(truth);
  EXPECT_EQ(label(folder, {set, "--sensor-pose", "0 0 0.88"}).exit_code, 0);
  EXPECT_EQ(label(folder, {set, "--sensor-pose", "0 0 0.88"}).exit_code, 0) << "its own files";
}

TEST(Label, UnwritableOutput) {
  const auto folder = fresh_folder();
  const std::string set = kitti_set(folder);
  const std::string taken = write_file(folder / "labels", "");
  const ProgramResult result = label(folder, {set});
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_TRUE(contains(result.err, "error: " + taken + ": cannot be made")) << result.err;
}

TEST(Label, QuietPrintsNothing) {
  const auto folder = fresh_folder();
  const ProgramResult result =
      label(folder, {kitti_set(folder), "--sensor-pose", "0 0 0.88", "-q"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out + result.err, "");
}

TEST(Label, InterruptionLeavesWholeFiles) {
  const auto folder = fresh_folder();
  constexpr std::size_t kScans = 2000;
  const std::string bytes = kitti_bytes(known_world().points);
  fs::create_directories(folder / "set");
  const std::string first = write_file(folder / "set" / "0.bin", bytes);
  for (std::size_t k = 1; k < kScans; ++k) {
    fs::create_hard_link(first, folder / "set" / (std::to_string(k) + ".bin"));
  }
  Program program(folder, {TERRAIN_RAWLOG, "label", (folder / "set").string(), "-o",
                           (folder / "labels").string()});
  for (int k = 0; k < 1000 && !exists(folder / "labels" / "1.label"); ++k) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  program.send(SIGINT);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.exit_code, 130);
  EXPECT_EQ(result.err, "warning: interrupted; the scans up to here are labelled\n");
  EXPECT_EQ(files_ending_in(folder / "labels", ".part"), Names());
  const Names files = files_ending_in(folder / "labels", ".label");
  EXPECT_GE(files.size(), 1U);
  EXPECT_LT(files.size(), kScans);
  for (const std::string& file : files) {
    EXPECT_EQ(fs::file_size(folder / "labels" / file), bytes.size() / 4) << file;
  }
}

/// Ground and obstacles of a scan of RELLIS by the classes that score_ground.py names.
struct Score {
  std::size_t ground = 0, ground_found = 0, obstacles = 0, obstacles_found = 0;
};

Score score_by_hand(const fs::path& set, const Labels& labels) {
  const Labels truth = io::read_labels((set / "labels" / "000104.label").string(), labels.size());
  const std::string bytes = read_file(set / "velodyne" / "000104.bin");
  const std::string no_return(12, '\0');
  const std::vector<std::uint16_t> ground = {1, 3, 6, 10, 23, 31, 33, 34};
  const std::vector<std::uint16_t> obstacles = {4, 5, 8, 9, 12, 15, 17, 18, 19, 27};
  const auto is_one_of = [](std::uint32_t label, const std::vector<std::uint16_t>& classes) {
    return std::count(classes.begin(), classes.end(), io::label_class(label)) != 0;
  };
  Score score;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    if (bytes.compare(16 * k, 12, no_return) == 0) {
      EXPECT_EQ(labels[k], 0U) << "no return in slot " << k;
      continue;
    }
    const std::uint16_t found = io::label_class(labels[k]);
    if (is_one_of(truth[k], ground)) {
      ++score.ground;
      score.ground_found += found == 40 ? 1 : 0;
    } else if (is_one_of(truth[k], obstacles)) {
      ++score.obstacles;
      score.obstacles_found += found == 50 || found == 52 ? 1 : 0;
    }
  }
  return score;
}

TEST(Label, TheScorerAgreesWithACountByHand) {
  const fs::path set = data_folder() / "rellis_104";
  const fs::path scorer = data_folder() / ".." / "tools" / "score_ground.py";
  const fs::path python = "/usr/bin/python3";
  for (const fs::path& needed : {set, scorer, python}) {
    if (!exists(needed)) GTEST_SKIP() << needed << " is not there";
  }
  const auto folder = fresh_folder();
  const std::string config = MRPT_TERRAIN_SOURCE_DIR "/params/paper_outdoor.ini";
  const ProgramResult result =
      label(folder, {set.string(), "-c", config, "--sensor-pose", "0 0 1.31"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Labels labels = labels_of(folder, "000104.label");
  ASSERT_EQ(labels.size(), 131072U);
  const Score hand = score_by_hand(set, labels);
  EXPECT_GT(static_cast<double>(hand.ground_found), 0.3 * static_cast<double>(hand.ground));
  const ProgramResult scored =
      Program(folder, {python.string(), scorer.string(), "--classes", "rellis", "--truth",
                       (set / "labels" / "000104.label").string(), "--pred",
                       (folder / "labels" / "000104.label").string(), "--points",
                       (set / "velodyne" / "000104.bin").string()})
          .wait();
  ASSERT_EQ(scored.exit_code, 0) << scored.err;
  const auto percent = [](std::size_t part, std::size_t of) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.2f",
                  100.0 * static_cast<double>(part) / static_cast<double>(of));
    return std::string(text.data());
  };
  EXPECT_TRUE(contains(scored.out, " R " + percent(hand.ground_found, hand.ground) + " "))
      << scored.out;
  EXPECT_TRUE(
      contains(scored.out, "obstacle TPR " + percent(hand.obstacles_found, hand.obstacles) + " "))
      << scored.out;
  EXPECT_TRUE(contains(scored.out, "(ground " + std::to_string(hand.ground) + ", obstacle " +
                                       std::to_string(hand.obstacles) + ")"))
      << scored.out;
}

}  // namespace
}  // namespace mrpt_terrain::test
