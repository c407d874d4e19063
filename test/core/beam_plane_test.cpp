// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/beam_plane.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "beam_worlds.h"

namespace mrpt_terrain {
namespace {

using worlds::radians;

const Eigen::Vector3d kCentre(2.0, 0.0, 0.3);

BeamPoints beam_points(const Points& points) {
  BeamPoints result;
  result.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    result.set(i, {points.x[i], points.y[i], points.z[i]}, worlds::kLidarOrigin,
               kCentre.cast<float>());
  }
  result.normalise_beams();
  return result;
}

// Lattice on the plane z = tan(angle) (x - 1.25).
Points ramp(double angle, double sigma, std::uint64_t seed) {
  RandomGenerator random(seed);
  Points points;
  worlds::add_surface(points, {1.5, 2.5, -0.5, 0.5}, 0.04,
                      [&](double x, double) { return std::tan(angle) * (x - 1.25); });
  worlds::add_beam_noise(points, sigma, random);
  return points;
}

BeamPlane true_plane(double angle) {
  const Eigen::Vector3d normal(-std::sin(angle), 0.0, std::cos(angle));
  return {normal, -normal.dot(Eigen::Vector3d(1.25, 0.0, 0.0) - kCentre)};
}

double angle_of(const BeamPlane& plane) { return std::acos(std::abs(plane.normal.z())); }

// Analytic: without noise the plane is exact, from a start that is 3 degrees and 3 cm off.
TEST(BeamPlane, ExactPointsGiveTheirPlane) {
  const BeamPoints points = beam_points(ramp(0.3, 0.0, 1));
  BeamPlane start = true_plane(0.35);
  start.offset += 0.03;
  const BeamPlaneFit fit = fit_beam_plane(points, start, 0.05, 1e-4, 8);
  ASSERT_TRUE(fit.ok);
  EXPECT_NEAR(angle_of(fit.plane), 0.3, 1e-6);
  EXPECT_NEAR(fit.plane.offset, true_plane(0.3).offset, 1e-6);
  EXPECT_EQ(fit.inliers, 625);
}

// A piece of one ring on level ground 3 m away: the shorter, the less it says about the inclination
// towards the sensor. Those of less than 0.2 m may as well lie in a plane through the sensor.
BeamPoints arc(double half_width, std::uint64_t seed) {
  RandomGenerator random(seed);
  Points points;
  for (int k = -30; k <= 30; ++k) {
    const double azimuth = half_width * k / 30.0;
    points.push_back(static_cast<float>(3.0 * std::cos(azimuth)),
                     static_cast<float>(3.0 * std::sin(azimuth)), 0.0F);
  }
  worlds::add_beam_noise(points, 0.02, random);
  return beam_points(points);
}

// Invariant: a fit that calls itself converged and certain lies within four of its standard
// deviations of the truth; others do not have to. Short arcs are where steps run away.
TEST(BeamPlane, ShortArcsAreFittedOrKnownNotToBe) {
  const BeamPlane level{Eigen::Vector3d::UnitZ(), kCentre.z()};
  int certain = 0;
  int wrong = 0;
  int open = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    const BeamPoints points = arc(0.08 + 0.0014 * static_cast<double>(seed), seed);
    BeamPlane start = level;
    start.normal = Eigen::Vector3d(-0.05, 0.0, 1.0).normalized();
    const BeamPlaneFit fit = fit_beam_plane(points, start, 0.03, 0.002, 5);
    const double sigma = std::sqrt(fit.normal_covariance.trace());
    if (!fit.ok || !fit.converged || sigma > 0.035) {
      ++open;
      continue;
    }
    ++certain;
    wrong += angle_of(fit.plane) > 4.0 * sigma;
  }
  EXPECT_GT(certain, 100);
  EXPECT_GT(open, 50);
  EXPECT_LE(wrong, 1);
}

// Closed form: the means of 16 points have a quarter of the noise; told so, the fit finds the noise
// of single points, states its own error, and is better than one that takes all points for equal.
TEST(BeamPlane, MeansOfManyPointsCountAsMany) {
  constexpr int kTrials = 300;
  double squares_told = 0.0;
  double squares_untold = 0.0;
  double sigma = 0.0;
  int covered = 0;
  for (std::uint64_t seed = 1; seed <= kTrials; ++seed) {
    const Points single = ramp(0.3, 0.02, seed);
    const Points means = ramp(0.3, 0.005, seed + 1000);
    Points mixed;
    for (std::size_t i = 0; i < single.size(); ++i) {
      const Points& source = i % 3 == 0 ? means : single;
      mixed.push_back(source.x[i], source.y[i], source.z[i]);
    }
    BeamPoints points = beam_points(mixed);
    const BeamPlaneFit untold = fit_beam_plane(points, true_plane(0.3), 0.02, 1e-4, 5);
    for (std::size_t i = 0; i < points.size; i += 3) points.count[i] = 16.0F;
    const BeamPlaneFit told = fit_beam_plane(points, true_plane(0.3), 0.02, 1e-4, 5);
    const double error = angle_of(told.plane) - 0.3;
    const Eigen::Vector3d up(std::cos(0.3), 0.0, std::sin(0.3));
    covered += error * error <= 4.0 * up.dot(told.normal_covariance * up);
    squares_told += error * error;
    squares_untold += std::pow(angle_of(untold.plane) - 0.3, 2);
    sigma += told.range_sigma / kTrials;
  }
  EXPECT_NEAR(sigma, 0.02, 0.0005);
  EXPECT_NEAR(static_cast<double>(covered) / kTrials, 0.9545, 0.035);
  EXPECT_LT(squares_told, 0.3 * squares_untold);
}

// Oracle: the maximum likelihood estimate by brute force over the ranges r = 1 / (m . d), in
// double, without weights. Noise of 5 mm leaves no outliers; Tukey's weights and the share of
// isotropic noise move the result by a small part of its standard deviation.
TEST(BeamPlane, AgreesWithLeastSquaresOfRanges) {
  const Points cloud = ramp(0.25, 0.005, 3);
  const BeamPlaneFit fit = fit_beam_plane(beam_points(cloud), true_plane(0.25), 0.005, 1e-4, 8);
  ASSERT_TRUE(fit.ok);
  const Eigen::Vector3d origin(0.0, 0.0, 0.81);
  BeamPlane start = true_plane(0.25);
  Eigen::Vector3d m = -start.normal / (start.offset + start.normal.dot(origin - kCentre));
  for (int step = 0; step < 20; ++step) {
    Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
    Eigen::Vector3d vector = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Eigen::Vector3d p = Eigen::Vector3d(cloud.x[i], cloud.y[i], cloud.z[i]) - origin;
      const Eigen::Vector3d d = p.normalized();
      const double predicted = 1.0 / m.dot(d);
      const Eigen::Vector3d jacobian = predicted * predicted * d;
      matrix += jacobian * jacobian.transpose();
      vector += jacobian * (p.norm() - predicted);
    }
    m -= matrix.ldlt().solve(vector);
  }
  const double sigma = std::sqrt(fit.normal_covariance.trace());
  EXPECT_LT((m.normalized().cwiseAbs() - fit.plane.normal.cwiseAbs()).norm(), 0.2 * sigma);
}

// Analytic: the estimate of the noise has a relative standard deviation of 1 / sqrt(2 n) = 3 %.
TEST(BeamPlane, FindsTheNoiseAlongTheBeam) {
  for (const double sigma : {0.002, 0.02}) {
    const BeamPlaneFit fit =
        fit_beam_plane(beam_points(ramp(0.3, sigma, 5)), true_plane(0.3), 0.01, 1e-4, 8);
    ASSERT_TRUE(fit.ok);
    EXPECT_NEAR(fit.range_sigma, sigma, 0.1 * sigma);
    std::vector<float> scratch;
    EXPECT_NEAR(median_range_sigma(beam_points(ramp(0.3, sigma, 5)), true_plane(0.3), 1, scratch),
                sigma, 0.2 * sigma);
  }
}

// Analytic: over 400 trials the mean error is within 4 standard errors of 0, and the stated
// standard deviation covers as often as a normal distribution says (95.4 +- 1.05 %, 4 sigma).
TEST(BeamPlane, IsUnbiasedAndStatesItsUncertainty) {
  const double truth = 0.2;
  double sum = 0.0, squares = 0.0;
  int covered = 0;
  const int trials = 400;
  for (int k = 0; k < trials; ++k) {
    const BeamPlaneFit fit =
        fit_beam_plane(beam_points(ramp(truth, 0.02, 100 + static_cast<std::uint64_t>(k))),
                       true_plane(truth), 0.02, 1e-4, 5);
    ASSERT_TRUE(fit.ok);
    const double error = angle_of(fit.plane) - truth;
    const Eigen::Vector3d turn(std::cos(truth), 0.0, std::sin(truth));
    sum += error;
    squares += error * error;
    covered += std::abs(error) <= 2.0 * std::sqrt(turn.dot(fit.normal_covariance * turn)) ? 1 : 0;
  }
  const double deviation = std::sqrt(squares / trials);
  EXPECT_LT(std::abs(sum / trials), 4.0 * deviation / std::sqrt(trials));
  EXPECT_NEAR(covered / static_cast<double>(trials), 0.954, 0.042);
}

// Invariant: points that lie far off the plane change nothing.
TEST(BeamPlane, OutliersDoNotCount) {
  Points points = ramp(0.3, 0.005, 7);
  const BeamPlaneFit clean = fit_beam_plane(beam_points(points), true_plane(0.3), 0.01, 1e-4, 8);
  for (int k = 0; k < 200; ++k) worlds::add_point(points, 2.0 + 0.001 * k, 0.1, 0.6);
  const BeamPlaneFit fit = fit_beam_plane(beam_points(points), true_plane(0.3), 0.01, 1e-4, 8);
  ASSERT_TRUE(fit.ok);
  EXPECT_EQ(fit.inliers, clean.inliers);
  EXPECT_LT((fit.plane.normal - clean.plane.normal).norm(), 1e-6);
}

TEST(BeamPlane, PointsOfWeightZeroDoNotCount) {
  BeamPoints points = beam_points(ramp(0.3, 0.005, 7));
  for (std::size_t k = 0; k < 300; ++k) points.count[k] = 0.0F;
  EXPECT_EQ(fit_beam_plane(points, true_plane(0.3), 0.01, 1e-4, 2).inliers, 325);
}

// No beam meets a plane through the sensor; the fit is then one of least squares along the normal.
TEST(BeamPlane, PlanesThroughTheSensorAreNoSpecialCase) {
  RandomGenerator random(9);
  Points points;
  for (int k = 0; k < 800; ++k) {
    worlds::add_point(points, 1.5 + random.uniform(), 0.002 * worlds::normal_deviate(random),
                      0.6 * random.uniform());
  }
  worlds::add_beam_noise(points, 0.02, random);
  const BeamPlane start{Eigen::Vector3d(0.05, 1.0, 0.05).normalized(), 0.0};
  const BeamPlaneFit fit = fit_beam_plane(beam_points(points), start, 0.05, 1e-4, 8);
  ASSERT_TRUE(fit.ok);
  EXPECT_NEAR(angle_of(fit.plane), radians(90.0), radians(0.2));
}

TEST(BeamPlane, PointsOnALineSpanNoPlane) {
  Points points;
  for (int k = 0; k < 50; ++k) worlds::add_point(points, 1.5 + 0.02 * k, 0.0, 0.3);
  EXPECT_FALSE(
      fit_beam_plane(beam_points(points), {Eigen::Vector3d::UnitZ(), 0.0}, 0.01, 1e-4, 3).ok);
  EXPECT_FALSE(fit_beam_plane(BeamPoints{}, true_plane(0.1), 0.01, 1e-4, 3).ok);
}

// Closed form: a beam from (0, 0, 0.81) straight ahead and 45 degrees down meets z = 0 at x = 0.81,
// wherever along it the point was measured.
TEST(BeamPlane, CellsAreThoseWhereBeamsMeetThePlane) {
  const GridGeometry geometry(5.0, 5.0, 0.05);
  BeamPoints points;
  points.resize(3);
  points.set(0, {0.70F, 0.0F, 0.11F}, worlds::kLidarOrigin, {0, 0, 0});
  points.set(1, {0.90F, 0.0F, -0.09F}, worlds::kLidarOrigin, {0, 0, 0});
  points.set(2, {40.0F, 0.0F, 0.0F}, worlds::kLidarOrigin, {0, 0, 0});
  points.normalise_beams();
  const BeamPlane floor{Eigen::Vector3d::UnitZ(), 0.0};
  const BeamPlane deep{Eigen::Vector3d::UnitZ(), 1.0};
  std::vector<std::int32_t> cells;
  find_meeting_cells(points, floor, deep, 0.5, geometry, Eigen::Vector3d::Zero(), 1, cells);
  CellIndex cell;
  ASSERT_TRUE(geometry.cell_at(0.8101, 0.0, cell));
  EXPECT_EQ(cells[0], value_of(geometry.id_of(cell)));
  EXPECT_EQ(cells[1], value_of(geometry.id_of(cell)));
  EXPECT_FALSE(geometry.contains(geometry.index_of(CellId{cells[2]}))) << "outside the grid";
  find_meeting_cells(points, floor, floor, 0.01, geometry, Eigen::Vector3d::Zero(), 1, cells);
  EXPECT_EQ(cells[0], 0) << "too close to the ground";
}

}  // namespace
}  // namespace mrpt_terrain
