// SPDX-License-Identifier: BSD-3-Clause
#include <mrpt/core/Clock.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include "mrpt_terrain/io/import.h"
#include "mrpt_terrain/io/observation_reader.h"
#include "stored_objects.h"

namespace mrpt_terrain::io {
namespace {

using namespace mrpt_terrain::test;

std::string ply(const std::filesystem::path& path, int x) {
  return write_file(path,
                    "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                    "property float y\nproperty float z\nend_header\n" +
                        std::to_string(x) + " 2 3\n");
}

std::string pcd(const std::filesystem::path& path, int x) {
  return write_file(path,
                    "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n"
                    "WIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n" +
                        std::to_string(x) + " 2 3\n");
}

std::string read_back(const std::string& rawlog) {
  std::string text;
  const auto reader = open_observations(rawlog);
  for (ReadObservation read; reader->next(read);) {
    const auto cloud =
        std::dynamic_pointer_cast<mrpt::obs::CObservationPointCloud>(read.observation);
    if (!cloud || !cloud->pointcloud) return "no cloud";
    char line[80];
    std::snprintf(line, sizeof(line), "%.2f:%.0f ", mrpt::Clock::toDouble(cloud->timestamp),
                  static_cast<double>(cloud->pointcloud->getPointsBufferRef_x().at(0)));
    text += line;
  }
  return text;
}

TEST(ImportCloud, ImportsFilesInTheGivenOrder) {
  const auto folder = fresh_folder();
  const std::string out = (folder / "out.rawlog").string();
  ImportOptions options;
  options.period = 0.25;
  const ImportSummary plys =
      import_ply({ply(folder / "b.ply", 5), ply(folder / "a.ply", 6)}, options, out);
  EXPECT_EQ(plys.scans, 2u);
  EXPECT_EQ(read_back(out), "0.00:5 0.25:6 ");
  import_pcd({pcd(folder / "b.pcd", 7), pcd(folder / "a.pcd", 8)}, options, out);
  EXPECT_EQ(read_back(out), "0.00:7 0.25:8 ");
  options.max_scans = 1;
  EXPECT_EQ(import_pcd({pcd(folder / "b.pcd", 7), "not read"}, options, out).scans, 1u);
}

TEST(ImportCloud, AnErrorLeavesAnOlderRawlogAlone) {
  const auto folder = fresh_folder();
  const std::string out = write_file(folder / "out.rawlog", "older");
  const std::string good = ply(folder / "a.ply", 5), bad = write_file(folder / "b.ply", "rubbish");
  EXPECT_THROW((void)import_ply({good, bad}, {}, out), ReadError);
  EXPECT_THROW((void)import_ply({}, {}, out), ReadError);
  EXPECT_EQ(read_file(out), "older");
  EXPECT_FALSE(std::filesystem::exists(out + ".part"));
}

TEST(ImportCloud, CanBeStopped) {
  const auto folder = fresh_folder();
  const std::string out = (folder / "out.rawlog").string();
  const std::string file = ply(folder / "a.ply", 5);
  ImportOptions options;
  std::string calls;
  options.progress = [&](std::size_t done, std::size_t total) {
    calls += std::to_string(done) + "/" + std::to_string(total) + " ";
    return done < 1;
  };
  EXPECT_TRUE(import_ply({file, file, file}, options, out).stopped);
  EXPECT_EQ(calls, "0/3 1/3 ");
  EXPECT_FALSE(std::filesystem::exists(out));
  EXPECT_FALSE(std::filesystem::exists(out + ".part"));
}

}  // namespace
}  // namespace mrpt_terrain::io
