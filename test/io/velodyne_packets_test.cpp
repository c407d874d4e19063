// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/io/velodyne_packets.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <stdexcept>

#include "mrpt_terrain/core/random.h"
#include "mrpt_terrain/io/scan.h"
#include "observations.h"

namespace mrpt_terrain::io {
namespace {

using sensors::SensorModel;
using testing::kDegrees;
using Velodyne = mrpt::obs::CObservationVelodyneScan;

SensorModel model_named(const std::string& name) {
  const auto models = sensors::SensorModels::from_folder(MRPT_TERRAIN_SOURCE_DIR "/params/sensors");
  return *models.find(name);
}

/// Ranges from 1 to 100 m, one of seven slots without return.
VelodyneTurn random_turn(const SensorModel& model, std::uint64_t seed) {
  RandomGenerator random(seed);
  const std::size_t slots = static_cast<std::size_t>(model.columns) * model.elevation.size();
  VelodyneTurn turn;
  turn.stamp = 1577836800.0 + 3599.97;  // the sensor's hour ends within the turn
  for (std::size_t k = 0; k < slots; ++k) {
    const double range = 1.0 + 99.0 * random.uniform();
    turn.range.push_back(k % 7 == 3 ? 0.0F : static_cast<float>(range));
    turn.intensity.push_back(static_cast<std::uint8_t>(k % 251));
  }
  return turn;
}

/// Where the model's frame has the return of a slot.
Eigen::Vector3d expected_point(const SensorModel& model, const VelodyneTurn& turn,
                               std::size_t slot) {
  const std::size_t ring = slot % model.elevation.size();
  const double azimuth = model.azimuth(slot / model.elevation.size(), ring);
  const double range = static_cast<double>(turn.range[slot]);
  const double level = range * std::cos(model.elevation[ring]);
  return {level * std::cos(azimuth), level * std::sin(azimuth),
          range * std::sin(model.elevation[ring])};
}

Eigen::Vector3d point(const Points& points, std::size_t k) {
  return {points.x[k], points.y[k], points.z[k]};
}

/// Half a step of the range, half a step of the azimuth; and as much again as the azimuth of a
/// return inside a block is off, whose turn is known in steps of 0.01 degrees only. A micrometre
/// per metre is the rounding of float.
double tolerance(double range) { return 0.001 + range * (0.01 * kDegrees + 1e-6); }

class VelodynePackets : public ::testing::TestWithParam<const char*> {};

TEST_P(VelodynePackets, InvariantOurDecoderFindsEverySlotAgain) {
  const SensorModel model = model_named(GetParam());
  const VelodyneTurn turn = random_turn(model, 1);
  const auto scan = encode_velodyne(model, turn);
  SensorPoints points;
  InputParams all;
  all.min_range = 0.0;
  ASSERT_EQ(convert_observation(scan, all, {}, points).status, ConversionStatus::kOk);
  std::size_t next = 0;
  const bool instants = model.elevation.size() == 64;
  for (std::size_t slot = 0; slot < turn.range.size(); ++slot) {
    if (turn.range[slot] == 0.0F) continue;
    ASSERT_LT(next, points.points.size());
    ASSERT_EQ(points.source_index[next], slot);
    const Eigen::Vector3d expected = expected_point(model, turn, slot);
    ASSERT_LE((point(points.points, next) - expected).norm(), tolerance(expected.norm())) << slot;
    const std::size_t column = slot / model.elevation.size();
    ASSERT_NEAR(points.time[next], model.firing_time(column, 0), instants ? 3e-4 : 2e-6) << slot;
    ++next;
  }
  EXPECT_EQ(next, points.points.size());
  EXPECT_NEAR(points.stamp, turn.stamp, 1e-6);
}

TEST_P(VelodynePackets, OracleMrptReadsTheSamePointsOfTheReturnsThatItReads) {
  const SensorModel model = model_named(GetParam());
  const std::size_t lasers = model.elevation.size();
  const VelodyneTurn turn = random_turn(model, 2);
  auto scan = encode_velodyne(model, turn);
  Velodyne::TGeneratePointCloudParameters all;
  all.minDistance = 0.0F;
  scan.generatePointCloud(all);
  const auto& cloud = scan.point_cloud;
  std::size_t next = 0;
  for (std::size_t slot = 0; slot < turn.range.size(); ++slot) {
    if (turn.range[slot] == 0.0F || slot % 32 >= 16) continue;
    ASSERT_LT(next, cloud.size());
    const Eigen::Vector3d expected = expected_point(model, turn, slot);
    const Eigen::Vector3d read(cloud.x[next], cloud.y[next], cloud.z[next]);
    // MRPT rounds azimuths to 0.01 degrees and looks them up in a table of 36000 entries that
    // stretches 35999 steps over the full turn.
    const double more = expected.norm() * 0.015 * kDegrees;
    ASSERT_LE((read - expected).norm(), tolerance(expected.norm()) + more) << slot;
    ASSERT_EQ(cloud.intensity[next], turn.intensity[slot]);
    ASSERT_EQ(cloud.laser_id[next], static_cast<int>(slot % lasers));
    ++next;
  }
  EXPECT_EQ(next, cloud.size());
}

INSTANTIATE_TEST_SUITE_P(Models, VelodynePackets, ::testing::Values("VLP-16", "HDL-32E", "HDL-64E"),
                         [](const auto& test) {
                           std::string name = test.param;
                           name.erase(name.find('-'), 1);
                           return name;
                         });

TEST(VelodynePackets, LiteralBytesOfAVlp16) {
  SensorModel model = model_named("VLP-16");
  model.columns = 48;
  VelodyneTurn turn;
  turn.range.assign(48 * 16, 0.0F);
  turn.intensity.assign(48 * 16, 7);
  turn.range[16 + 1] = 10.0F;  // second firing of block 0
  turn.stamp = 3600.0 * 5 + 1.25;
  const auto scan = encode_velodyne(model, turn);
  ASSERT_EQ(scan.scan_packets.size(), 2U);
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(scan.scan_packets.data());
  const auto number = [&](std::size_t at, std::size_t size) {
    std::uint32_t value = 0;
    for (std::size_t k = 0; k < size; ++k) value |= std::uint32_t{bytes[at + k]} << (8 * k);
    return value;
  };
  EXPECT_EQ(number(0, 2), 0xeeffU);
  EXPECT_EQ(number(2, 2), 18000U);           // the first column looks backwards
  EXPECT_EQ(number(4 + 17 * 3, 2), 5000U);   // 10 m in units of 2 mm
  EXPECT_EQ(number(4 + 17 * 3 + 2, 1), 7U);  // its intensity
  EXPECT_EQ(number(4 + 16 * 3, 3), 0U);      // no return, no intensity
  EXPECT_EQ(number(100 + 2, 2), 19500U);     // two columns of 7.5 degrees on
  EXPECT_EQ(number(1200, 4), 1'250'000U);    // microseconds since five o'clock
  EXPECT_EQ(number(1204, 1), 0x37U);
  EXPECT_EQ(number(1205, 1), 0x22U);
  EXPECT_EQ(number(1206 + 1200, 4), 1'250'000U + 50'000U);
}

TEST(VelodynePackets, CalibrationIsThatOfMrpt) {
  for (const auto& [own, mrpt_name] : {std::pair{"VLP-16", "VLP16"}, {"HDL-32E", "HDL32"}}) {
    const SensorModel model = model_named(own);
    const auto scan = encode_velodyne(model, random_turn(model, 3));
    const auto& ours = scan.calibration.laser_corrections;
    const auto& theirs =
        mrpt::obs::VelodyneCalibration::LoadDefaultCalibration(mrpt_name).laser_corrections;
    ASSERT_EQ(ours.size(), theirs.size());
    for (std::size_t k = 0; k < ours.size(); ++k) {
      EXPECT_NEAR(ours[k].verticalCorrection, theirs[k].verticalCorrection, 1e-6);
      EXPECT_NEAR(ours[k].sinVertCorrection, theirs[k].sinVertCorrection, 1e-6);
      EXPECT_NEAR(ours[k].cosVertCorrection, theirs[k].cosVertCorrection, 1e-6);
    }
  }
}

TEST(VelodynePackets, RangesBeyondTheFormatAreNoReturns) {
  const SensorModel model = model_named("VLP-16");
  VelodyneTurn turn = random_turn(model, 4);
  turn.range.assign(turn.range.size(), 0.0F);
  turn.range[0] = 131.1F;
  turn.range[1] = 131.07F;
  turn.range[2] = 0.0009F;
  SensorPoints points;
  const auto scan = encode_velodyne(model, turn);
  ASSERT_EQ(convert_observation(scan, {}, {}, points).status, ConversionStatus::kOk);
  EXPECT_EQ(points.source_index, std::vector<std::uint32_t>{1});
}

TEST(VelodynePackets, OtherSensorsAreRefusedWithTheRule) {
  SensorModel model = model_named("OS1-64");
  EXPECT_EQ(velodyne_problem(model),
            "sensor OS1-64: has no packets; VLP-16, HDL-32E and HDL-64E have");
  EXPECT_THROW((void)encode_velodyne(model, random_turn(model, 5)), std::invalid_argument);
  model = model_named("VLP-16");
  EXPECT_EQ(velodyne_problem(model), "");
  EXPECT_THROW((void)encode_velodyne(model, VelodyneTurn{}), std::invalid_argument);
  model.elevation.pop_back();
  EXPECT_EQ(velodyne_problem(model), "sensor VLP-16: has 15 rows; its packets hold 16");
  model = model_named("HDL-32E");
  model.columns = 0;
  EXPECT_EQ(velodyne_problem(model), "sensor HDL-32E: rate_hz and columns must be given");
}

}  // namespace
}  // namespace mrpt_terrain::io
