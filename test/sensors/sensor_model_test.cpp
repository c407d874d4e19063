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
  EXPECT_EQ(models.all().size(), 5U);
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

SensorModel load_text(const std::string& text) {
  const std::string file = fresh_folder() + "/model.yaml";
  std::ofstream(file) << text;
  return load_sensor_model(file);
}

TEST(SensorModels, LiteralFileIsReadInRadiansAndSeconds) {
  const SensorModel model = load_text(
      "name: Two\naliases: [Zwei, 'Deux']\nelevation_deg: [-30,\n 45.5]\nmax_range: 50\n"
      "min_range: 0.5\nrate_hz: 20\ncolumns: 900\nlaser_interval_us: 2.5\n"
      "azimuth_offset_deg: [1, -1]\n"
      "noise:\n  range_sigma: 0.02\n  unit_seed: 7\n  beam_divergence_deg: 0.5\n  sub_rays: 5\n");
  EXPECT_EQ(model.name, "Two");
  EXPECT_EQ(model.aliases, (std::vector<std::string>{"Zwei", "Deux"}));
  ASSERT_EQ(model.elevation.size(), 2U);
  EXPECT_DOUBLE_EQ(model.elevation[0], -30.0 * kDegrees);
  EXPECT_DOUBLE_EQ(model.elevation[1], 45.5 * kDegrees);
  EXPECT_DOUBLE_EQ(model.azimuth_offset[1], -kDegrees);
  EXPECT_EQ(model.max_range, 50.0);
  EXPECT_EQ(model.min_range, 0.5);
  EXPECT_EQ(model.rate, 20.0);
  EXPECT_EQ(model.columns, 900);
  EXPECT_DOUBLE_EQ(model.laser_interval, 2.5e-6);
  EXPECT_EQ(model.noise.range_sigma, 0.02);
  EXPECT_EQ(model.noise.unit_seed, 7U);
  EXPECT_DOUBLE_EQ(model.noise.beam_divergence, 0.5 * kDegrees);
  EXPECT_EQ(model.noise.sub_rays, 5);
}

TEST(SensorModels, FilesWithoutNoiseDescribeAPerfectClockwiseSensor) {
  const SensorModel model = load_text("name: A\nelevation_deg: [1]\nmax_range: 5\n");
  EXPECT_EQ(model.noise.range_sigma, 0.0);
  EXPECT_EQ(model.noise.sub_rays, 1);
  EXPECT_TRUE(model.full_turn());
  EXPECT_FALSE(model.has_timing());
}

TEST(SensorModels, FullTurnStopsOneStepBeforeItsStart) {
  const SensorModel model = load_text(
      "name: A\nelevation_deg: [0, 1]\nmax_range: 5\nrate_hz: 10\ncolumns: 8\n"
      "laser_interval_us: 1000\nazimuth_offset_deg: [0, 2]\n");
  EXPECT_NEAR(model.azimuth(0, 0), 180.0 * kDegrees, 1e-12);
  EXPECT_NEAR(model.azimuth(7, 0), -135.0 * kDegrees, 1e-12);
  EXPECT_NEAR(model.firing_time(7, 0), 0.0875, 1e-12);
  // A millisecond later at 3600 degrees per second, clockwise, and looking 2 degrees aside.
  EXPECT_NEAR(model.azimuth(4, 1), (-3.6 + 2.0) * kDegrees, 1e-12);
  EXPECT_NEAR(model.firing_time(4, 1), 0.051, 1e-12);
}

TEST(SensorModels, ShorterSpanEndsAtItsLastColumn) {
  const SensorModels models = shipped_models();
  const SensorModel* model = models.find("lms111");
  ASSERT_NE(model, nullptr);
  ASSERT_EQ(model->elevation.size(), 1U);
  EXPECT_NEAR(model->azimuth_step(), 0.25 * kDegrees, 1e-12);
  EXPECT_NEAR(model->azimuth(0, 0), -135.0 * kDegrees, 1e-12);
  EXPECT_NEAR(model->azimuth(1080, 0), 135.0 * kDegrees, 1e-12);
  // Three quarters of a turn of 40 ms.
  EXPECT_NEAR(model->firing_time(1080, 0), 0.03, 1e-12);
}

struct BadFile {
  const char* content;
  const char* message;
};

TEST(SensorModels, NamesFileLineKeyAndReason) {
  const BadFile files[] = {
      {"name: A\nelevation_deg: [1]\nmax_range: 5\nmax_rnage: 5\n", ":4: max_rnage: unknown key"},
      {"name: A\nelevation_deg: [1]\nmax_range: 5\nmax_range: 6\n",
       ":4: max_range: is given twice"},
      {"elevation_deg: [1]\nmax_range: 5\n", ": name: is missing"},
      {"name: A\nmax_range: 5\n", ": elevation_deg: is missing"},
      {"name: A\nelevation_deg: [1]\n", ": max_range: is missing"},
      {"name: ''\nelevation_deg: [1]\nmax_range: 5\n",
       ":1: name: must be a text that is not empty"},
      {"name: A\nelevation_deg: 3\nmax_range: 5\n", ":2: elevation_deg: must be a list"},
      {"name: A\nelevation_deg: []\nmax_range: 5\n",
       ":2: elevation_deg: must have 1 to 256 numbers"},
      {"name: A\nelevation_deg: [1,\n x]\nmax_range: 5\n",
       ":3: elevation_deg: 'x' is not a number"},
      {"name: A\nelevation_deg: [1, 91]\nmax_range: 5\n",
       ":2: elevation_deg: = 91: must be within [-90, 90]"},
      {"name: A\nelevation_deg: [1, .nan]\nmax_range: 5\n",
       ":2: elevation_deg: '.nan' is not a number"},
      {"name: A\nelevation_deg: [1]\nmax_range: -5\n",
       ":3: max_range: = -5: must be within [0.1, 10000]"},
      {"name: A\nelevation_deg: [1]\nmax_range: 5\ncolumns: 7.5\n",
       ":4: columns: must be a whole number"},
      {"name: A\nelevation_deg: [1]\nmax_range: 5\nmin_range: 6\n",
       ":4: min_range: = 6: must be within [0, 5]"},
      {"name: A\nelevation_deg: [1]\nmax_range: 5\nazimuth_offset_deg: [1, 2]\n",
       ":4: azimuth_offset_deg: must have a number per ring, 1"},
      {"name: A\nelevation_deg: [1]\nmax_range: 5\nend_azimuth_deg: -181\n",
       ":4: end_azimuth_deg: must be at most one turn from start_azimuth_deg, and not the same"},
      {"name: A\nelevation_deg: [1]\nmax_range: 5\nnoise: 3\n",
       ":4: noise: must be a map of keys to values"},
      {"name: A\nelevation_deg: [1]\nmax_range: 5\nnoise: {sub_rays: 3}\n",
       ": [noise] sub_rays = 3: must be 1 or 5 (rays per beam)"},
      {"name: A\nelevation_deg: [1]\nmax_range: 5\nnoise: {dropout: 1.5}\n",
       ": [noise] dropout = 1.5: must be within [0, 1] (share of returns lost at random)"},
      {"name: A\nelevation_deg: [1]\nmax_range: 5\nnoise: {drop_out: 0.5}\n",
       ": [noise] drop_out = 0.5: unknown key; did you mean `dropout`?"},
      {"name: A\nelevation_deg: [1, 2\nmax_range: 5\n",
       ":3: is not valid YAML: end of sequence flow not found"},
      {"- a\n- b\n", ": must be a map of keys to values"},
  };
  for (const auto& bad : files) {
    const std::string folder = fresh_folder();
    std::ofstream(folder + "/bad.yaml") << bad.content;
    try {
      static_cast<void>(SensorModels::from_folder(folder));
      ADD_FAILURE() << "accepted: " << bad.content;
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(error.what(), folder + "/bad.yaml" + bad.message);
    }
  }
}

TEST(SensorModels, ResolvesNamesAndFilesAndListsWhatItKnows) {
  const std::string folder = MRPT_TERRAIN_SOURCE_DIR "/params/sensors";
  EXPECT_EQ(resolve_sensor("hdl32e", folder).name, "HDL-32E");
  EXPECT_EQ(resolve_sensor(folder + "/vlp16.yaml", "").name, "VLP-16");
  try {
    static_cast<void>(resolve_sensor("hdl33", folder, "x.yaml:3: sensor"));
    ADD_FAILURE() << "accepted";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(
        error.what(),
        "x.yaml:3: sensor = 'hdl33': must be a .yaml file or one of HDL-32E, HDL-64E, LMS111, "
        "OS1-64, VLP-16 (" +
            folder + ")");
  }
  try {
    static_cast<void>(resolve_sensor("none.yaml", folder, "x.yaml:3: sensor"));
    ADD_FAILURE() << "accepted";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "x.yaml:3: sensor = 'none.yaml': there is no such file");
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
