// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/files/whole_file.h"

#include "test_files.h"

namespace mrpt_terrain::files {
namespace {

using namespace mrpt_terrain::test;

TEST(WholeFile, AppearsOnlyWhenComplete) {
  const auto path = fresh_folder() / "a.txt";
  WholeFile file(path.string());
  file.stream() << "new";
  EXPECT_FALSE(std::filesystem::exists(path));
  file.commit();
  EXPECT_EQ(read_file(path), "new");
  EXPECT_FALSE(std::filesystem::exists(file.part()));
}

TEST(WholeFile, WithoutCommitTheOlderFileStays) {
  const auto path = fresh_folder() / "a.txt";
  write_file(path, "old");
  {
    WholeFile file(path.string());
    file.stream() << "half";
  }
  EXPECT_EQ(read_file(path), "old");
  EXPECT_FALSE(std::filesystem::exists(path.string() + ".part"));
}

TEST(WholeFile, SaysWhyAFileCannotBeWritten) {
  const std::string path = (fresh_folder() / "no_folder" / "a.txt").string();
  WholeFile file(path);
  EXPECT_EQ(message_of<std::runtime_error>([&] { file.stream(); }),
            path + ": cannot be written: No such file or directory");
}

TEST(WholeFile, AFullDiskIsNoticed) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  const auto path = fresh_folder() / "a.txt";
  std::filesystem::create_symlink("/dev/full", path.string() + ".part");
  WholeFile file(path.string());
  file.stream() << "some text";
  EXPECT_EQ(message_of<std::runtime_error>([&] { file.commit(); }),
            path.string() + ": cannot be written: No space left on device");
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace mrpt_terrain::files
