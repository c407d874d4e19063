// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "mrpt_terrain/core/labels.h"
#include "mrpt_terrain/core/unseen_reason.h"

namespace mrpt_terrain::view {

/// Colour in sRGB, 0 to 255 per channel.
struct Rgb {
  std::uint8_t r = 0;
  std::uint8_t g = 0;
  std::uint8_t b = 0;

  friend bool operator==(Rgb a, Rgb b) { return a.r == b.r && a.g == b.g && a.b == b.b; }
  friend bool operator!=(Rgb a, Rgb b) { return !(a == b); }
};

/// The colours of all pictures and scenes. Those of the classes stay apart for readers with
/// protanopia, deuteranopia and tritanopia as well (test/view/palette_test.cpp).
inline constexpr Rgb kGroundColour{160, 184, 158};
inline constexpr Rgb kObstacleColour{213, 94, 0};
inline constexpr Rgb kSlopeColour{50, 145, 215};
inline constexpr Rgb kPotholeColour{112, 28, 125};
inline constexpr Rgb kOtherColour{245, 190, 50};
/// Groups of non-ground cells that are too small to be a cluster.
inline constexpr Rgb kDroppedColour{222, 200, 165};
/// Points without a support label.
inline constexpr Rgb kUnknownColour{214, 214, 214};
/// Cells that no point has hit.
inline constexpr Rgb kUnobservedColour{255, 255, 255};

/// Cells whose ground was not seen, where it is known why: pale, and paler the less there is to
/// know.
inline constexpr Rgb kOutOfViewColour{240, 232, 214};
inline constexpr Rgb kOccludedColour{198, 202, 214};

/// Colour of a cell that was not observed; without a reason and where nothing came back it is
/// `kUnobservedColour`.
[[nodiscard]] Rgb colour_of(UnseenReason reason);

/// Colour of a cluster's class; `kNone` has that of small groups.
[[nodiscard]] Rgb colour_of(TerrainClass terrain_class);

/// Colour of a support label that belongs to no cluster.
[[nodiscard]] Rgb colour_of(Support support);

/// Colour of a point or cell: that of its class if it has one, else that of its support.
[[nodiscard]] Rgb colour_of(TerrainClass terrain_class, Support support);

/// Cells that must not be driven on.
inline constexpr Rgb kLethalColour{122, 20, 30};
/// Colour of a cost: from pale green (0) over yellow to orange (1).
/// \param cost values outside [0, 1] are clamped
[[nodiscard]] Rgb cost_colour(double cost);

/// Colour of a height. Perceptually uniform: equal steps look equally large, from dark violet (low)
/// over blue and green to bright yellow (high), and lightness rises all the way.
/// \param t 0 (lowest) to 1 (highest); values outside are clamped
[[nodiscard]] Rgb height_colour(double t);

}  // namespace mrpt_terrain::view
