// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/label_placement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace mrpt_terrain::view {
namespace {

constexpr double kGap = 2.0;  // pixels between labels
// Share of hidden pixels that one pixel of distance is worth.
constexpr double kCostOfDistance = 0.02;
constexpr std::array<double, 4> kRadii{{12.0, 20.0, 32.0, 46.0}};  // pixels
constexpr int kDirections = 12;

Box box_at(const LabelRequest& request, double dx, double dy) {
  return {std::floor(request.x + dx - 0.5 * request.width),
          std::floor(request.y + dy - 0.5 * request.height), request.width, request.height};
}

/// Places to try: over the thing itself, then rings around it, measured from the label's edge.
std::vector<Box> candidates(const LabelRequest& request) {
  std::vector<Box> boxes{box_at(request, 0.0, 0.0)};
  for (const double radius : kRadii) {
    for (int k = 0; k < kDirections; ++k) {
      const double angle = 2.0 * 3.14159265358979323846 * k / kDirections;
      boxes.push_back(box_at(request, (radius + 0.5 * request.width) * std::cos(angle),
                             (radius + 0.5 * request.height) * std::sin(angle)));
    }
  }
  return boxes;
}

bool is_inside(const Box& box, const Raster<std::uint8_t>& picture) {
  return box.left >= 0.0 && box.top >= 0.0 && box.left + box.width <= picture.width &&
         box.top + box.height <= picture.height;
}

bool is_free(Box box, const std::vector<Box>& taken) {
  box = {box.left - kGap, box.top - kGap, box.width + 2.0 * kGap, box.height + 2.0 * kGap};
  return std::none_of(taken.begin(), taken.end(),
                      [&](const Box& other) { return box.overlaps(other); });
}

/// Mean of the busy pixels under the box.
double hidden_share(const Box& box, const Raster<std::uint8_t>& busy) {
  double sum = 0.0;
  const int right = static_cast<int>(box.left + box.width);
  const int bottom = static_cast<int>(box.top + box.height);
  for (int row = static_cast<int>(box.top); row < bottom; ++row) {
    for (int column = static_cast<int>(box.left); column < right; ++column) {
      sum += busy.at(column, row);
    }
  }
  return sum / (box.width * box.height);
}

}  // namespace

std::vector<std::optional<Box>> place_labels(const std::vector<LabelRequest>& requests,
                                             const Raster<std::uint8_t>& busy,
                                             const std::vector<Box>& reserved) {
  std::vector<Box> taken = reserved;
  std::vector<std::optional<Box>> places;
  for (const LabelRequest& request : requests) {
    std::optional<Box> best;
    double least = std::numeric_limits<double>::infinity();
    for (const Box& box : candidates(request)) {
      if (!is_inside(box, busy) || !is_free(box, taken)) continue;
      const double distance = std::hypot(box.left + 0.5 * box.width - request.x,
                                         box.top + 0.5 * box.height - request.y);
      const double cost = hidden_share(box, busy) + kCostOfDistance * distance;
      if (cost >= least) continue;
      least = cost;
      best = box;
    }
    if (best) taken.push_back(*best);
    places.push_back(best);
  }
  return places;
}

}  // namespace mrpt_terrain::view
