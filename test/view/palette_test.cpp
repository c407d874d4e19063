// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/palette.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace mrpt_terrain::view {
namespace {

using Vector3 = std::array<double, 3>;
using Matrix3 = std::array<Vector3, 3>;

Vector3 product(const Matrix3& matrix, const Vector3& v) {
  Vector3 result{};
  for (std::size_t k = 0; k < 3; ++k) {
    result[k] = matrix[k][0] * v[0] + matrix[k][1] * v[1] + matrix[k][2] * v[2];
  }
  return result;
}

double linear(double channel) {
  const double c = channel / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

double lab_curve(double t) {
  return t > 216.0 / 24389.0 ? std::cbrt(t) : t * 841.0 / 108.0 + 4.0 / 29.0;
}

/// CIE 1976 Lab (D65) of a colour as an eye with the given cone response sees it.
Vector3 lab(Rgb colour, const Matrix3& vision) {
  constexpr Matrix3 kToXyz{{{0.4124564, 0.3575761, 0.1804375},
                            {0.2126729, 0.7151522, 0.0721750},
                            {0.0193339, 0.1191920, 0.9503041}}};
  Vector3 seen = product(vision, {linear(colour.r), linear(colour.g), linear(colour.b)});
  for (double& channel : seen) channel = std::min(1.0, std::max(0.0, channel));
  const Vector3 xyz = product(kToXyz, seen);
  const double x = lab_curve(xyz[0] / 0.95047);
  const double y = lab_curve(xyz[1]);
  const double z = lab_curve(xyz[2] / 1.08883);
  return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

double distance(const Vector3& a, const Vector3& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

constexpr Matrix3 kNormal{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

/// Machado, Oliveira, Fernandes 2009, severity 1.0.
const std::vector<Matrix3>& visions() {
  static const std::vector<Matrix3> kVisions{kNormal,
                                             {{{0.152286, 1.052583, -0.204868},
                                               {0.114503, 0.786281, 0.099216},
                                               {-0.003882, -0.048116, 1.051998}}},
                                             {{{0.367322, 0.860646, -0.227968},
                                               {0.280085, 0.672501, 0.047413},
                                               {-0.011820, 0.042940, 0.968881}}},
                                             {{{1.255528, -0.076749, -0.178779},
                                               {-0.078411, 0.930809, 0.147602},
                                               {0.004733, 0.691367, 0.303900}}}};
  return kVisions;
}

// A difference of 2.3 in Lab is just noticeable; ten times that is a different colour at a glance.
TEST(Palette, ClassesStayApartForEveryColourVision) {
  const std::array<TerrainClass, 4> classes{{TerrainClass::kSlope, TerrainClass::kPothole,
                                             TerrainClass::kObstacle, TerrainClass::kOther}};
  for (std::size_t vision = 0; vision < visions().size(); ++vision) {
    for (std::size_t a = 0; a < classes.size(); ++a) {
      const auto colour = lab(colour_of(classes[a]), visions()[vision]);
      EXPECT_GT(distance(colour, lab(kGroundColour, visions()[vision])), 23.0) << vision;
      EXPECT_GT(distance(colour, lab(kUnobservedColour, visions()[vision])), 23.0) << vision;
      for (std::size_t b = 0; b < a; ++b) {
        EXPECT_GT(distance(colour, lab(colour_of(classes[b]), visions()[vision])), 23.0)
            << name_of(classes[a]) << " and " << name_of(classes[b]) << ", vision " << vision;
      }
    }
  }
}

TEST(Palette, BackgroundKindsAreStillDistinguishable) {
  const std::array<Rgb, 3> kinds{{kGroundColour, kDroppedColour, kUnobservedColour}};
  for (const auto& vision : visions()) {
    for (std::size_t a = 0; a < kinds.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        EXPECT_GT(distance(lab(kinds[a], vision), lab(kinds[b], vision)), 10.0);
      }
    }
  }
}

TEST(Palette, HeightStepsLookEquallyLargeAndGetLighter) {
  constexpr int kSteps = 20;
  std::vector<double> lengths;
  double total = 0.0;
  for (int k = 0; k < kSteps; ++k) {
    const auto from = lab(height_colour(static_cast<double>(k) / kSteps), kNormal);
    const auto to = lab(height_colour((k + 1.0) / kSteps), kNormal);
    EXPECT_GT(to[0], from[0]) << "lightness at step " << k;
    lengths.push_back(distance(from, to));
    total += lengths.back();
  }
  // The table has whole-numbered channels (about 1 unit) and straight pieces between its colours.
  for (const double length : lengths) EXPECT_NEAR(length, total / kSteps, 0.3 * total / kSteps);
}

TEST(Palette, HeightsOutsideTheRangeHaveTheEndColours) {
  EXPECT_EQ(height_colour(-3.0), height_colour(0.0));
  EXPECT_EQ(height_colour(1e9), height_colour(1.0));
  EXPECT_NE(height_colour(0.0), height_colour(1.0));
}

TEST(Palette, APointHasTheColourOfItsClassElseOfItsSupport) {
  EXPECT_EQ(colour_of(TerrainClass::kSlope, Support::kGround), kSlopeColour);
  EXPECT_EQ(colour_of(TerrainClass::kNone, Support::kGround), kGroundColour);
  EXPECT_EQ(colour_of(TerrainClass::kNone, Support::kAbove), kDroppedColour);
  EXPECT_EQ(colour_of(TerrainClass::kNone, Support::kBelow), kDroppedColour);
  EXPECT_EQ(colour_of(TerrainClass::kNone, Support::kUnknown), kUnknownColour);
}

}  // namespace
}  // namespace mrpt_terrain::view
