// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/palette.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace mrpt_terrain::view {
namespace {

// Points at equal distances (CIE 1976 Lab) along a curve of rising lightness.
constexpr std::array<Rgb, 11> kHeightColours{{{56, 31, 89},
                                              {5, 60, 128},
                                              {5, 80, 128},
                                              {4, 109, 139},
                                              {8, 139, 150},
                                              {5, 165, 152},
                                              {44, 186, 141},
                                              {96, 203, 122},
                                              {146, 216, 101},
                                              {195, 225, 83},
                                              {243, 230, 70}}};

constexpr std::array<Rgb, 3> kCostColours{{{176, 213, 160}, {248, 225, 110}, {222, 105, 30}}};

std::uint8_t mix(std::uint8_t a, std::uint8_t b, double share_of_b) {
  return static_cast<std::uint8_t>(std::lround(a + (b - a) * share_of_b));
}

/// The colour at a share, 0 to 1, of the way through a list of colours.
template <std::size_t N>
Rgb between(const std::array<Rgb, N>& colours, double share) {
  const double place = std::clamp(share, 0.0, 1.0) * (N - 1);
  const auto k = std::min(static_cast<std::size_t>(place), N - 2);
  const double rest = place - static_cast<double>(k);
  const Rgb a = colours[k];
  const Rgb b = colours[k + 1];
  return {mix(a.r, b.r, rest), mix(a.g, b.g, rest), mix(a.b, b.b, rest)};
}

}  // namespace

Rgb colour_of(UnseenReason reason) {
  switch (reason) {
    case UnseenReason::kOutOfView:
      return kOutOfViewColour;
    case UnseenReason::kOccluded:
      return kOccludedColour;
    case UnseenReason::kNoReturn:
    case UnseenReason::kSeen:
      break;
  }
  return kUnobservedColour;
}

Rgb colour_of(TerrainClass terrain_class) {
  switch (terrain_class) {
    case TerrainClass::kSlope:
      return kSlopeColour;
    case TerrainClass::kPothole:
      return kPotholeColour;
    case TerrainClass::kObstacle:
      return kObstacleColour;
    case TerrainClass::kOther:
      return kOtherColour;
    case TerrainClass::kNone:
      break;
  }
  return kDroppedColour;
}

Rgb colour_of(Support support) {
  switch (support) {
    case Support::kGround:
      return kGroundColour;
    case Support::kUnknown:
      return kUnknownColour;
    case Support::kAbove:
    case Support::kBelow:
      break;
  }
  return kDroppedColour;
}

Rgb colour_of(TerrainClass terrain_class, Support support) {
  return terrain_class == TerrainClass::kNone ? colour_of(support) : colour_of(terrain_class);
}

Rgb height_colour(double t) { return between(kHeightColours, t); }

Rgb cost_colour(double cost) { return between(kCostColours, cost); }

}  // namespace mrpt_terrain::view
