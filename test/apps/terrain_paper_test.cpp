// SPDX-License-Identifier: BSD-3-Clause
// terrain-paper as a user starts it.
#include <mrpt/system/string_utils.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <thread>

#include "program.h"

namespace mrpt_terrain::test {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> arguments_of(const fs::path& folder, std::vector<std::string> more) {
  std::vector<std::string> arguments = {TERRAIN_PAPER, "-o", (folder / "out").string()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

ProgramResult terrain_paper(const fs::path& folder, std::vector<std::string> more) {
  return Program(folder, arguments_of(folder, std::move(more))).wait();
}

/// A run of seconds.
const std::vector<std::string> kShort = {"-n", "3", "--resamples", "100"};

std::vector<std::string> with(std::vector<std::string> arguments,
                              const std::vector<std::string>& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

std::size_t lines_with(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

/// The files that a page holds as data.
std::vector<std::string> pictures_in(const std::string& page) {
  const std::string start = "src=\"data:image/png;base64,";
  std::vector<std::string> pictures;
  for (std::size_t at = page.find(start); at != std::string::npos; at = page.find(start, at)) {
    at += start.size();
    std::vector<std::uint8_t> bytes;
    if (!mrpt::system::decodeBase64(page.substr(at, page.find('"', at) - at), bytes)) continue;
    pictures.emplace_back(bytes.begin(), bytes.end());
  }
  return pictures;
}

bool gnuplot_is_there() {
  return fs::exists("/usr/bin/gnuplot") || fs::exists("/usr/local/bin/gnuplot");
}

TEST(TerrainPaper, PrintsAllTablesAndWritesThem) {
  const auto folder = fresh_folder();
  const ProgramResult result = terrain_paper(folder, with(kShort, {"--no-figures"}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  for (const std::string part :
       {"Table 2, height index of the obstacle: truth 15.00 cm",
        "Table 2, height index of the pothole: truth -9.00 cm",
        "Table 3, slope angle of cluster 3: truth 18.51 deg", "0.1992", "0.4385", "-0.0353",
        "Table 4, slope A: truth 7.74 deg; range noise 5 mm, no pose jitter; 3 scans",
        "Table 4, slope B: truth 13.86 deg", "Table 4, slope C: truth 18.51 deg",
        "Table 5, slope A1", "Table 5, slope A2",
        "Table 5, slope A3: truth 7.74 deg; range noise 20 mm, pose jitter 0.07 deg; 3 scans"}) {
    EXPECT_TRUE(contains(result.out, part)) << part;
  }
  // Six slopes at two levels, with and without pose jitter.
  EXPECT_EQ(lines_with(result.out, "\npaper_method "), 24U);
  EXPECT_EQ(lines_with(result.out, "\nbeam_to_ground "), 24U + 2U);
  const std::string text = read_file(folder / "out" / "tables.txt");
  EXPECT_TRUE(contains(result.out, text));
  EXPECT_FALSE(fs::exists(folder / "out" / "figures"));
}

TEST(TerrainPaper, EveryPublishedNumberIsInTheCsv) {
  const auto folder = fresh_folder();
  ASSERT_EQ(terrain_paper(folder, with(kShort, {"--no-figures", "--tables", "2,4"})).exit_code, 0);
  const std::string csv = read_file(folder / "out" / "tables.csv");
  for (const std::string part :
       {"2,obstacle,2,0.000,paper_method,mean_error,0.1992,",
        "2,pothole,20,0.000,paper_method,"
        "max_abs_error,0.5851,",
        "4,A,5,0.000,least_squares,variance,0.0082,", "4,C,20,0.070,paper_method,mean,18.53,",
        "4,B,5,0.000,beam,two_sigma_coverage,,"}) {
    EXPECT_TRUE(contains(csv, "\n" + part)) << part;
  }
  EXPECT_FALSE(contains(csv, "\n3,")) << "Table 3 was not asked for";
  EXPECT_FALSE(contains(csv, "nan"));
  // One line per trial, method, condition and slope.
  EXPECT_EQ(lines_with(read_file(folder / "out" / "estimates.csv"), ",least_squares,"),
            3U * 4U * 3U);
}

TEST(TerrainPaper, SameSeedSameBytesWhateverTheThreads) {
  const auto folder = fresh_folder();
  const std::vector<std::string> arguments =
      with(kShort, {"--no-figures", "--tables", "2,5", "--noise", "10"});
  std::vector<std::string> csv;
  for (const char* threads : {"1", "3"}) {
    ASSERT_EQ(terrain_paper(folder, with(arguments, {"--threads", threads})).exit_code, 0);
    csv.push_back(read_file(folder / "out" / "tables.csv") +
                  read_file(folder / "out" / "estimates.csv"));
  }
  EXPECT_EQ(csv[0], csv[1]);
  ASSERT_EQ(terrain_paper(folder, with(arguments, {"--seed", "2"})).exit_code, 0);
  EXPECT_NE(csv[0],
            read_file(folder / "out" / "tables.csv") + read_file(folder / "out" / "estimates.csv"));
}

TEST(TerrainPaper, IntervalsAppearAboveFiftyScans) {
  const auto folder = fresh_folder();
  const std::vector<std::string> arguments = {"--tables", "3", "--noise", "5", "--no-figures"};
  const ProgramResult fifty = terrain_paper(folder, with(arguments, {"-n", "50"}));
  EXPECT_FALSE(contains(fifty.out, "95 %")) << fifty.out;
  const ProgramResult more = terrain_paper(folder, with(arguments, {"-n", "51"}));
  EXPECT_TRUE(contains(more.out, "mean 95 %")) << more.out;
}

TEST(TerrainPaper, FewerScansForLmedsAreSaid) {
  const auto folder = fresh_folder();
  const ProgramResult result = terrain_paper(
      folder,
      with(kShort, {"--tables", "4", "--noise", "5", "--no-figures", "--lmeds-trials", "2"}));
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(contains(result.err, "lmeds sees the first 2 of 3 scans only")) << result.err;
  EXPECT_TRUE(contains(read_file(folder / "out" / "report.html"),
                       "lmeds sees the first 2 of 3 scans only"));
}

TEST(TerrainPaper, EstimatorsOfPclRunOrTheirAbsenceIsSaid) {
  const auto folder = fresh_folder();
  const ProgramResult result = terrain_paper(
      folder,
      with(kShort, {"--tables", "4", "--noise", "5", "--pose-jitter", "0", "--no-figures"}));
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(lines_with(result.out, "\nransac "), 3U) << "published values stand there in any case";
  const std::string estimates = read_file(folder / "out" / "estimates.csv");
#ifdef MRPT_TERRAIN_HAS_PEERS
  EXPECT_FALSE(contains(result.err, "built without PCL")) << result.err;
  EXPECT_EQ(lines_with(estimates, ",ransac,"), 9U);
#else
  EXPECT_TRUE(contains(result.err, "built without PCL (packages-paper.apt)")) << result.err;
  EXPECT_EQ(lines_with(estimates, ",ransac,"), 0U);
#endif
}

TEST(TerrainPaper, FiguresAreMadeAndThePageHoldsThem) {
  if (!gnuplot_is_there()) GTEST_SKIP() << "gnuplot is not installed";
  const auto folder = fresh_folder();
  const ProgramResult result = terrain_paper(folder, kShort);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::string page = read_file(folder / "out" / "report.html");
  const std::vector<std::string> pictures = pictures_in(page);
  ASSERT_EQ(pictures.size(), 9U);
  std::size_t picture = 0;
  for (const std::string number : {"06", "07", "08", "09", "10", "11", "12", "13", "14"}) {
    const std::string name = "figure_" + number;
    const std::string svg = read_file(folder / "out" / "figures" / (name + ".svg"));
    EXPECT_TRUE(contains(svg, "</svg>")) << name;
    const std::string png = read_file(folder / "out" / "figures" / (name + ".png"));
    EXPECT_EQ(png.substr(1, 3), "PNG") << name;
    EXPECT_TRUE(contains(png, "IEND")) << name;
    EXPECT_TRUE(contains(page, "figures/" + name + ".svg")) << name;
    EXPECT_EQ(pictures[picture++], png) << name;
    EXPECT_TRUE(fs::exists(folder / "out" / "figures" / (name + ".gp"))) << name;
  }
  for (const auto& entry : fs::directory_iterator(folder / "out" / "figures")) {
    EXPECT_NE(entry.path().extension(), ".part") << entry.path();
  }
  EXPECT_TRUE(contains(page, "Table 5, slope A3"));
  EXPECT_TRUE(contains(page, "</html>"));
}

TEST(TerrainPaper, WithoutGnuplotTheTablesAreThereAndTheReasonIsSaid) {
  const auto folder = fresh_folder();
  const std::string path = std::getenv("PATH");
  setenv("PATH", folder.c_str(), 1);
  const ProgramResult result = terrain_paper(folder, with(kShort, {"--tables", "2"}));
  setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_TRUE(contains(result.err, "gnuplot is not installed")) << result.err;
  EXPECT_TRUE(contains(result.out, "Table 2, height index of the obstacle"));
  EXPECT_TRUE(contains(read_file(folder / "out" / "report.html"), "gnuplot is not installed"));
  EXPECT_TRUE(fs::exists(folder / "out" / "figures" / "figure_06.gp"));
  EXPECT_TRUE(fs::exists(folder / "out" / "figures" / "figure_06.dat"));
}

TEST(TerrainPaper, CtrlCLeavesNothingBehind) {
  const auto folder = fresh_folder();
  Program program(folder, arguments_of(folder, {"-n", "100000"}));
  std::this_thread::sleep_for(std::chrono::seconds(1));
  program.send(SIGINT);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.exit_code, 130);
  EXPECT_TRUE(contains(result.err, "interrupted: nothing was written")) << result.err;
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(TerrainPaper, WrongUseIsRefused) {
  const auto folder = fresh_folder();
  const std::vector<std::vector<std::string>> wrong = {
      {"--tables", "6"}, {"--trials", "0"}, {"--noise", "-1"}, {"--threads", "0"}, {"--figures"}};
  for (const auto& arguments : wrong) {
    const ProgramResult result = terrain_paper(folder, arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments[0];
    EXPECT_TRUE(contains(result.err, arguments[0])) << result.err;
  }
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(TerrainPaper, AMissingSceneIsNamed) {
  const auto folder = fresh_folder();
  fs::create_directories(folder / "data");
  fs::copy(MRPT_TERRAIN_SOURCE_DIR "/params", folder / "data" / "params",
           fs::copy_options::recursive);
  fs::remove(folder / "data" / "params" / "scenes" / "paper_slope_b.yaml");
  setenv("MRPT_TERRAIN_DATA_DIR", (folder / "data").c_str(), 1);
  const ProgramResult result = terrain_paper(folder, with(kShort, {"--tables", "4"}));
  unsetenv("MRPT_TERRAIN_DATA_DIR");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_TRUE(contains(result.err, "paper_slope_b.yaml")) << result.err;
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(TerrainPaper, AFolderThatCannotBeWrittenIsAnError) {
  const auto folder = fresh_folder();
  write_file(folder / "out", "a file where the folder should be");
  const ProgramResult result =
      terrain_paper(folder, with(kShort, {"--tables", "2", "--noise", "5", "--no-figures"}));
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_TRUE(contains(result.err, "out")) << result.err;
}

}  // namespace
}  // namespace mrpt_terrain::test
