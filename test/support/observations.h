// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <mrpt/core/Clock.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <mrpt/serialization/CArchive.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

/// \file
/// Builders of observations, and what tests of the io library need besides.
namespace mrpt_terrain::testing {

inline constexpr double kDegrees = M_PI / 180.0;

/// One of the rawlogs that Debian's mrpt-common installs.
inline std::string debian_dataset(const std::string& name) {
  return "/usr/share/mrpt/datasets/" + name;
}

/// First object of a rawlog, or null if the file is missing or holds another class.
template <class Observation>
typename Observation::Ptr first_observation(const std::string& file) {
  if (!std::filesystem::exists(file)) return nullptr;
  mrpt::io::CFileGZInputStream stream(file);
  auto archive = mrpt::serialization::archiveFrom(stream);
  return std::dynamic_pointer_cast<Observation>(archive.ReadObject());
}

/// An empty folder of the running test.
inline std::string fresh_folder() {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  const auto folder = std::filesystem::path(::testing::TempDir()) /
                      (std::string(test->test_suite_name()) + "." + test->name());
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder.string();
}

/// Fills a Velodyne packet byte by byte, as the sensor's manual describes it.
class VelodynePacket {
 public:
  using Packet = mrpt::obs::CObservationVelodyneScan::TVelodyneRawPacket;
  static constexpr std::uint8_t kStrongest = 0x37, kDual = 0x39, kHdl32 = 0x21, kVlp16 = 0x22;

  VelodynePacket(std::uint32_t micros, std::uint8_t return_mode, std::uint8_t model)
      : bytes_(sizeof(Packet), 0) {
    put(1200, micros, 4);
    bytes_[1204] = return_mode;
    bytes_[1205] = model;
    for (std::size_t block = 0; block < 12; ++block) header(block, 0xeeff);
  }
  VelodynePacket& header(std::size_t block, std::uint32_t value) {
    return put(block * 100, value, 2);
  }
  /// \param azimuth hundredths of a degree, clockwise
  VelodynePacket& azimuth(std::size_t block, std::uint32_t azimuth) {
    return put(block * 100 + 2, azimuth, 2);
  }
  /// \param distance in units of 2 mm
  VelodynePacket& distance(std::size_t block, std::size_t index, std::uint32_t distance) {
    return put(block * 100 + 4 + index * 3, distance, 2);
  }
  [[nodiscard]] Packet build() const {
    Packet packet;
    std::memcpy(static_cast<void*>(&packet), bytes_.data(), sizeof(Packet));
    return packet;
  }

 private:
  VelodynePacket& put(std::size_t at, std::uint32_t value, std::size_t size) {
    for (std::size_t k = 0; k < size; ++k) {
      bytes_[at + k] = static_cast<std::uint8_t>(value >> (8 * k));
    }
    return *this;
  }
  std::vector<std::uint8_t> bytes_;
};

/// A packet whose head turns by `step` hundredths of a degree per block, all returns at `distance`.
inline VelodynePacket turning_packet(std::uint32_t micros, std::uint8_t model, std::uint32_t first,
                                     std::uint32_t step, std::uint32_t distance) {
  VelodynePacket packet(micros, VelodynePacket::kStrongest, model);
  for (std::uint32_t block = 0; block < 12; ++block) {
    packet.azimuth(block, (first + block * step) % 36000);
    for (std::size_t k = 0; k < 32; ++k) packet.distance(block, k, distance);
  }
  return packet;
}

/// A Velodyne scan without packets, with MRPT's calibration of a model ("VLP16", "HDL32").
inline mrpt::obs::CObservationVelodyneScan velodyne_scan(const std::string& model) {
  mrpt::obs::CObservationVelodyneScan scan;
  scan.timestamp = mrpt::Clock::fromDouble(1000.0);
  scan.sensorLabel = "velodyne";
  scan.calibration = mrpt::obs::VelodyneCalibration::LoadDefaultCalibration(model);
  scan.minRange = 0.0;
  scan.maxRange = 200.0;
  return scan;
}

/// A range image with all ranges zero, 1 cm per unit, turning counter-clockwise from -180 degrees.
inline mrpt::obs::CObservationRotatingScan rotating_scan(const std::string& model,
                                                         std::uint16_t rows,
                                                         std::uint16_t columns) {
  mrpt::obs::CObservationRotatingScan scan;
  scan.timestamp = mrpt::Clock::fromDouble(1000.0);
  scan.sensorLabel = "lidar";
  scan.lidarModel = model;
  scan.rowCount = rows;
  scan.columnCount = columns;
  scan.rangeImage.setZero(rows, columns);
  scan.rangeResolution = 0.01;
  scan.minRange = 0.0;
  return scan;
}

/// A depth image of the given size with all ranges zero, 1 mm per unit, principal point in the
/// middle of the image, focal length 100 pixels.
inline mrpt::obs::CObservation3DRangeScan depth_image(int rows, int columns) {
  mrpt::obs::CObservation3DRangeScan image;
  image.timestamp = mrpt::Clock::fromDouble(1000.0);
  image.sensorLabel = "camera";
  image.hasRangeImage = true;
  image.range_is_depth = true;
  image.rangeUnits = 0.001F;
  image.rangeImage_setSize(rows, columns);
  image.rangeImage.fill(0);
  image.cameraParams.nrows = static_cast<unsigned>(rows);
  image.cameraParams.ncols = static_cast<unsigned>(columns);
  image.cameraParams.setIntrinsicParamsFromValues(100.0, 100.0, columns / 2.0, rows / 2.0);
  return image;
}

}  // namespace mrpt_terrain::testing
