// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/slope.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <vector>

#include "mrpt_terrain/core/random.h"
#include "worlds.h"

namespace mrpt_terrain {
namespace {

using worlds::radians;

Slope slope_of(const Points& points, const SlopeParams& params = {}, std::uint64_t stream = 0) {
  std::vector<std::int32_t> members(points.size());
  std::iota(members.begin(), members.end(), 0);
  SlopeWorkspace workspace;
  return estimate_slope(points.view(), {members.data(), members.data() + members.size()}, params,
                        stream, workspace);
}

Points ramp(double angle, double sigma, std::uint64_t seed) {
  RandomGenerator random(seed);
  Points points;
  worlds::add_ramp(points, {1.25, 2.25, -0.5, 0.5}, 0.025, angle, sigma, random);
  return points;
}

// Literal: z = 3 x / 4 + 1 through four points.
TEST(Slope, PlaneByHand) {
  Points points;
  for (const auto& [x, y] : {std::array<float, 2>{0, 0}, {4, 0}, {0, 4}, {4, 4}}) {
    points.push_back(x, y, 0.75F * x + 1.0F);
  }
  const Slope slope = slope_of(points);
  ASSERT_EQ(slope.status, FeatureStatus::kOk);
  EXPECT_NEAR(slope.angle, std::atan(0.75), 1e-7);
  EXPECT_NEAR((slope.normal - Eigen::Vector3d(-0.6, 0.0, 0.8)).norm(), 0.0, 1e-7);
  EXPECT_NEAR(slope.offset, -0.8, 1e-7);
  EXPECT_EQ(slope.inliers, 4);
  EXPECT_EQ(slope.points, 4);
  EXPECT_EQ(slope.iterations, 1);
}

// Analytic: coordinates are floats of at most 2.25 m, wrong by at most 1.2e-7 m; over a standard
// deviation of 0.29 m along the slope that is less than 1e-6 rad.
TEST(Slope, ExactRampsHaveTheirAngle) {
  for (const double degrees : {0.0, 7.74, 13.86, 18.51, 45.0, 69.0, 71.0, 80.0}) {
    const Slope slope = slope_of(ramp(radians(degrees), 0.0, 1));
    ASSERT_EQ(slope.status, FeatureStatus::kOk) << degrees;
    EXPECT_NEAR(slope.angle, radians(degrees), degrees == 0.0 ? 1e-6 : 2e-6) << degrees;
    EXPECT_EQ(slope.inliers, slope.points);
  }
}

// Analytic: noise s over n points gives the angle a standard deviation of s / (sqrt(n) sx); that
// is 4.3e-4 rad here. RANSAC may stop with up to 1 % of the points missing, which moves the least
// squares by at most 0.01 * 0.6 m * 4 s / sx^2 = 1.5e-3 rad.
TEST(Slope, NoisyRampsHaveTheirAngle) {
  SlopeParams params;
  params.inlier_share = 0.99;
  for (const double degrees : {7.74, 13.86, 18.51}) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const Slope slope = slope_of(ramp(radians(degrees), 0.005, seed), params);
      ASSERT_EQ(slope.status, FeatureStatus::kOk);
      EXPECT_NEAR(slope.angle, radians(degrees), 5 * 4.3e-4 + 1.5e-3) << degrees << " " << seed;
    }
  }
}

/// Exact ramp of 18.51 deg with `extra` points spread 0.1 to 0.6 m above it.
Points cluttered_ramp(int extra, std::uint64_t seed) {
  Points points = ramp(radians(18.51), 0.0, seed);
  RandomGenerator random(seed);
  for (int i = 0; i < extra; ++i) {
    const double x = 1.25 + random.uniform();
    const double y = random.uniform() - 0.5;
    const double above = 0.1 + 0.5 * random.uniform();
    worlds::add_point(points, x, y, (x - 1.25) * std::tan(radians(18.51)) + above);
  }
  return points;
}

// Clutter starts 0.1 cos(18.51 deg) m from the ramp, far beyond T_q = 2 cm, so that the inliers are
// exactly the ramp.
TEST(Slope, ClutterOnARampDoesNotTiltIt) {
  const Slope slope = slope_of(cluttered_ramp(700, 2));
  ASSERT_EQ(slope.status, FeatureStatus::kOk);
  EXPECT_EQ(slope.inliers, 1600);
  EXPECT_EQ(slope.points, 2300);
  EXPECT_NEAR(slope.angle, radians(18.51), 2e-6);
}

// Row "Algorithm 2 line 24": the fit takes the inliers of the best hypothesis. With two thirds of
// the points on the ramp, the last of many hypotheses lies on it with probability 0.3 only: twenty
// seeds cannot all be lucky.
TEST(PaperReading, FitTakesTheBestInliersNotTheLast) {
  SlopeParams params;
  params.inlier_share = 1.0;  // runs to the end
  params.max_iterations = 200;
  for (params.seed = 1; params.seed <= 20; ++params.seed) {
    const Slope slope = slope_of(cluttered_ramp(800, 3), params);
    ASSERT_EQ(slope.status, FeatureStatus::kOk);
    EXPECT_EQ(slope.iterations, 200);
    EXPECT_NEAR(slope.angle, radians(18.51), 2e-6) << "seed " << params.seed;
  }
}

// Row "stop rule": the share must exceed T_Inlier. 15 of 20 points are on one plane.
TEST(PaperReading, RansacStopsWhenTheShareExceedsTInlier) {
  Points points;
  for (int i = 0; i < 15; ++i) {
    points.push_back(static_cast<float>(i % 4), static_cast<float>(i / 4), 0.0F);
  }
  for (int i = 0; i < 5; ++i)
    points.push_back(0.3F * static_cast<float>(i * i), 1.0F, 5.0F + 3.0F * static_cast<float>(i));
  SlopeParams params;
  params.max_iterations = 500;
  params.inlier_share = 0.75;
  EXPECT_EQ(slope_of(points, params).iterations, 500);
  params.inlier_share = 0.7499;
  const Slope stopped = slope_of(points, params);
  EXPECT_LT(stopped.iterations, 500);
  EXPECT_EQ(stopped.inliers, 15);
}

// Row "point-plane distance": the normal has length one, whatever the triangle's size. On a lattice
// of 5 x 5 points one stands out by three times T_q and one by half of it; no plane holds all,
// since the middle of eight neighbours is at most T_q above a plane that holds them.
TEST(PaperReading, DistancesAreMetresWhateverTheSizeOfTheTriangle) {
  for (const float scale : {0.1F, 1.0F, 10.0F, 100.0F}) {
    Points points;
    for (int i = 0; i < 25; ++i) {
      const float z = i == 12 ? 0.06F : (i == 6 ? 0.01F : 0.0F);
      points.push_back(scale * static_cast<float>(i % 5), scale * static_cast<float>(i / 5), z);
    }
    SlopeParams params;
    params.inlier_share = 1.0;
    EXPECT_EQ(slope_of(points, params).inliers, 24) << scale;
  }
}

// The same row: triples of repeated indices are not drawn. With three points the first triple is
// the only one there is.
TEST(PaperReading, NoIndexIsRepeatedInATriple) {
  Points points;
  points.push_back(0.0F, 0.0F, 0.0F);
  points.push_back(1.0F, 0.0F, 0.5F);
  points.push_back(0.0F, 1.0F, 0.0F);
  SlopeParams params;
  for (params.seed = 1; params.seed <= 100; ++params.seed) {
    const Slope slope = slope_of(points, params);
    ASSERT_EQ(slope.status, FeatureStatus::kOk) << "seed " << params.seed;
    EXPECT_EQ(slope.iterations, 1) << "seed " << params.seed;
  }
}

// The same row: points on one line span no plane. One of the four triples is collinear; it must
// never be the best hypothesis.
TEST(PaperReading, CollinearTriplesAreRejected) {
  Points points;
  for (int i = 0; i < 3; ++i) points.push_back(static_cast<float>(i), 0.0F, static_cast<float>(i));
  EXPECT_EQ(slope_of(points).status, FeatureStatus::kDegenerate);
  points.push_back(1.0F, 1.0F, 1.0F);
  SlopeParams params;
  for (params.seed = 1; params.seed <= 100; ++params.seed) {
    const Slope slope = slope_of(points, params);
    ASSERT_EQ(slope.status, FeatureStatus::kOk);
    EXPECT_NEAR(slope.angle, radians(45.0), 1e-6);
  }
}

// The same row, with rounding: sixty points on a line, as floats never exactly, and twenty beside
// it on one plane of 30 deg. Triples of the line would fix any plane through it, hold three
// quarters of the points and stop the search.
TEST(PaperReading, NearlyCollinearTriplesAreRejected) {
  Points points;
  for (int i = 0; i < 80; ++i) {
    const double x = 0.0137 * i + 1.1;
    const double y = 0.61803 * x + (i < 60 ? 0.0 : 0.1 * (i % 7 + 1));
    worlds::add_point(points, x, y, x * std::tan(radians(30.0)));
  }
  SlopeParams params;
  params.inlier_share = 0.7;
  for (params.seed = 1; params.seed <= 100; ++params.seed) {
    const Slope slope = slope_of(points, params);
    ASSERT_EQ(slope.status, FeatureStatus::kOk) << "seed " << params.seed;
    EXPECT_EQ(slope.inliers, 80) << "seed " << params.seed;
    EXPECT_NEAR(slope.angle, radians(30.0), 1e-5) << "seed " << params.seed;
  }
}

// Row "eq. (6)": the angle is that between planes, 0 to 90 deg, uphill or downhill in any
// direction.
TEST(PaperReading, AnglesLieBetweenZeroAndNinetyDegrees) {
  for (const double degrees : {5.0, 30.0, 60.0, 85.0}) {
    Points points = ramp(radians(degrees), 0.0, 4);
    for (int quarter = 0; quarter < 4; ++quarter) {
      for (const float sign : {1.0F, -1.0F}) {
        Points turned = points;
        for (float& z : turned.z) z *= sign;
        const Slope slope = slope_of(turned);
        ASSERT_EQ(slope.status, FeatureStatus::kOk);
        EXPECT_NEAR(slope.angle, radians(degrees), 2e-5) << degrees << " " << quarter << sign;
        EXPECT_GE(slope.normal.z(), 0.0);
        EXPECT_NEAR(slope.normal.norm(), 1.0, 1e-12);
      }
      points = worlds::turned_left(points);
    }
  }
}

Points noisy_wall(std::uint64_t seed) {
  RandomGenerator random(seed);
  Points points;
  worlds::add_wall(points, 1.5, -0.5, 0.5, 1.0, 0.025, 0.02, random);
  return points;
}

// Row "near-vertical clusters". Analytic: noise s = 2 cm over n = 1600 points turns the normal by
// s / (sqrt(n) sz) = 1.7e-3 rad; the points beyond T_q that RANSAC leaves out, at most 5 % of them
// 0.6 m from the middle and T_q away, turn it by 0.05 * 0.6 * 0.06 / sz^2 = 0.022 rad.
TEST(PaperReading, NearVerticalClustersAreFittedByTotalLeastSquares) {
  SlopeParams params;
  params.inlier_distance = 0.06;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Slope slope = slope_of(noisy_wall(seed), params);
    ASSERT_EQ(slope.status, FeatureStatus::kOk);
    EXPECT_NEAR(slope.angle, radians(90.0), 5 * 1.7e-3 + 0.022) << "seed " << seed;
  }
}

// The same row: z = A x + B y + D regresses on the noise of x and finds nearly anything.
TEST(PaperReading, VerticalFromNinetyDegreesIsThePaperToTheLetter) {
  SlopeParams params;
  params.inlier_distance = 0.06;
  params.vertical_from = radians(90.0);
  double sum = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Slope slope = slope_of(noisy_wall(seed), params);
    ASSERT_EQ(slope.status, FeatureStatus::kOk);
    sum += slope.angle;
  }
  EXPECT_LT(sum / 20, radians(60.0));
}

TEST(Slope, BothFitsAgreeOnAnExactPlane) {
  const Points points = ramp(radians(60.0), 0.0, 5);
  SlopeParams along_normal;
  along_normal.vertical_from = 0.0;
  const Slope a = slope_of(points);
  const Slope b = slope_of(points, along_normal);
  EXPECT_NEAR((a.normal - b.normal).norm(), 0.0, 1e-6);
  EXPECT_NEAR(a.offset, b.offset, 1e-6);
}

// Total least squares and regression along z differ on noise; the switch lies where it says.
TEST(Slope, VerticalFromChoosesTheFit) {
  const Points points = ramp(radians(40.0), 0.01, 6);
  SlopeParams params;
  params.inlier_distance = 0.1;
  params.vertical_from = radians(90.0);
  const double along_z = slope_of(points, params).angle;
  params.vertical_from = 0.0;
  const double along_normal = slope_of(points, params).angle;
  EXPECT_NE(along_z, along_normal);
  params.vertical_from = radians(50.0);
  EXPECT_EQ(slope_of(points, params).angle, along_z);
  params.vertical_from = radians(30.0);
  EXPECT_EQ(slope_of(points, params).angle, along_normal);
}

/// Oracle: all triples, in double.
struct Hypothesis {
  std::vector<int> inliers;
  Eigen::Vector3d normal;  ///< least squares along z on the inliers
};
std::vector<Hypothesis> all_hypotheses(const Points& points, double tolerance) {
  std::vector<Eigen::Vector3d> p;
  for (std::size_t i = 0; i < points.size(); ++i) {
    p.emplace_back(points.x[i], points.y[i], points.z[i]);
  }
  std::vector<Hypothesis> all;
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (std::size_t j = i + 1; j < p.size(); ++j) {
      for (std::size_t k = j + 1; k < p.size(); ++k) {
        const Eigen::Vector3d normal = (p[j] - p[i]).cross(p[k] - p[i]).normalized();
        Hypothesis h;
        for (std::size_t q = 0; q < p.size(); ++q) {
          if (std::abs(normal.dot(p[q] - p[i])) <= tolerance)
            h.inliers.push_back(static_cast<int>(q));
        }
        Eigen::MatrixXd a(h.inliers.size(), 3);
        Eigen::VectorXd b(h.inliers.size());
        for (std::size_t r = 0; r < h.inliers.size(); ++r) {
          const Eigen::Vector3d& point = p[static_cast<std::size_t>(h.inliers[r])];
          a.row(static_cast<Eigen::Index>(r)) << point.x(), point.y(), 1.0;
          b[static_cast<Eigen::Index>(r)] = point.z();
        }
        const Eigen::Vector3d fit = a.colPivHouseholderQr().solve(b);
        h.normal = Eigen::Vector3d(-fit.x(), -fit.y(), 1.0).normalized();
        all.push_back(h);
      }
    }
  }
  return all;
}

// Ten points have 120 triples; a thousand draws miss one of them with probability 2e-4, and nearly
// always several triples share the best set. Tolerance: floats of 1 m, wrong by 6e-8 m, in planes
// through points that may be ten times closer together than their inliers reach.
TEST(Slope, EqualsTheExhaustiveSearchOnSmallClusters) {
  RandomGenerator random(81);
  SlopeParams params;
  params.inlier_share = 1.0;
  params.inlier_distance = 0.05;
  params.vertical_from = radians(90.0);
  int compared = 0;
  for (int k = 0; k < 40; ++k) {
    Points points;
    for (int i = 0; i < 10; ++i) {
      const double x = random.uniform();
      const double y = random.uniform();
      worlds::add_point(points, x, y, 0.3 * x + 0.3 * random.uniform());
    }
    std::size_t best = 0;
    const auto all = all_hypotheses(points, params.inlier_distance);
    for (const Hypothesis& h : all) best = std::max(best, h.inliers.size());
    const Slope slope = slope_of(points, params);
    ASSERT_EQ(static_cast<std::size_t>(slope.inliers), best) << "seed 81, cluster " << k;
    if (best <= 3) {
      EXPECT_EQ(slope.status, FeatureStatus::kNoConsensus);
      continue;
    }
    double nearest = 10.0;
    for (const Hypothesis& h : all) {
      if (h.inliers.size() == best) nearest = std::min(nearest, (h.normal - slope.normal).norm());
    }
    EXPECT_LT(nearest, 1e-5) << "seed 81, cluster " << k;
    ++compared;
  }
  EXPECT_GT(compared, 30);
}

TEST(Slope, PlaneGoesThroughThePoints) {
  const Points points = ramp(radians(20.0), 0.0, 7);
  const Slope slope = slope_of(points);
  for (std::size_t i = 0; i < points.size(); i += 97) {
    EXPECT_NEAR(
        slope.normal.dot(Eigen::Vector3d(points.x[i], points.y[i], points.z[i])) + slope.offset,
        0.0, 1e-6);
  }
}

TEST(Slope, OnlyTheMembersCount) {
  Points points = ramp(radians(10.0), 0.0, 8);
  std::vector<std::int32_t> members;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i % 2 == 0) {
      members.push_back(static_cast<std::int32_t>(i));
    } else {
      points.z[i] = std::numeric_limits<float>::quiet_NaN();
    }
  }
  SlopeWorkspace workspace;
  const Slope slope = estimate_slope(
      points.view(), {members.data(), members.data() + members.size()}, {}, 0, workspace);
  EXPECT_EQ(slope.points, 800);
  EXPECT_NEAR(slope.angle, radians(10.0), 2e-6);
}

// Floats at 450 m are 3e-5 m apart: wrong by 1.5e-5 m, over 0.29 m of spread.
TEST(Slope, FarFromTheOriginOnlyTheInputLosesDigits) {
  const Slope slope = slope_of(worlds::shifted(ramp(radians(15.0), 0.0, 9), 450.0F, -450.0F));
  ASSERT_EQ(slope.status, FeatureStatus::kOk);
  EXPECT_NEAR(slope.angle, radians(15.0), 1e-4);
}

TEST(Slope, SameSeedSameBytesAndWorkspacesLeaveNoTrace) {
  const Points points = cluttered_ramp(900, 10);
  std::vector<std::int32_t> members(points.size());
  std::iota(members.begin(), members.end(), 0);
  const IndexRange all{members.data(), members.data() + members.size()};
  SlopeWorkspace fresh;
  SlopeWorkspace used;
  const Points other = noisy_wall(11);
  (void)estimate_slope(other.view(), {members.data(), members.data() + other.size()}, {}, 3, used);
  const Slope a = estimate_slope(points.view(), all, {}, 5, fresh);
  const Slope b = estimate_slope(points.view(), all, {}, 5, used);
  EXPECT_EQ(std::memcmp(&a.angle, &b.angle, sizeof(double)), 0);
  EXPECT_EQ(a.normal, b.normal);
  EXPECT_EQ(a.offset, b.offset);
  EXPECT_EQ(a.inliers, b.inliers);
  EXPECT_EQ(a.iterations, b.iterations);
}

TEST(Slope, SeedAndStreamChooseTheSequence) {
  const Points points = cluttered_ramp(1500, 12);
  SlopeParams params;
  params.inlier_share = 0.5;
  std::vector<std::int32_t> by_stream;
  std::vector<std::int32_t> by_seed;
  for (std::uint64_t k = 1; k <= 20; ++k) {
    by_stream.push_back(slope_of(points, params, k).iterations);
    SlopeParams other = params;
    other.seed = k;
    by_seed.push_back(slope_of(points, other).iterations);
  }
  EXPECT_NE(by_stream, std::vector<std::int32_t>(20, by_stream.front()));
  EXPECT_NE(by_seed, std::vector<std::int32_t>(20, by_seed.front()));
}

// Table of degenerate clusters.
TEST(Slope, DegenerateClustersSayWhy) {
  using Cloud = std::vector<std::array<float, 3>>;
  struct Case {
    const char* name;
    Cloud points;
    FeatureStatus status;
  };
  Cloud diagonal;
  Cloud upright;
  for (int i = 0; i < 50; ++i) {
    const auto t = static_cast<float>(i);
    diagonal.push_back({0.1F * t + 3.0F, 0.07F * t, 0.03F * t});
    upright.push_back({1.7F, -0.3F, 0.1F * t});
  }
  const std::array<float, 3> p = {0.1F, -1.7F, 0.3F};
  const std::vector<Case> cases = {
      {"no point", {}, FeatureStatus::kTooFewPoints},
      {"one point", {p}, FeatureStatus::kTooFewPoints},
      {"two points", {p, {1, 1, 1}}, FeatureStatus::kTooFewPoints},
      {"three equal points", {p, p, p}, FeatureStatus::kDegenerate},
      {"two of three equal", {p, p, {1, 1, 1}}, FeatureStatus::kDegenerate},
      {"fifty equal points", Cloud(50, p), FeatureStatus::kDegenerate},
      {"a diagonal line", diagonal, FeatureStatus::kDegenerate},
      {"an upright line", upright, FeatureStatus::kDegenerate},
      {"a tetrahedron", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, FeatureStatus::kNoConsensus},
  };
  for (const Case& c : cases) {
    Points points;
    for (const auto& q : c.points) points.push_back(q[0], q[1], q[2]);
    const Slope slope = slope_of(points);
    EXPECT_STREQ(name_of(slope.status), name_of(c.status)) << c.name;
    EXPECT_EQ(slope.points, static_cast<std::int32_t>(c.points.size())) << c.name;
    EXPECT_TRUE(std::isfinite(slope.angle) && slope.normal.allFinite()) << c.name;
  }
}

TEST(Slope, ExactlyUprightWallIsNinetyDegrees) {
  RandomGenerator random(13);
  Points points;
  worlds::add_wall(points, 1.5, -0.5, 0.5, 1.0, 0.05, 0.0, random);
  const Slope slope = slope_of(points);
  ASSERT_EQ(slope.status, FeatureStatus::kOk);
  EXPECT_NEAR(slope.angle, radians(90.0), 1e-6);
}

TEST(Slope, HugeHeightsStayFinite) {
  for (const float huge : {-1e10F, -1e18F, -1e30F, std::numeric_limits<float>::lowest()}) {
    Points points = ramp(radians(10.0), 0.0, 14);
    for (std::size_t i = 0; i < points.size(); i += 3) points.z[i] = huge;
    const Slope slope = slope_of(points);
    EXPECT_TRUE(std::isfinite(slope.angle)) << huge;
    EXPECT_TRUE(slope.normal.allFinite()) << huge;
    EXPECT_TRUE(std::isfinite(slope.offset)) << huge;
  }
}

}  // namespace
}  // namespace mrpt_terrain
