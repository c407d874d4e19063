// SPDX-License-Identifier: BSD-3-Clause
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include "mrpt_terrain/io/observation_reader.h"
#include "stored_objects.h"

namespace mrpt_terrain::io {
namespace {

using namespace mrpt_terrain::test;

const mrpt::poses::CPose3D kPose(1, 2, 3, 0.1, 0.2, 0.3);

std::string map_bytes() {
  mrpt::maps::CSimpleMap map;
  for (int k = 0; k < 3; ++k) {
    mrpt::obs::CSensoryFrame frame;
    auto cloud = mrpt::obs::CObservationPointCloud::Create();
    auto points = mrpt::maps::CSimplePointsMap::Create();
    points->insertPoint(1, 2, static_cast<float>(k));
    cloud->pointcloud = points;
    frame.insert(cloud);
    if (k == 1) frame.insert(mrpt::obs::CObservationIMU::Create());
    mrpt::poses::CPose3DPDFGaussian pose;
    pose.mean = kPose + mrpt::poses::CPose3D(k, 0, 0, 0, 0, 0);
    map.insert(pose, frame);
  }
  return stored(map);
}

TEST(SimpleMapReader, DeliversKeyframesWithTheirPoses) {
  const auto folder = fresh_folder();
  for (const std::string& bytes : {map_bytes(), gzip(map_bytes())}) {
    const auto reader = open_observations(write_file(folder / "a.simplemap", bytes));
    ReadObservation read;
    std::string order;
    while (reader->next(read)) {
      order += std::to_string(read.entry);
      ASSERT_TRUE(read.T_map_robot);
      const auto expected =
          kPose + mrpt::poses::CPose3D(static_cast<double>(read.entry), 0, 0, 0, 0, 0);
      EXPECT_LT(difference(expected, *read.T_map_robot), 1e-12);
      const auto* cloud = dynamic_cast<mrpt::obs::CObservationPointCloud*>(read.observation.get());
      if (cloud != nullptr) {
        ASSERT_TRUE(cloud->pointcloud);
        EXPECT_EQ(cloud->pointcloud->getPointsBufferRef_z()[0], static_cast<float>(read.entry));
      }
    }
    EXPECT_EQ(order, "0112");
    EXPECT_EQ(reader->summary().entries, 3u);
    EXPECT_EQ(reader->summary().observations.at("mrpt::obs::CObservationIMU"), 1u);
    EXPECT_DOUBLE_EQ(reader->progress(), 1.0);
  }
}

TEST(SimpleMapReader, EveryCutIsNoticed) {
  const auto folder = fresh_folder();
  for (const std::string& bytes : {map_bytes(), gzip(map_bytes())}) {
    for (std::size_t n = 1; n < bytes.size(); n += 11) {
      const std::string file = write_file(folder / "a.simplemap", bytes.substr(0, n));
      EXPECT_THROW((void)open_observations(file), ReadError) << "cut at " << n;
    }
  }
}

TEST(SimpleMapReader, AnUnknownClassIsNamed) {
  std::string bytes = map_bytes();
  bytes.replace(bytes.find("CObservationIMU"), 15, "CObservationXYZ");
  const std::string file = write_file(fresh_folder() / "a.simplemap", bytes);
  EXPECT_EQ(message_of<ReadError>([&] { (void)open_observations(file); }),
            file +
                ": the simple map holds objects of classes unknown here: "
                "mrpt::obs::CObservationXYZ");
}

TEST(SimpleMapReader, OracleReadsTheMapsOfMrpt) {
  if (!std::filesystem::exists(mrpt_datasets())) {
    GTEST_SKIP() << "MRPT's data sets are not installed";
  }
  for (const char* name :
       {"localization_demo.simplemap.gz", "malaga-cs-fac-building.simplemap.gz"}) {
    const std::string file = (mrpt_datasets() / name).string();
    mrpt::maps::CSimpleMap oracle;
    ASSERT_TRUE(oracle.loadFromFile(file));
    ASSERT_GT(oracle.size(), 0u);
    const auto reader = open_observations(file);
    ReadObservation read;
    while (reader->next(read)) {
      ASSERT_TRUE(read.T_map_robot);
      const auto& [pose, frame] = oracle.get(read.entry);
      EXPECT_EQ(read.T_map_robot->distanceTo(pose->getMeanVal()), 0.0);
      EXPECT_EQ(read.observation->timestamp, frame->getObservationByIndex(0)->timestamp);
    }
    EXPECT_EQ(reader->summary().entries, oracle.size());
  }
}

}  // namespace
}  // namespace mrpt_terrain::io
