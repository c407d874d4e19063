// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/io/observation_reader.h"

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include "stored_objects.h"

namespace mrpt_terrain::io {
namespace {

using namespace mrpt_terrain::test;

std::string refusal(const std::string& file) {
  const std::string message = message_of<ReadError>([&] { (void)open_observations(file); });
  EXPECT_EQ(message.substr(0, file.size()), file);
  return message.substr(std::min(file.size(), message.size()));
}

TEST(OpenObservations, RefusesMissingEmptyAndFolders) {
  const auto folder = fresh_folder();
  EXPECT_EQ(refusal((folder / "none.rawlog").string()), ": no such file");
  EXPECT_EQ(refusal(folder.string()), ": is a folder, not a file");
  EXPECT_EQ(refusal(write_file(folder / "a.rawlog", "")), ": is empty");
  EXPECT_EQ(refusal(write_file(folder / "b.rawlog", gzip(""))),
            ": is empty (nothing but a gzip header)");
}

TEST(OpenObservations, RefusesFilesOfOtherKinds) {
  const auto folder = fresh_folder();
  const std::string words =
      ": is neither a rawlog nor a simple map: it does not begin with an MRPT object";
  const std::string others[] = {
      "x",
      "Some text of a user\nwith lines\n",
      "\xC3\x84hnlich, in UTF-8",
      "\x89PNG\r\n\x1A\n" + std::string("\0\0\0\rIHDR", 8),
      std::string("\xD4\xC3\xB2\xA1\x02\x00\x04\x00", 8) + std::string(200, '\0'),
      "PK\x03\x04 a zip file",
      std::string(1000, '\0'),
      std::string(1000, '\xFF'),
  };
  for (const std::string& other : others) {
    EXPECT_EQ(refusal(write_file(folder / "a.rawlog", other)), words);
    EXPECT_EQ(refusal(write_file(folder / "a.rawlog.gz", gzip(other))), words);
  }
}

TEST(OpenObservations, RefusesOtherMrptObjectsByName) {
  const std::string file =
      write_file(fresh_folder() / "a.gridmap", stored(mrpt::maps::COccupancyGridMap2D()));
  EXPECT_EQ(refusal(file),
            ": is neither a rawlog nor a simple map: it holds a mrpt::maps::COccupancyGridMap2D");
}

TEST(OpenObservations, GoesByContentNotByName) {
  const auto folder = fresh_folder();
  mrpt::maps::CSimpleMap map;
  mrpt::obs::CSensoryFrame frame;
  frame.insert(mrpt::obs::CObservationOdometry::Create());
  map.insert(mrpt::poses::CPose3DPDFGaussian(), frame);
  ReadObservation read;
  ASSERT_TRUE(open_observations(write_file(folder / "a.rawlog", gzip(stored(map))))->next(read));
  EXPECT_TRUE(read.T_map_robot);
  const std::string odometry = stored(mrpt::obs::CObservationOdometry());
  ASSERT_TRUE(open_observations(write_file(folder / "a.simplemap", odometry))->next(read));
  EXPECT_FALSE(read.T_map_robot);
}

}  // namespace
}  // namespace mrpt_terrain::io
