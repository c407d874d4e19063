// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/io/rawlog_writer.h"

#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CRawlog.h>

#include "stored_objects.h"

namespace mrpt_terrain::io {
namespace {

using namespace mrpt_terrain::test;

TEST(RawlogWriter, WritesWhatMrptReads) {
  const auto path = fresh_folder() / "a.rawlog";
  RawlogWriter writer(path.string());
  mrpt::obs::CObservationOdometry odometry;
  for (int k = 0; k < 3; ++k) {
    odometry.odometry = mrpt::poses::CPose2D(k, 2, 0.5);
    writer.write(odometry);
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  writer.commit();
  mrpt::obs::CRawlog rawlog;
  ASSERT_TRUE(rawlog.loadFromRawLogFile(path.string()));
  ASSERT_EQ(rawlog.size(), 3u);
  const auto last =
      std::dynamic_pointer_cast<mrpt::obs::CObservationOdometry>(rawlog.getAsObservation(2));
  ASSERT_TRUE(last);
  EXPECT_EQ(last->odometry.x(), 2.0);
}

TEST(RawlogWriter, LeavesNothingWithoutCommit) {
  const auto folder = fresh_folder();
  {
    RawlogWriter writer((folder / "a.rawlog").string());
    writer.write(mrpt::obs::CObservationOdometry());
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST(RawlogWriter, SaysWhyAFileCannotBeWritten) {
  const std::string path = (fresh_folder() / "no_folder" / "a.rawlog").string();
  EXPECT_EQ(message_of<std::runtime_error>([&] { RawlogWriter writer(path); }),
            path + ": cannot be written: No such file or directory");
}

TEST(RawlogWriter, AFullDiskIsNoticed) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  const auto path = fresh_folder() / "a.rawlog";
  std::filesystem::create_symlink("/dev/full", path.string() + ".part");
  RawlogWriter writer(path.string());
  writer.write(mrpt::obs::CObservationOdometry());
  EXPECT_EQ(message_of<std::runtime_error>([&] { writer.commit(); }),
            path.string() + ": cannot be written: No space left on device");
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace mrpt_terrain::io
