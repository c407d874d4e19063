// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "mrpt_terrain/core/field_clusters.h"

namespace mrpt_terrain {

/// A line along which two things may be one; places on it are metres from the middle of the first.
struct Line {
  float x, y;
  float along_x, along_y;

  [[nodiscard]] float along_of(const Position2& at) const {
    return (static_cast<float>(at.x) - x) * along_x + (static_cast<float>(at.y) - y) * along_y;
  }
  [[nodiscard]] float across_of(const Position2& at) const {
    return (static_cast<float>(at.y) - y) * along_x - (static_cast<float>(at.x) - x) * along_y;
  }
  [[nodiscard]] Position2 place(float along, float across) const {
    return {static_cast<double>(x + along * along_x - across * along_y),
            static_cast<double>(y + along * along_y + across * along_x)};
  }
};

/// Extent of a thing against a line.
struct Extent {
  float begin = 1e9F, end = -1e9F, right = 1e9F, left = -1e9F;

  void add(const ThingPiece& piece, const Line& line) {
    for (const float along : {piece.begin, piece.end}) {
      for (const float across : {piece.right, piece.left}) {
        const Position2 corner = piece.place(along, across);
        const float u = line.along_of(corner), v = line.across_of(corner);
        begin = std::min(begin, u);
        end = std::max(end, u);
        right = std::min(right, v);
        left = std::max(left, v);
      }
    }
  }
};

}  // namespace mrpt_terrain
