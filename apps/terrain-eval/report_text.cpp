// SPDX-License-Identifier: BSD-3-Clause
#include "report_text.h"

#include <cmath>

#include "mrpt_terrain/core/labels.h"
#include "mrpt_terrain/view/text.h"

using namespace mrpt_terrain;

namespace {

template <std::size_t N>
std::vector<std::string> names_of_bins(double first, const std::array<double, N>& edges) {
  std::vector<std::string> names;
  std::string from = view::shortest(first);
  for (const double edge : edges) {
    const std::string to = view::shortest(edge);
    names.push_back(from + "-" + to);
    from = to;
  }
  names.push_back(">" + from);
  return names;
}

}  // namespace

std::string percent(double share) { return number(100.0 * share, 2); }
std::string percent(const eval::Share& share) { return percent(share.value()); }
std::string number(double value, int decimals) {
  return std::isfinite(value) ? view::fixed(value, decimals) : "-";
}
std::string count(std::size_t value) { return std::to_string(value); }

std::vector<std::string> distance_names() { return names_of_bins(0.0, eval::kDistanceEdges); }
std::vector<std::string> height_names() { return names_of_bins(0.1, eval::kHeightEdges); }
std::vector<std::string> hole_distance_names() { return names_of_bins(0.0, eval::kHoleEdges); }

std::vector<std::string> class_names() {
  std::vector<std::string> names;
  for (const auto& entry : enum_names(TerrainClass{})) names.emplace_back(entry.name);
  return names;
}
