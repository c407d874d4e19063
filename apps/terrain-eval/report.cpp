// SPDX-License-Identifier: BSD-3-Clause
#include "report.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "report_text.h"

using namespace mrpt_terrain;
using eval::WorldScore;

namespace {

using Row = std::vector<std::string>;

double degrees(double radians) { return radians * 180.0 / M_PI; }

Row support_row(const std::string& name, const eval::SupportCounts& counts) {
  return {name,
          percent(counts.iou()),
          percent(counts.precision()),
          percent(counts.recall()),
          percent(counts.f1()),
          percent(counts.obstacle_tpr()),
          count(counts.true_ground + counts.missed_ground),
          count(counts.true_obstacle + counts.missed_obstacle)};
}
const Row kSupportHeader = {"", "IoU", "P", "R", "F1", "TPR", "ground", "obstacle"};

Row with_prefix(Row row, const std::string& prefix, const std::vector<std::string>& names) {
  for (const std::string& name : names) row.push_back(prefix + name);
  return row;
}

TextTable bins_table(const std::vector<NamedSupport>& scores) {
  TextTable table{
      "Support by distance in m (ground IoU, obstacle TPR) and by height of the "
      "obstacle in m (TPR), %",
      {""},
      {},
      ""};
  table.header = with_prefix(table.header, "IoU ", distance_names());
  table.header = with_prefix(table.header, "TPR ", distance_names());
  table.header = with_prefix(table.header, "h ", height_names());
  for (const NamedSupport& entry : scores) {
    Row row{entry.name};
    for (const auto& counts : entry.score.by_distance) row.push_back(percent(counts.iou()));
    for (const auto& counts : entry.score.by_distance) {
      row.push_back(percent(counts.obstacle_tpr()));
    }
    for (const auto& share : entry.score.obstacles_by_height) row.push_back(percent(share));
    table.rows.push_back(std::move(row));
  }
  return table;
}

TextTable cluster_table(const std::vector<NamedScore>& scores) {
  TextTable table{"Clusters at IoU 0.5, %; right: what recall is of each class", {}, {}, ""};
  table.header = {"",       "things", "recall",  "clusters", "precision", "split",
                  "merged", "slope",  "pothole", "obstacle", "other"};
  for (const NamedScore& entry : scores) {
    const eval::ClusterScore& score = entry.score.clusters;
    Row row{entry.name,           count(score.found.total),
            percent(score.found), count(score.right.total),
            percent(score.right), percent(score.split),
            percent(score.merged)};
    for (std::size_t k = 1; k < eval::kClassCount; ++k) {
      row.push_back(percent(score.found_of_class[k]));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

TextTable confusion_table(const NamedScore& entry) {
  TextTable table{"Classes in " + entry.name + ": truth (row), described (column)", {""}, {}, ""};
  std::vector<std::string> names = class_names();
  for (std::size_t c = 1; c < names.size(); ++c) table.header.push_back(names[c]);
  table.header.emplace_back("not found");
  const auto& confusion = entry.score.clusters.confusion;
  for (std::size_t r = 1; r <= names.size(); ++r) {
    const auto& numbers = confusion[r % names.size()];
    Row row{r == names.size() ? "nothing there" : names[r]};
    for (std::size_t c = 1; c <= names.size(); ++c) row.push_back(count(numbers[c % names.size()]));
    table.rows.push_back(std::move(row));
  }
  return table;
}

void append_errors(const eval::ErrorSummary& errors, Row& row) {
  for (const double value : {errors.bias, errors.rmse, errors.p95, errors.greatest}) {
    row.push_back(number(degrees(value), 2));
  }
  row.push_back(percent(errors.in_two_sigma));
}

TextTable slope_table(const std::vector<NamedScore>& scores) {
  TextTable table{"Slopes of ramps that were found as clusters, errors in deg", {}, {}, ""};
  table.header = {"",         "ramps", "no angle", "several faces", "measured",
                  "bias",     "RMSE",  "95 %",     "max",           "2 sigma %",
                  "dir bias", "RMSE",  "95 %",     "max",           "2 sigma %"};
  for (const NamedScore& entry : scores) {
    const eval::SlopeScore& score = entry.score.slopes;
    if (score.ramps == 0) continue;
    Row row{entry.name, count(score.ramps), count(score.no_angle), count(score.several),
            count(score.samples.size())};
    append_errors(eval::angle_summary(score), row);
    append_errors(eval::direction_summary(score), row);
    table.rows.push_back(std::move(row));
  }
  return table;
}

TextTable pothole_table(const std::vector<NamedScore>& scores) {
  TextTable table{"Potholes and ditches, every scan apart", {}, {}, ""};
  table.header = {"",        "due",       "found %", "right size",  "found %", "other",
                  "found %", "ground m2", "false",   "per 1000 m2", "on path", "in time %"};
  for (const NamedScore& entry : scores) {
    const eval::PotholeScore& score = entry.score.potholes;
    table.rows.push_back(
        {entry.name, count(score.found.total), percent(score.found), count(score.found_small.total),
         percent(score.found_small), count(score.found_other.total), percent(score.found_other),
         number(score.ground, 0), count(score.wrong.size()), number(score.wrong_per_1000(), 2),
         count(score.ahead.total), percent(score.ahead)});
  }
  return table;
}

TextTable gap_table(const std::vector<NamedScore>& scores) {
  TextTable table{"Ditches and drops told without a floor, every scan apart", {}, {}, ""};
  table.header = {"", "gaps", "drops", "free space", "ground m2", "false", "per 1000 m2"};
  for (const NamedScore& entry : scores) {
    const eval::GapScore& score = entry.score.gaps;
    const double ground = entry.score.potholes.ground;
    table.rows.push_back({entry.name, count(score.described[1]), count(score.described[2]),
                          count(score.described[3]), number(ground, 0), count(score.wrong.size()),
                          number(1000.0 * static_cast<double>(score.wrong.size()) / ground, 2)});
  }
  return table;
}

TextTable false_gap_table(const WorldScore& score, bool details) {
  constexpr std::size_t kShown = 20;
  TextTable table{"False ditches and drops", {}, {}, ""};
  table.header = {"family",   "seed",   "sweep", "kind",  "x",         "y",
                  "distance", "length", "width", "depth", "confidence"};
  const auto& wrong = score.gaps.wrong;
  const std::size_t shown = details ? wrong.size() : std::min(kShown, wrong.size());
  for (std::size_t k = 0; k < shown; ++k) {
    const eval::FalseGap& entry = wrong[k];
    table.rows.push_back(
        {entry.family, std::to_string(entry.seed), count(entry.sweep), name_of(entry.kind),
         number(entry.x, 2), number(entry.y, 2), number(entry.distance, 1), number(entry.length, 2),
         number(entry.width, 2), number(entry.depth, 2), number(entry.confidence, 2)});
  }
  if (shown < wrong.size()) table.note = "and " + count(wrong.size() - shown) + " more: --details";
  return table;
}

TextTable detection_table(const NamedScore& entry) {
  TextTable table{"Potholes over distance in " + entry.name, {}, {}, ""};
  table.header = {"m", "due", "found %", "right size", "found %"};
  const std::vector<std::string> names = hole_distance_names();
  const eval::PotholeScore& score = entry.score.potholes;
  for (std::size_t k = 0; k < names.size(); ++k) {
    table.rows.push_back({names[k], count(score.due_at[k].total), percent(score.due_at[k]),
                          count(score.small_at[k].total), percent(score.small_at[k])});
  }
  return table;
}

TextTable false_table(const WorldScore& score, bool details) {
  constexpr std::size_t kShown = 20;
  TextTable table{"False potholes", {}, {}, ""};
  table.header = {"family", "seed",  "sweep",        "x", "y", "distance", "cells", "points",
                  "h_min",  "h_max", "what is there"};
  const auto& wrong = score.potholes.wrong;
  const std::size_t shown = details ? wrong.size() : std::min(kShown, wrong.size());
  for (std::size_t k = 0; k < shown; ++k) {
    const eval::FalsePothole& entry = wrong[k];
    table.rows.push_back({entry.family, std::to_string(entry.seed), count(entry.sweep),
                          number(entry.x, 2), number(entry.y, 2), number(entry.distance, 1),
                          std::to_string(entry.cells), std::to_string(entry.points),
                          number(entry.h_min, 2), number(entry.h_max, 2), entry.at});
  }
  if (shown < wrong.size()) {
    table.note = "and " + count(wrong.size() - shown) + " more: --details, --false-potholes";
  }
  return table;
}

TextTable identity_table(const std::vector<NamedScore>& scores) {
  TextTable table{"Identities over consecutive scans", {}, {}, ""};
  table.header = {"", "objects", "seen", "kept %", "found", "kept %"};
  for (const NamedScore& entry : scores) {
    const eval::IdentityScore& score = entry.score.identities;
    table.rows.push_back({entry.name, count(score.objects), count(score.kept.total),
                          percent(score.kept), count(score.kept_where_found.total),
                          percent(score.kept_where_found)});
  }
  return table;
}

TextTable cost_table(const std::vector<NamedScore>& scores) {
  using eval::TrueCell;
  TextTable table{
      "Costs of observed cells, %; traversable ones: lethal, and of those with nothing else "
      "beside; "
      "lethal ones by kind: not lethal, of all: unknown, nothing lethal beside either",
      {"", "traversable", "lethal", "alone"},
      {},
      ""};
  constexpr std::array<TrueCell, 4> kLethal{TrueCell::kObstacle, TrueCell::kHole, TrueCell::kEdge,
                                            TrueCell::kSteep};
  for (const TrueCell kind : kLethal) {
    table.header.emplace_back(name_of(kind));
    table.header.emplace_back("open");
    table.header.emplace_back("unknown");
    table.header.emplace_back("all open");
  }
  for (const NamedScore& entry : scores) {
    const eval::CostScore& score = entry.score.costs;
    Row row{entry.name, count(score.blocked.total), percent(score.blocked),
            percent(score.blocked_free)};
    for (const TrueCell kind : kLethal) {
      const auto k = static_cast<std::size_t>(kind);
      row.push_back(count(score.open[k].total));
      row.push_back(percent(score.open[k]));
      row.push_back(percent(score.unknown[k]));
      row.push_back(percent(score.all_open[k]));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

TextTable run_table(const std::vector<NamedScore>& scores) {
  TextTable table{"Scans", {"", "worlds", "scans", "points", "ms per scan"}, {}, ""};
  for (const NamedScore& entry : scores) {
    const WorldScore& score = entry.score;
    table.rows.push_back({entry.name, count(score.worlds), count(score.scans), count(score.points),
                          number(1000.0 * score.seconds / static_cast<double>(score.scans), 2)});
  }
  return table;
}

}  // namespace

std::vector<TextTable> support_tables(const std::vector<NamedSupport>& scores) {
  TextTable table{"Support of points, %", kSupportHeader, {}, ""};
  for (const NamedSupport& entry : scores) {
    table.rows.push_back(support_row(entry.name, entry.score.all));
  }
  return {table, bins_table(scores)};
}

std::vector<TextTable> world_tables(const std::vector<NamedScore>& scores, bool details) {
  std::vector<NamedSupport> support;
  support.reserve(scores.size());
  for (const NamedScore& entry : scores) support.push_back({entry.name, entry.score.support});
  std::vector<TextTable> tables{run_table(scores)};
  for (TextTable& table : support_tables(support)) tables.push_back(std::move(table));
  tables.push_back(cluster_table(scores));
  for (const NamedScore& entry : scores) {
    if (details || &entry == &scores.back()) tables.push_back(confusion_table(entry));
  }
  TextTable slopes = slope_table(scores);
  if (!slopes.rows.empty()) tables.push_back(std::move(slopes));
  tables.push_back(pothole_table(scores));
  tables.push_back(gap_table(scores));
  for (const NamedScore& entry : scores) {
    const bool wanted = details || &entry == &scores.back();
    if (wanted && entry.score.potholes.found_small.total > 0) {
      tables.push_back(detection_table(entry));
    }
  }
  const WorldScore& all = scores.back().score;
  if (all.identities.objects > 0) tables.push_back(identity_table(scores));
  if (all.costs.blocked.total > 0) tables.push_back(cost_table(scores));
  if (!all.gaps.wrong.empty()) tables.push_back(false_gap_table(all, details));
  if (!all.potholes.wrong.empty()) tables.push_back(false_table(all, details));
  return tables;
}
