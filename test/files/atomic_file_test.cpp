// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/files/atomic_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "test_files.h"

namespace mrpt_terrain::files {
namespace {

std::string content_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::size_t files_in(const std::string& folder) {
  const std::filesystem::directory_iterator entries(folder);
  return static_cast<std::size_t>(std::distance(begin(entries), end(entries)));
}

std::string message_of_writing(const std::string& file) {
  try {
    write_atomically(file, "text");
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

TEST(AtomicFile, ReplacesTheOldFileAndLeavesNothingElse) {
  const std::string folder = test::empty_test_folder();
  write_atomically(folder + "a.txt", "old");
  write_atomically(folder + "a.txt", std::string_view("new\0one", 7));
  EXPECT_EQ(content_of(folder + "a.txt"), std::string("new\0one", 7));
  EXPECT_EQ(files_in(folder), 1U);
}

TEST(AtomicFile, AFailureKeepsTheOldFileAndRemovesThePart) {
  const std::string folder = test::empty_test_folder();
  write_atomically(folder + "a.txt", "old");
  const auto fail = [](const std::string& part_file) {
    std::ofstream(part_file) << "half of";
    throw std::runtime_error("disk on fire");
  };
  try {
    write_atomically(folder + "a.txt", fail);
    FAIL() << "no exception";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), folder + "a.txt: cannot be written: disk on fire");
  }
  EXPECT_EQ(content_of(folder + "a.txt"), "old");
  EXPECT_EQ(files_in(folder), 1U);
}

TEST(AtomicFile, TheMessageNamesFileAndReason) {
  const std::string folder = test::empty_test_folder();
  EXPECT_EQ(message_of_writing(folder + "missing/a.txt"),
            folder + "missing/a.txt: cannot be written: No such file or directory");
  std::filesystem::create_directory(folder + "taken");
  EXPECT_EQ(message_of_writing(folder + "taken"),
            folder + "taken: cannot be written: Is a directory");
  EXPECT_FALSE(std::filesystem::exists(folder + "taken.part"));
}

TEST(AtomicFile, AFullDiskIsAnError) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full on this system";
  const std::string folder = test::empty_test_folder();
  std::filesystem::create_symlink("/dev/full", folder + "a.txt.part");
  EXPECT_EQ(message_of_writing(folder + "a.txt"),
            folder + "a.txt: cannot be written: No space left on device");
  EXPECT_FALSE(std::filesystem::exists(folder + "a.txt"));
}

}  // namespace
}  // namespace mrpt_terrain::files
