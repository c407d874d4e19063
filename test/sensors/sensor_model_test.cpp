// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/sensors/sensor_model.h"

#include <gtest/gtest.h>
#include <mrpt/obs/VelodyneCalibration.h>

#include <fstream>
#include <string>

#include "observations.h"

namespace mrpt_terrain::sensors {
namespace {

using testing::fresh_folder;
using testing::kDegrees;

SensorModels shipped_models() {
  return SensorModels::from_folder(MRPT_TERRAIN_SOURCE_DIR "/params/sensors");
}

TEST(SensorModels, ShippedTablesAreFoundByNameAndAliasInAnyCase) {
  const SensorModels models = shipped_models();
  EXPECT_EQ(models.all().size(), 4U);
  for (const char* name : {"VLP-16", "vlp16", "HDL-32E", "hdl32", "HDL-64E", "OS1-64", "os1_64"}) {
    EXPECT_NE(models.find(name), nullptr) << name;
  }
  EXPECT_EQ(models.find("VLP-1"), nullptr);
  EXPECT_EQ(models.find(""), nullptr);
}

TEST(SensorModels, VelodyneTablesAgreeWithTheCalibrationsOfMrpt) {
  const SensorModels models = shipped_models();
  const std::pair<const char*, const char*> pairs[] = {{"VLP-16", "VLP16"}, {"HDL-32E", "HDL32"}};
  for (const auto& [ours, theirs] : pairs) {
    const auto& lasers =
        mrpt::obs::VelodyneCalibration::LoadDefaultCalibration(theirs).laser_corrections;
    const SensorModel* model = models.find(ours);
    ASSERT_NE(model, nullptr);
    ASSERT_EQ(model->elevation.size(), lasers.size()) << ours;
    for (std::size_t k = 0; k < lasers.size(); ++k) {
      EXPECT_NEAR(model->elevation[k], lasers[k].verticalCorrection * kDegrees, 1e-8) << ours << k;
    }
  }
}

TEST(SensorModels, LiteralFileIsReadInRadiansAndSeconds) {
  const std::string folder = fresh_folder();
  std::ofstream(folder + "/a.yaml") << "name: Two\naliases: [Zwei, 'Deux']\n"
                                       "elevation_deg: [-30, 45.5]\nmax_range: 50\n"
                                       "rate_hz: 20\ncolumns: 900\nlaser_interval_us: 2.5\n";
  std::ofstream(folder + "/ignored.txt") << "not a model";
  const SensorModels models = SensorModels::from_folder(folder);
  ASSERT_EQ(models.all().size(), 1U);
  const SensorModel& model = models.all()[0];
  EXPECT_EQ(model.name, "Two");
  EXPECT_EQ(model.aliases, (std::vector<std::string>{"Zwei", "Deux"}));
  ASSERT_EQ(model.elevation.size(), 2U);
  EXPECT_DOUBLE_EQ(model.elevation[0], -30.0 * kDegrees);
  EXPECT_DOUBLE_EQ(model.elevation[1], 45.5 * kDegrees);
  EXPECT_EQ(model.max_range, 50.0);
  EXPECT_EQ(model.rate, 20.0);
  EXPECT_EQ(model.columns, 900);
  EXPECT_DOUBLE_EQ(model.laser_interval, 2.5e-6);
}

struct BadFile {
  const char* content;
  const char* message;
};

TEST(SensorModels, NamesFileKeyAndReason) {
  const BadFile files[] = {
      {"name: A\nelevation_deg: [1]\nmax_range: 5\nmax_rnage: 5\n", "max_rnage: unknown key"},
      {"elevation_deg: [1]\nmax_range: 5\n", "name: is missing"},
      {"name: A\nmax_range: 5\n", "elevation_deg: is missing"},
      {"name: A\nelevation_deg: [1]\n", "max_range: is missing"},
      {"name: ''\nelevation_deg: [1]\nmax_range: 5\n", "name: must be a text that is not empty"},
      {"name: A\nelevation_deg: 3\nmax_range: 5\n", "elevation_deg: must be a list"},
      {"name: A\nelevation_deg: []\nmax_range: 5\n", "elevation_deg: must have 1 to 256 numbers"},
      {"name: A\nelevation_deg: [1, x]\nmax_range: 5\n", "elevation_deg: 'x' is not a number"},
      {"name: A\nelevation_deg: [1, 91]\nmax_range: 5\n",
       "elevation_deg: = 91: must be within [-90, 90]"},
      {"name: A\nelevation_deg: [1, .nan]\nmax_range: 5\n",
       "elevation_deg: '.nan' is not a number"},
      {"name: A\nelevation_deg: [1]\nmax_range: -5\n",
       "max_range: = -5: must be within [0.1, 10000]"},
      {"name: A\nelevation_deg: [1]\nmax_range: 5\ncolumns: 7.5\n",
       "columns: must be a whole number"},
      {"name: A\nelevation_deg: [1,\n2\n]\nmax_range: 5\n",
       "is not valid YAML: only 2 of its keys can be read"},
      {"- a\n- b\n", "must be a map of keys to values"},
  };
  for (const auto& bad : files) {
    const std::string folder = fresh_folder();
    std::ofstream(folder + "/bad.yaml") << bad.content;
    try {
      static_cast<void>(SensorModels::from_folder(folder));
      ADD_FAILURE() << "accepted: " << bad.content;
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(error.what(), folder + "/bad.yaml: " + bad.message);
    }
  }
}

TEST(SensorModels, RefusesNamesThatTwoModelsClaim) {
  const std::string folder = fresh_folder();
  std::ofstream(folder + "/a.yaml") << "name: One\nelevation_deg: [1]\nmax_range: 5\n";
  std::ofstream(folder + "/b.yaml")
      << "name: Two\naliases: [ONE]\nelevation_deg: [1]\nmax_range: 5\n";
  try {
    static_cast<void>(SensorModels::from_folder(folder));
    ADD_FAILURE() << "accepted";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), folder + "/b.yaml: name: 'ONE' is taken already");
  }
}

TEST(SensorModels, RefusesFoldersWithoutModels) {
  const std::string folder = fresh_folder();
  EXPECT_THROW(static_cast<void>(SensorModels::from_folder(folder)), std::runtime_error);
  EXPECT_THROW(static_cast<void>(SensorModels::from_folder(folder + "/none")), std::runtime_error);
}

}  // namespace
}  // namespace mrpt_terrain::sensors
