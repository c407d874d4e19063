// SPDX-License-Identifier: BSD-3-Clause
// Rawlogs of level 2D lasers say nothing about the ground: refused with a reason, never silently
// empty.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "program.h"
#include "test_files.h"

namespace mrpt_terrain::test {
namespace {

class PlanarRawlogs : public testing::TestWithParam<const char*> {};

TEST_P(PlanarRawlogs, AreRefusedWithAReason) {
  const auto rawlog = mrpt_datasets() / GetParam();
  if (!std::filesystem::exists(rawlog)) GTEST_SKIP() << rawlog << " is not on this machine";
  const auto folder = fresh_folder();
  Program program(folder, {TERRAIN_RAWLOG, "process", rawlog.string(), "-o", folder / "out"});
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_TRUE(contains(result.err, "no scan was described")) << result.err;
  EXPECT_TRUE(contains(result.err, "one level scan plane")) << result.err;
}

INSTANTIATE_TEST_SUITE_P(
    Debian, PlanarRawlogs,
    testing::Values("localization_demo.rawlog", "rot_scan_2d.rawlog",
                    "2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog"));

}  // namespace
}  // namespace mrpt_terrain::test
