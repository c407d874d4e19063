// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/eval/paper_experiments.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mrpt_terrain/eval/paper_tables.h"
#include "mrpt_terrain/sim/scene.h"
#include "paper_scenes.h"
#include "test_files.h"

namespace mrpt_terrain::eval {
namespace {

using worlds::radians;
using worlds::ramp_and_box;

constexpr double kRampAngle = radians(15.0);

PlaneEstimators three_estimators() {
  PlaneEstimators list;
  list.push_back(pca_estimator());
  list.push_back(least_squares_estimator());
  list.push_back(paper_estimator({}));
  return list;
}

TrialPlan plan_of(std::size_t trials, double range_sigma) {
  TrialPlan plan;
  plan.trials = trials;
  plan.conditions.range_sigma = range_sigma;
  plan.with_beam = true;
  return plan;
}

std::vector<double> angles(const std::vector<Trial>& trials) {
  std::vector<double> result;
  for (const Trial& trial : trials) {
    for (const PlaneEstimate& plane : trial[0].planes) result.push_back(plane.angle);
    result.push_back(trial[0].beam.angle);
    result.push_back(trial[1].description.height.h_f);
  }
  return result;
}

TEST(PaperExperiments, WithoutNoiseAllSayTheTruth) {
  const PaperScene scene = ramp_and_box(kRampAngle);
  const auto trials = run_trials(scene, three_estimators(), plan_of(3, 0.0), {});
  ASSERT_EQ(trials.size(), 3U);
  for (const Trial& trial : trials) {
    ASSERT_EQ(trial.size(), 2U);
    ASSERT_EQ(trial[0].planes.size(), 3U);
    // Floats of a few metres are rounded by 1.2e-7 m, over a ramp of a metre.
    for (const PlaneEstimate& plane : trial[0].planes) EXPECT_NEAR(plane.angle, kRampAngle, 2e-6);
    EXPECT_EQ(trial[0].beam.status, FeatureStatus::kOk);
    EXPECT_NEAR(trial[0].beam.angle, kRampAngle, 2e-6);
    EXPECT_NEAR(trial[0].beam_to_ground.angle, kRampAngle, 2e-6);
    EXPECT_EQ(trial[0].description.terrain_class, TerrainClass::kSlope);
    EXPECT_GE(trial[1].clusters, 1);
    EXPECT_NEAR(trial[1].description.height.h_f, 0.3, 0.1);
  }
}

TEST(PaperExperiments, ATrialDependsOnItsNumberAloneNotOnThreads) {
  const PaperScene scene = ramp_and_box(kRampAngle);
  TrialPlan plan = plan_of(6, 0.01);
  plan.conditions.tilt_sigma = radians(0.1);
  const std::vector<double> one = angles(run_trials(scene, three_estimators(), plan, {}));
  plan.threads = 3;
  EXPECT_EQ(angles(run_trials(scene, three_estimators(), plan, {})), one);
  plan.trials = 2;
  const std::vector<double> two = angles(run_trials(scene, three_estimators(), plan, {}));
  EXPECT_EQ(two, std::vector<double>(one.begin(), one.begin() + static_cast<long>(two.size())));
  plan.seed = 2;
  EXPECT_NE(angles(run_trials(scene, three_estimators(), plan, {})), two);
}

TEST(PaperExperiments, TrialsDifferAmongEachOther) {
  const PaperScene scene = ramp_and_box(kRampAngle);
  const auto trials = run_trials(scene, three_estimators(), plan_of(4, 0.005), {});
  for (std::size_t k = 1; k < trials.size(); ++k) {
    EXPECT_NE(trials[k][0].planes[0].angle, trials[0][0].planes[0].angle);
  }
}

// Pitch adds to the angle of a ramp ahead, and the ground tilts along: 40 trials give the standard
// deviation of 0.5 deg to 11 %; four times that is 0.45 of it.
TEST(PaperExperiments, TiltMovesTheAngleAgainstTheHorizontalButNotAgainstTheGround) {
  const PaperScene scene = ramp_and_box(kRampAngle);
  TrialPlan plan = plan_of(40, 0.001);
  plan.conditions.tilt_sigma = radians(0.5);
  double horizontal = 0.0;
  double ground = 0.0;
  for (const Trial& trial : run_trials(scene, {}, plan, {})) {
    ASSERT_EQ(trial[0].beam_to_ground.status, FeatureStatus::kOk);
    horizontal += std::pow(trial[0].beam.angle - kRampAngle, 2) / 40.0;
    ground += std::pow(trial[0].beam_to_ground.angle - kRampAngle, 2) / 40.0;
  }
  EXPECT_NEAR(std::sqrt(horizontal), radians(0.5), radians(0.225));
  EXPECT_LT(std::sqrt(ground), radians(0.05));
}

TEST(PaperExperiments, SlowEstimatorsSeeTheFirstTrialsOnly) {
  const PaperScene scene = ramp_and_box(kRampAngle);
  TrialPlan plan = plan_of(4, 0.005);
  plan.limits["least_squares"] = 2;
  const auto trials = run_trials(scene, three_estimators(), plan, {});
  for (std::size_t k = 0; k < trials.size(); ++k) {
    EXPECT_EQ(trials[k][0].planes[0].status, FeatureStatus::kOk);
    EXPECT_EQ(trials[k][0].planes[1].status,
              k < 2 ? FeatureStatus::kOk : FeatureStatus::kNotNeeded);
  }
}

TEST(PaperExperiments, WhatIsNotSeenIsNotMeasured) {
  PaperScene scene = ramp_and_box(kRampAngle);
  sim::WorldSolid unseen;
  unseen.id = 9;
  scene.world->solids.push_back(unseen);
  scene.targets.push_back({"unseen", {9}, 1.0, 0.0});
  const auto trials = run_trials(scene, three_estimators(), plan_of(1, 0.0), {});
  EXPECT_EQ(trials[0][2].clusters, 0);
  EXPECT_TRUE(trials[0][2].planes.empty());
  EXPECT_FALSE(height_indices(trials, 2)[0].has_value());
}

// The cluster with most of the ramp's returns is measured, and it has most of the points of the
// ramp that lie above T_high.
TEST(PaperExperiments, OfSeveralClustersTheOneWithMostReturnsIsMeasured) {
  const PaperScene scene = ramp_and_box(radians(7.74));
  const auto trials = run_trials(scene, {}, plan_of(1, 0.0), {});
  const ScanPicture picture = scan_picture(scene, plan_of(1, 0.0));
  ASSERT_GT(trials[0][0].clusters, 1) << "the far rings of a gentle ramp are clusters of their own";
  std::size_t in_cluster = 0;
  std::size_t elsewhere = 0;
  for (std::size_t i = 0; i < picture.points.size(); ++i) {
    if (picture.source[i] != 0) continue;
    in_cluster += picture.cluster[i] == 0 ? 1 : 0;
    elsewhere += picture.cluster[i] == ScanPicture::kOther ? 1 : 0;
  }
  EXPECT_GT(elsewhere, 0U);
  EXPECT_GT(in_cluster, elsewhere);
}

TEST(PaperExperiments, ProgressIsToldAndCanStop) {
  const PaperScene scene = ramp_and_box(kRampAngle);
  std::size_t calls = 0;
  const auto all = run_trials(scene, {}, plan_of(2, 0.0), [&](std::size_t done) {
    ++calls;
    return done <= 2;
  });
  EXPECT_EQ(all.size(), 2U);
  EXPECT_GT(calls, 0U);
  EXPECT_TRUE(
      run_trials(scene, {}, plan_of(100000, 0.0), [](std::size_t) { return false; }).empty());
}

TEST(PaperExperiments, ErrorsInTrialsReachTheCaller) {
  PaperScene scene = ramp_and_box(kRampAngle);
  scene.sensor.model.columns = 0;  // cannot be simulated
  TrialPlan plan = plan_of(4, 0.0);
  plan.threads = 2;
  EXPECT_THROW((void)run_trials(scene, {}, plan, {}), std::invalid_argument);
}

TEST(PaperExperiments, ScenesAreReadWithTheirTruth) {
  const std::string folder = MRPT_TERRAIN_SOURCE_DIR "/params/";
  const PaperScene scene = load_paper_scene(folder + "scenes/paper_height_index.yaml",
                                            folder + "sensors", {{"obstacle", {1}}, {"hole", {2}}});
  EXPECT_EQ(scene.name, "paper_height_index");
  EXPECT_NEAR(scene.targets[0].height, 0.15, 1e-12);
  EXPECT_NEAR(scene.targets[1].height, -0.09, 1e-12);
  EXPECT_NEAR(scene.sensor.T_robot_sensor.translation().z(), 0.81, 1e-12);
  const auto message = test::message_of<sim::SceneError>([&] {
    (void)load_paper_scene(folder + "scenes/paper_height_index.yaml", folder + "sensors",
                           {{"nothing", {99}}});
  });
  EXPECT_TRUE(test::contains(message, "paper_height_index.yaml: solids: id = 99: must be"))
      << message;
}

}  // namespace
}  // namespace mrpt_terrain::eval
