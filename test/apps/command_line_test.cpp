// SPDX-License-Identifier: BSD-3-Clause
// The command line of terrain-rawlog: help, wrong use, exit codes.
#include "scans.h"

namespace mrpt_terrain::test {
namespace {

TEST(CommandLine, HelpNamesCommandsAndExitCodes) {
  const ProgramResult result = terrain_rawlog(fresh_folder(), {"--help"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
  for (const std::string part :
       {"process", "label", "info", "import", "Exit codes: 0 all well; 2 "}) {
    EXPECT_TRUE(contains(result.out, part)) << part;
  }
  const ProgramResult process = terrain_rawlog(fresh_folder(), {"process", "--help"});
  EXPECT_EQ(process.exit_code, 0);
  for (const std::string option :
       {"--config", "--set", "--output-dir", "--every", "--sensor-label", "--from-index",
        "--to-index", "--only-first-n", "--poses", "--sensor-pose", "--find-ground",
        "--externals-dir", "--table-rows", "--verbosity", "--quiet"}) {
    EXPECT_TRUE(contains(process.out, option)) << option;
  }
}

TEST(CommandLine, VersionIsThatOfTheSummary) {
  const auto folder = fresh_folder();
  const ProgramResult result = terrain_rawlog(folder, {"--version"});
  EXPECT_EQ(result.exit_code, 0);
  ASSERT_EQ(process_bytes(folder, drive_bytes(1)).exit_code, 0);
  EXPECT_EQ(result.out,
            "terrain-rawlog " + summary_of(folder)["version"].get<std::string>() + "\n");
}

TEST(CommandLine, PrintedDefaultsAreTheDefaults) {
  const auto folder = fresh_folder();
  const ProgramResult printed = terrain_rawlog(folder, {"--print-default-config"});
  EXPECT_EQ(printed.exit_code, 0);
  ASSERT_EQ(process_bytes(folder, drive_bytes(1)).exit_code, 0);
  EXPECT_EQ(read_file(folder / "out" / "params.ini"), printed.out);
  const std::string config = write_file(folder / "defaults.ini", printed.out);
  EXPECT_EQ(process_bytes(folder, drive_bytes(1), {"-c", config}).exit_code, 0);
}

TEST(CommandLine, WithoutACommandItShowsTheHelp) {
  const ProgramResult result = terrain_rawlog(fresh_folder(), {});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(contains(result.out + result.err, "Subcommands:"));
}

/// Arguments that are refused, and what the message says.
struct WrongUse {
  std::string name;
  std::vector<std::string> arguments;  ///< FILE stands for a rawlog, DIR for the output folder
  std::string message;
};
class WrongCommandLine : public testing::TestWithParam<WrongUse> {};

TEST_P(WrongCommandLine, IsRefusedBeforeAnythingIsDone) {
  const auto folder = fresh_folder();
  std::vector<std::string> arguments = GetParam().arguments;
  for (std::string& argument : arguments) {
    if (argument == "FILE") argument = write_file(folder / "drive.rawlog", drive_bytes(1));
    if (argument == "DIR") argument = (folder / "out").string();
  }
  const ProgramResult result = terrain_rawlog(folder, arguments);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(contains(result.err, GetParam().message)) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

WrongUse wrong(const std::string& name, std::vector<std::string> more, const std::string& message) {
  more.insert(more.begin(), {"process", "FILE", "-o", "DIR"});
  return {name, std::move(more), message};
}

INSTANTIATE_TEST_SUITE_P(
    CommandLine, WrongCommandLine,
    testing::Values(
        WrongUse{"UnknownCommand", {"proces", "FILE"}, "proces"},
        WrongUse{"NoInput", {"process"}, "inputs is required"},
        WrongUse{"NoInputOfLabel", {"label"}, "inputs is required"},
        WrongUse{"NoFolderOfLabel", {"label", "FILE", "-o", ""}, "error: --output-dir: needs"},
        WrongUse{"ViewsOfLabel", {"label", "FILE", "-o", "DIR", "--every", "2"}, "--every"},
        WrongUse{"NoInputOfInfo", {"info"}, "inputs is required"},
        WrongUse{"NoOutputOfImport", {"import", "FILE"}, "--output is required"},
        wrong("UnknownOption", {"--evry", "3"}, "--evry"),
        wrong("NoFolder", {"-o", ""}, "--output-dir"),
        wrong("EveryZero", {"--every", "0"}, "--every"),
        wrong("NegativeIndex", {"--from-index", "-1"}, "--from-index"),
        wrong("NegativeCount", {"--only-first-n", "-5"}, "--only-first-n"),
        wrong("CountThatIsNoNumber", {"--only-first-n", "many"}, "--only-first-n"),
        wrong("FirstBehindLast", {"--from-index", "5", "--to-index", "2"},
              "error: --from-index 5 is behind --to-index 2\n"),
        wrong("NoRegularExpression", {"--sensor-label", "("},
              "error: --sensor-label: not a regular expression"),
        wrong("PoseOfTwoNumbers", {"--sensor-pose", "1 2"},
              "error: --sensor-pose: \"1 2\" is no pose: give \"x y z\" or"),
        wrong("PoseOfFourNumbers", {"--sensor-pose", "1 2 3 4"}, "--sensor-pose"),
        wrong("PoseOfWords", {"--sensor-pose", "0 0 high"}, "\"0 0 high\" is no pose"),
        wrong("PoseWithATail", {"--sensor-pose", "0 0 1 0 0 0 m"}, "is no pose"),
        wrong("PoseThatIsInfinite", {"--sensor-pose", "0 0 1e999"}, "is no pose"),
        wrong("PoseThatIsEmpty", {"--sensor-pose", "[]"}, "is no pose"),
        wrong("NoConfiguration", {"-c", "none.ini"}, "error: none.ini: cannot be read"),
        wrong("NoPoses", {"--poses", "none.tum"}, "error: none.tum: cannot be opened"),
        wrong("NoExternals", {"--externals-dir", "none"}, "--externals-dir: none is no folder"),
        wrong("UnknownLevel", {"-v", "LOUD"}, "--verbosity"),
        wrong("UnknownParameter", {"--set", "ground.t_dif=1"},
              "error: --set: [ground] t_dif = 1: unknown key; did you mean `t_diff`?\n"),
        wrong("SettingWithoutValue", {"--set", "ground.t_diff"}, "--set")),
    [](const auto& test) { return test.param.name; });

TEST(CommandLine, AFullDiskIsNoticed) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  const auto folder = fresh_folder();
  const std::string command = "'" TERRAIN_RAWLOG "' --print-default-config > /dev/full";
  Program program(folder, {"/bin/sh", "-c", command});
  EXPECT_EQ(program.wait().exit_code, 5);
}

TEST(CommandLine, AClosedPipeDoesNotStopTheRun) {
  const auto folder = fresh_folder();
  const std::string input = write_file(folder / "drive.rawlog", drive_bytes(3));
  const std::string command = "('" TERRAIN_RAWLOG "' process '" + input + "' -o '" +
                              (folder / "out").string() + "'; echo $? >&2) | head -n 1";
  const ProgramResult result = Program(folder, {"/bin/sh", "-c", command}).wait();
  EXPECT_EQ(result.err, "0\n");
  expect_tables_of(folder, 3);
}

}  // namespace
}  // namespace mrpt_terrain::test
