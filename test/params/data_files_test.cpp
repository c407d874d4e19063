// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/params/data_files.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

#include "support_params.h"

namespace mrpt_terrain::params {
namespace {

namespace fs = std::filesystem;

/// An installed tree (prefix/bin, prefix/share/mrpt_terrain/params), a source tree (source/params)
/// and a folder of one's own (own/params).
class DataFilesTest : public testing::Test {
 protected:
  DataFilesTest() : root_(fresh_folder()) {
    for (const char* folder :
         {"prefix/bin", "prefix/share/mrpt_terrain/params", "source/params", "own/params"}) {
      fs::create_directories(root_ / folder);
    }
    places_.executable_folder = root_ / "prefix/bin";
    places_.source_folder = root_ / "source";
  }

  fs::path root_;
  DataFolderPlaces places_;
};

TEST_F(DataFilesTest, InstalledFolderComesBeforeTheSources) {
  EXPECT_EQ(find_data_folder(places_), root_ / "prefix/share/mrpt_terrain");
  fs::remove_all(root_ / "prefix/share");
  EXPECT_EQ(find_data_folder(places_), root_ / "source");
}

// A plug-in of ours in a program of others.
TEST_F(DataFilesTest, InstalledLibraryComesBeforeTheSources) {
  places_.executable_folder = root_ / "elsewhere/bin";
  for (const char* folder : {"prefix/lib", "prefix/lib/x86_64-linux-gnu"}) {
    places_.library_folder = root_ / folder;
    EXPECT_EQ(find_data_folder(places_), root_ / "prefix/share/mrpt_terrain");
  }
}

TEST_F(DataFilesTest, EnvironmentComesFirst) {
  places_.environment = (root_ / "own").string();
  EXPECT_EQ(find_data_folder(places_), root_ / "own");
}

TEST_F(DataFilesTest, WrongEnvironmentIsRefusedThoughOthersWouldDo) {
  const std::string wrong = (root_ / "prefix").string();
  places_.environment = wrong;
  EXPECT_EQ(message_of<std::runtime_error>([&] { (void)find_data_folder(places_); }),
            "MRPT_TERRAIN_DATA_DIR = " + wrong + ": must name a folder that holds params/");
}

TEST_F(DataFilesTest, NothingFoundNamesAllThatWasTried) {
  fs::remove_all(root_);
  const std::string message =
      message_of<std::runtime_error>([&] { (void)find_data_folder(places_); });
  EXPECT_NE(message.find((root_ / "prefix/share/mrpt_terrain").string()), std::string::npos);
  EXPECT_NE(message.find((root_ / "source").string()), std::string::npos);
  EXPECT_NE(message.find("MRPT_TERRAIN_DATA_DIR"), std::string::npos);
}

TEST(DataFolderPlacesTest, TheProgramItselfFindsTheFilesOfThisProject) {
  ::unsetenv("MRPT_TERRAIN_DATA_DIR");
  EXPECT_TRUE(fs::exists(find_data_folder() / "params" / "paper.ini"));
  EXPECT_EQ(data_folder_places().environment, std::nullopt);
  EXPECT_TRUE(fs::is_directory(data_folder_places().executable_folder));
  EXPECT_EQ(data_folder_places().library_folder, data_folder_places().executable_folder);
}

TEST(DataFolderPlacesTest, TheEnvironmentIsRead) {
  ::setenv("MRPT_TERRAIN_DATA_DIR", "/somewhere", 1);
  EXPECT_EQ(data_folder_places().environment, "/somewhere");
  ::unsetenv("MRPT_TERRAIN_DATA_DIR");
}

}  // namespace
}  // namespace mrpt_terrain::params
