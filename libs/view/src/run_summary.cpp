// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/run_summary.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "mrpt_terrain/view/text.h"

namespace mrpt_terrain::view {
namespace {

using Json = nlohmann::ordered_json;

std::size_t sum_of(const std::map<std::string, std::size_t>& counts) {
  return std::accumulate(counts.begin(), counts.end(), std::size_t{0},
                         [](std::size_t sum, const auto& entry) { return sum + entry.second; });
}

Json counts_json(const std::map<std::string, std::size_t>& counts) {
  Json result = Json::object();
  for (const auto& [name, number] : counts) result[name] = number;
  return result;
}

Json clusters_json(const RunSummary& summary) {
  Json result;
  for (const auto& entry : enum_names(TerrainClass{})) {
    if (entry.value == TerrainClass::kNone) continue;
    result[entry.name] = summary.clusters[static_cast<std::size_t>(entry.value)];
  }
  return result;
}

template <class Getter>
Json time_json(const RunSummary& summary, Getter getter) {
  std::vector<double> values;
  values.reserve(summary.milliseconds.size());
  for (const auto& scan : summary.milliseconds) values.push_back(getter(scan));
  const Quantiles result = quantiles(std::move(values));
  return {{"median", result.median}, {"p95", result.p95}, {"max", result.max}};
}

Json times_json(const RunSummary& summary) {
  Json result;
  result["io"] = time_json(summary, [](const ScanMilliseconds& scan) { return scan.io; });
  result["transform"] =
      time_json(summary, [](const ScanMilliseconds& scan) { return scan.transform; });
  for (const auto& entry : enum_names(Stage{})) {
    const auto stage = static_cast<std::size_t>(entry.value);
    result[entry.name] =
        time_json(summary, [=](const ScanMilliseconds& scan) { return scan.stage[stage]; });
  }
  result["total"] = time_json(summary, [](const ScanMilliseconds& scan) { return scan.total; });
  return result;
}

Json reference_json(const std::optional<ScanReference>& scan) {
  if (!scan) return nullptr;
  return {{"file", scan->file}, {"entry", scan->entry}, {"scan", scan->index}, {"why", scan->why}};
}

}  // namespace

void add(LeftOutReturns& sum, const LeftOutReturns& scan) {
  sum.no_return += scan.no_return;
  sum.not_finite += scan.not_finite;
  sum.out_of_range += scan.out_of_range;
}

void add_scan(RunSummary& summary, const ScanRecord& scan) {
  const double total = scan.milliseconds.total;
  const bool is_slowest =
      summary.milliseconds.empty() || total > summary.milliseconds[summary.slowest].total;
  if (is_slowest) {
    summary.slowest = summary.milliseconds.size();
    summary.slowest_scan =
        ScanReference{scan.file, scan.entry, scan.index, "took " + fixed(total, 1) + " ms"};
  }
  ++summary.scans_processed;
  summary.points += scan.counts.points;
  add(summary.left_out, scan.left_out);
  for (std::size_t kind = 0; kind < kClassCount; ++kind) {
    summary.clusters[kind] += scan.counts.clusters[kind];
  }
  summary.milliseconds.push_back(scan.milliseconds);
}

Quantiles quantiles(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto nearest_rank = [&](double share) {
    const double rank = std::ceil(share * static_cast<double>(values.size()));
    return values[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
  };
  return {nearest_rank(0.5), nearest_rank(0.95), values.back()};
}

std::string summary_json(const RunSummary& summary) {
  Json json;
  json["version"] = summary.version;
  json["inputs"] = summary.inputs;
  json["scans_processed"] = summary.scans_processed;
  json["scans_skipped"] = sum_of(summary.scans_skipped);
  json["skipped_because"] = counts_json(summary.scans_skipped);
  json["unknown_classes"] = counts_json(summary.unknown_classes);
  json["points"] = summary.points;
  json["left_out"] = {{"no_return", summary.left_out.no_return},
                      {"not_finite", summary.left_out.not_finite},
                      {"out_of_range", summary.left_out.out_of_range}};
  json["clusters"] = clusters_json(summary);
  json["milliseconds"] = times_json(summary);
  json["slowest_scan"] = reference_json(summary.slowest_scan);
  json["worst_scan"] = reference_json(summary.worst_scan);
  json["wall_seconds"] = summary.wall_seconds;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace mrpt_terrain::view
