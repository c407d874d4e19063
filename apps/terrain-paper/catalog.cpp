// SPDX-License-Identifier: BSD-3-Clause
#include "catalog.h"

namespace {

// Cluster 4 of Figure 8: many boxes, of which the first is 4 and the others count on from 41.
std::vector<int> cluttered_objects() {
  std::vector<int> ids{4};
  for (int id = 41; id < 60; ++id) ids.push_back(id);
  return ids;
}

CatalogEntry slope(int table, const std::string& scene, const std::string& name) {
  return {table, scene, {{name, {1}}}};
}

}  // namespace

const std::vector<CatalogEntry>& catalog() {
  static const std::vector<CatalogEntry> entries = {
      {2, "paper_height_index", {{"obstacle", {1}}, {"pothole", {2}}}},
      {3,
       "paper_clusters",
       {{"cluster 1", {1}},
        {"cluster 2", {2}},
        {"cluster 3", {3}},
        {"cluster 4", cluttered_objects()},
        {"cluster 5", {5}}}},
      slope(4, "paper_slope_a", "A"),
      slope(4, "paper_slope_b", "B"),
      slope(4, "paper_slope_c", "C"),
      slope(5, "paper_slope_a1", "A1"),
      slope(5, "paper_slope_a2", "A2"),
      slope(5, "paper_slope_a3", "A3")};
  return entries;
}

std::vector<double> usual_noise_mm(int table) {
  if (table == 2 || table == 3) return {0.0, 2.0, 5.0, 10.0, 20.0};
  return {5.0, 20.0};
}
