// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "mrpt_terrain/view/cluster_order.h"
#include "mrpt_terrain/view/scan_record.h"
#include "mrpt_terrain/view/text.h"

namespace mrpt_terrain::view {
namespace {

constexpr double kDegrees = 180.0 / 3.14159265358979323846;
constexpr std::size_t kColumns = 11;
constexpr std::size_t kClassColumn = 1;
constexpr std::size_t kStatusColumn = 10;

using Row = std::array<std::string, kColumns>;

bool is_left_aligned(std::size_t column) {
  return column == kClassColumn || column == kStatusColumn;
}

bool failed(FeatureStatus status) {
  return status != FeatureStatus::kOk && status != FeatureStatus::kNotNeeded;
}

std::string status_text(const ClusterDescription& thing) {
  std::string text;
  if (failed(thing.roughness.status)) {
    text += std::string("roughness: ") + name_of(thing.roughness.status);
  }
  if (failed(thing.slope.status)) {
    text += std::string(text.empty() ? "" : ", ") + "slope: " + name_of(thing.slope.status);
  }
  return text.empty() ? "ok" : text;
}

Row row_of(const Description& description, std::size_t number) {
  const ClusterDescription& thing = description.things[number];
  const double dx = thing.max_corner.x - thing.min_corner.x;
  const double dy = thing.max_corner.y - thing.min_corner.y;
  const bool has_roughness = thing.roughness.status == FeatureStatus::kOk;
  const bool has_slope = thing.slope.status == FeatureStatus::kOk;
  // The smallest eigenvalue of flat points may come out a little below 0.
  const double spread = std::sqrt(std::max(0.0, thing.roughness.lambda[0]));
  return {std::to_string(number),
          name_of(thing.terrain_class),
          fixed(thing.centroid.x, 2),
          fixed(thing.centroid.y, 2),
          fixed(dx, 2) + " x " + fixed(dy, 2),
          std::to_string(thing.cells),
          std::to_string(thing.points),
          fixed(thing.height.h_f, 3),
          has_roughness ? fixed(spread * 100.0, 1) : "-",
          has_slope ? fixed(thing.slope.angle * kDegrees, 1) : "-",
          status_text(thing)};
}

std::vector<std::string> hole_row(const Description& description, std::size_t number) {
  const HoleDescription& hole = description.holes[number];
  const std::int32_t cluster = cluster_of(description, hole);
  return {"h" + std::to_string(number),
          std::string(name_of(hole.kind)),
          cluster == kNoCluster ? "-" : std::to_string(cluster),
          fixed(hole.centre.x, 2),
          fixed(hole.centre.y, 2),
          fixed(hole.length, 2) + " x " + fixed(hole.width, 2),
          fixed(100.0 * hole.depth, 1),
          std::to_string(hole.points),
          std::to_string(hole.rings),
          fixed(hole.confidence, 2)};
}

std::string line_of(const Row& row, const std::array<std::size_t, kColumns>& widths) {
  std::string line;
  for (std::size_t column = 0; column < kColumns; ++column) {
    const std::string padding(widths[column] - row[column].size(), ' ');
    if (column > 0) line += "  ";
    line += is_left_aligned(column) ? row[column] + padding : padding + row[column];
  }
  return line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
}

}  // namespace

std::string hole_table(const Description& description, std::size_t limit) {
  if (description.holes.empty()) return {};
  const std::size_t shown = std::min(limit, description.holes.size());
  std::vector<std::vector<std::string>> rows{{"hole", "kind", "cluster", "x [m]", "y [m]",
                                              "size [m]", "depth [cm]", "points", "rings",
                                              "confidence"}};
  for (std::size_t k = 0; k < shown; ++k) rows.push_back(hole_row(description, k));
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows) {
    for (std::size_t column = 0; column < row.size(); ++column) {
      widths[column] = std::max(widths[column], row[column].size());
    }
  }
  std::string table;
  for (const auto& row : rows) {
    for (std::size_t column = 0; column < row.size(); ++column) {
      if (column > 0) table += "  ";
      table += std::string(widths[column] - row[column].size(), ' ') + row[column];
    }
    table += "\n";
  }
  const std::size_t more = description.holes.size() - shown;
  if (more > 0) table += "... and " + std::to_string(more) + " more\n";
  return table;
}

std::string cluster_table(const Description& description, std::size_t limit) {
  std::vector<Row> rows{{"#", "class", "x [m]", "y [m]", "size [m]", "cells", "points", "H_f [m]",
                         "rough [cm]", "slope [deg]", "status"}};
  for (const std::size_t number : largest_clusters(description, limit)) {
    rows.push_back(row_of(description, number));
  }
  std::array<std::size_t, kColumns> widths{};
  for (const Row& row : rows) {
    for (std::size_t column = 0; column < kColumns; ++column) {
      widths[column] = std::max(widths[column], row[column].size());
    }
  }
  std::string table;
  for (const Row& row : rows) table += line_of(row, widths);
  const std::size_t more = description.things.size() - (rows.size() - 1);
  if (more > 0) table += "... and " + std::to_string(more) + " more\n";
  return table;
}

std::string class_summary(const Description& description) {
  constexpr std::array<TerrainClass, 4> kOrder{{TerrainClass::kObstacle, TerrainClass::kSlope,
                                                TerrainClass::kPothole, TerrainClass::kOther}};
  const DescriptionCounts counts = count(description);
  const std::size_t clusters = description.things.size();
  std::string line = std::to_string(clusters) + (clusters == 1 ? " cluster: " : " clusters: ");
  for (const TerrainClass kind : kOrder) {
    if (kind != kOrder.front()) line += ", ";
    line += std::to_string(counts.clusters[static_cast<std::size_t>(kind)]) + " " + name_of(kind);
  }
  return line + "; " + std::to_string(counts.dropped_groups) +
         (counts.dropped_groups == 1 ? " group" : " groups") + " too small";
}

}  // namespace mrpt_terrain::view
