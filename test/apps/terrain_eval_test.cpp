// SPDX-License-Identifier: BSD-3-Clause
// terrain-eval as a user starts it.
#include <cstdint>

#include "program.h"

namespace mrpt_terrain::test {
namespace {

namespace fs = std::filesystem;

ProgramResult terrain_eval(const fs::path& folder, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), TERRAIN_EVAL);
  return Program(folder, std::move(arguments)).wait();
}

const std::vector<std::string> kShort = {
    "worlds",  "-f", "potholes,ramps", "--seeds", "0:2",
    "--scans", "2",  "--sensor",       "vlp16",   "--approach"};

std::vector<std::string> with(std::vector<std::string> arguments,
                              const std::vector<std::string>& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

/// Value of a line of the CSV that begins so.
std::string value_of(const std::string& csv, const std::string& line) {
  const std::size_t at = csv.find("\n" + line + ",");
  if (at == std::string::npos) return "no " + line;
  const std::size_t from = at + line.size() + 2;
  return csv.substr(from, csv.find(',', from) - from);
}

TEST(TerrainEval, TablesAndCsvDoNotDependOnTheThreads) {
  const fs::path folder = fresh_folder();
  std::vector<std::string> csv, lists;
  for (const std::string threads : {"1", "3"}) {
    const ProgramResult result =
        terrain_eval(folder, with(kShort, {"-j", threads, "--csv", (folder / "a.csv").string(),
                                           "--false-potholes", (folder / "false.csv").string()}));
    ASSERT_EQ(result.exit_code, 0) << result.err;
    for (const std::string part : {"Support of points", "Clusters at IoU 0.5", "Classes in pooled",
                                   "Potholes and ditches", "potholes", "ramps", "pooled"}) {
      EXPECT_TRUE(contains(result.out, part)) << part;
    }
    csv.push_back(read_file(folder / "a.csv"));
    lists.push_back(read_file(folder / "false.csv"));
  }
  EXPECT_EQ(csv[0], csv[1]);
  EXPECT_EQ(lists[0], lists[1]);
  EXPECT_EQ(value_of(csv[0], "pooled,scans,all"), "8");
  EXPECT_FALSE(contains(csv[0], "nan"));
}

TEST(TerrainEval, DisturbancesAndParametersChangeTheResult) {
  const fs::path folder = fresh_folder();
  const auto iou = [&folder](const std::vector<std::string>& more) {
    const std::string file = (folder / "a.csv").string();
    const ProgramResult result = terrain_eval(folder, with(with(kShort, {"--csv", file}), more));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return value_of(read_file(file), "pooled,ground_iou,all");
  };
  const std::string plain = iou({});
  EXPECT_NE(plain, iou({"--pitch", "3"}));
  EXPECT_NE(plain, iou({"--raise", "0.1"}));
  EXPECT_NE(plain, iou({"-s", "grid.length=20"}));
  EXPECT_NE(plain, iou({"--radius", "2"}));
  EXPECT_NE(plain, iou({"--noise-seed", "2"}));
  EXPECT_EQ(plain, iou({}));
}

TEST(TerrainEval, SeedsForJudgingAreGuarded) {
  const fs::path folder = fresh_folder();
  const auto refused = [&folder](const std::string& seeds, const std::string& reason) {
    const ProgramResult result = terrain_eval(folder, {"worlds", "--seeds", seeds});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_TRUE(contains(result.err, reason)) << result.err;
    EXPECT_EQ(result.out, "");
  };
  refused("1000:1001", "are for judging");
  refused("999:1001", "must lie within 0:1000");
  refused("1100:1101", "must lie within 0:1000");
  refused("5:5", "A < B");
  refused("5", "A < B");
  refused("a:b", "A < B");
}

TEST(TerrainEval, WrongInputIsRefused) {
  const fs::path folder = fresh_folder();
  EXPECT_EQ(terrain_eval(folder, {}).exit_code, 2);
  EXPECT_EQ(terrain_eval(folder, {"worlds", "-f", "nothing"}).exit_code, 2);
  EXPECT_EQ(terrain_eval(folder, {"worlds", "-s", "grid.nothing=1"}).exit_code, 2);
  EXPECT_EQ(terrain_eval(folder, {"worlds", "--sensor", "nothing"}).exit_code, 2);
  EXPECT_EQ(terrain_eval(folder, {"labelled", folder.string(), "--classes", "rellis"}).exit_code,
            3);
}

// What was dumped, described again as labelled data, gives the same numbers: the files hold what
// was scored.
TEST(TerrainEval, DumpedWorldsScoreTheSameAsLabelledData) {
  const fs::path folder = fresh_folder();
  const std::string dump = (folder / "dump").string(), again = (folder / "again").string();
  const std::string first = (folder / "a.csv").string(), second = (folder / "b.csv").string();
  const std::vector<std::string> world = {"worlds", "-f",       "mixed", "--seeds", "4:5",
                                          "-n",     "1",        "--csv", first,     "--dump",
                                          dump,     "--sensor", "vlp16"};
  ASSERT_EQ(terrain_eval(folder, world).exit_code, 0);
  const ProgramResult labelled = terrain_eval(
      folder,
      {"labelled", dump + "/mixed_4", "--classes", "terrain", "--csv", second, "--dump", again});
  ASSERT_EQ(labelled.exit_code, 0) << labelled.err;
  const std::string a = read_file(first), b = read_file(second);
  for (const std::string metric : {"ground_iou", "ground_f1", "obstacle_tpr"}) {
    EXPECT_EQ(value_of(a, "pooled," + metric + ",all"), value_of(b, "pooled," + metric + ",all"));
    EXPECT_EQ(value_of(a, "pooled," + metric + ",0-10 m"),
              value_of(b, "pooled," + metric + ",0-10 m"));
  }
  EXPECT_TRUE(fs::exists(fs::path(dump) / "mixed_4" / "objects.csv"));
  std::size_t predictions = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(dump) / "mixed_4" / "predictions")) {
    const auto other = fs::path(again) / "mixed_4" / "predictions" / entry.path().filename();
    EXPECT_EQ(read_file(entry.path()), read_file(other));
    ++predictions;
  }
  EXPECT_EQ(predictions, 1U);
}

// The script is the scorer of other methods.
TEST(TerrainEval, AgreesWithTheScriptOnRealData) {
  const fs::path set = data_folder() / "rellis_104";
  const fs::path script = data_folder() / ".." / "tools" / "score_ground.py";
  if (!fs::exists(set) || !fs::exists(script)) GTEST_SKIP() << "needs " << set << ", " << script;
  const fs::path folder = fresh_folder();
  const ProgramResult ours =
      terrain_eval(folder, {"labelled", set.string(), "--classes", "rellis", "--find-ground", "-s",
                            "grid.length=60", "-s", "grid.width=60", "-s", "grid.cell_size=0.2",
                            "--radius", "25", "--dump", folder.string()});
  ASSERT_EQ(ours.exit_code, 0) << ours.err;
  const ProgramResult theirs =
      Program(folder, {"/usr/bin/python3", script.string(), "--classes", "rellis", "--radius", "25",
                       "--truth", (set / "labels/000104.label").string(), "--points",
                       (set / "velodyne/000104.bin").string(), "--pred",
                       (folder / "rellis_104/predictions/000104.label").string()})
          .wait();
  ASSERT_EQ(theirs.exit_code, 0) << theirs.err;
  // ...: P 1 R 2 F1 3 IoU 4 obstacle TPR 5 (ground 6, obstacle 7)
  double p = 0, r = 0, f1 = 0, iou = 0, tpr = 0;
  long ground = 0, obstacle = 0;
  const std::string line = theirs.out.substr(theirs.out.find(": P "));
  ASSERT_EQ(std::sscanf(line.c_str(),
                        ": P %lf R %lf F1 %lf IoU %lf obstacle TPR %lf (ground %ld, obstacle %ld)",
                        &p, &r, &f1, &iou, &tpr, &ground, &obstacle),
            7);
  const std::size_t pooled = ours.out.find("\npooled");
  ASSERT_NE(pooled, std::string::npos);
  double numbers[5] = {};
  long counts[2] = {};
  ASSERT_EQ(
      std::sscanf(ours.out.c_str() + pooled, "\npooled %lf %lf %lf %lf %lf %ld %ld", &numbers[0],
                  &numbers[1], &numbers[2], &numbers[3], &numbers[4], &counts[0], &counts[1]),
      7);
  EXPECT_EQ(numbers[0], iou);
  EXPECT_EQ(numbers[1], p);
  EXPECT_EQ(numbers[2], r);
  EXPECT_EQ(numbers[3], f1);
  EXPECT_EQ(numbers[4], tpr);
  EXPECT_EQ(counts[0], ground);
  EXPECT_EQ(counts[1], obstacle);
}

}  // namespace
}  // namespace mrpt_terrain::test
