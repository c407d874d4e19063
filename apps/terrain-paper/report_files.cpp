// SPDX-License-Identifier: BSD-3-Clause
#include "report_files.h"

#include <array>
#include <optional>

#include "mrpt_terrain/eval/published_tables.h"
#include "mrpt_terrain/view/text.h"

namespace {

namespace eval = mrpt_terrain::eval;
using mrpt_terrain::view::fixed;
using mrpt_terrain::view::shortest;

constexpr double kDegrees = 57.29577951308232;

/// One line of tables.csv.
struct Number {
  std::string place;  ///< table, row, noise, jitter, method
  std::string statistic;
  std::optional<double> published;
  double ours = 0.0;
  std::optional<eval::Interval> interval;
};

std::string line(const Number& number) {
  std::string text = number.place + "," + number.statistic + ",";
  if (number.published) text += shortest(*number.published);
  text += "," + shortest(number.ours) + ",";
  if (number.published) text += shortest(number.ours - *number.published);
  text += ",";
  if (number.interval) text += shortest(number.interval->low);
  text += ",";
  if (number.interval) text += shortest(number.interval->high);
  return text + "\n";
}

std::string place_of(int table, const std::string& row, double range_sigma, double tilt_sigma,
                     const std::string& method) {
  return std::to_string(table) + "," + row + "," + shortest(1e3 * range_sigma) + "," +
         fixed(kDegrees * tilt_sigma, 3) + "," + method;
}

std::string error_lines(const ErrorRow& row) {
  const std::string place = place_of(row.table, row.target, row.range_sigma, 0.0, "paper_method");
  const auto published = eval::published_errors(row.target).value_or(eval::PublishedErrors{});
  const eval::ErrorStatistics& ours = row.summary.statistics;
  const eval::ErrorIntervals& intervals = row.summary.intervals;
  return line({place, "mean_error", published.mean_error, ours.mean_error, intervals.bias}) +
         line({place, "mean_abs_error", published.mean_abs_error, ours.mean_abs_error, {}}) +
         line({place, "rms_error", published.rms_error, ours.rms_error, intervals.rmse}) +
         line({place, "max_abs_error", published.max_abs_error, ours.max_abs_error, {}}) +
         line({place, "scans", 50.0, static_cast<double>(ours.n), {}});
}

std::string duel_lines(const std::string& place, const eval::Duel& duel) {
  const std::string prefix = duel.ours + "_minus_this_";
  const auto middle = [](const eval::Interval& i) { return 0.5 * (i.low + i.high); };
  const eval::PairedDifferences& d = duel.differences;
  return line({place, prefix + "abs_bias", {}, middle(d.abs_bias), d.abs_bias}) +
         line({place, prefix + "variance", {}, middle(d.variance), d.variance}) +
         line({place, prefix + "rmse", {}, middle(d.rmse), d.rmse});
}

std::string coverage_line(const std::string& place, const std::optional<eval::Coverage>& coverage) {
  if (!coverage) return {};
  return line({place, "two_sigma_coverage", {}, coverage->share, coverage->interval});
}

std::string slope_lines(const SlopeBlock& block) {
  const eval::SlopeResult& result = block.result;
  std::string text;
  for (const eval::MethodRow& row : result.rows) {
    const std::string place = place_of(block.table, result.slope, result.conditions.range_sigma,
                                       result.conditions.tilt_sigma, row.method);
    const auto published = eval::published_slope(result.slope, row.method);
    const eval::ErrorStatistics& ours = row.summary.statistics;
    const eval::ErrorIntervals& intervals = row.summary.intervals;
    text += line({place,
                  "mean",
                  published ? std::optional<double>(published->mean) : std::nullopt,
                  ours.mean,
                  {}});
    text += line({place, "bias", {}, ours.mean_error, intervals.bias});
    text += line({place, "variance", published ? published->variance : std::nullopt, ours.variance,
                  intervals.variance});
    text += line({place, "rmse", {}, ours.rms_error, intervals.rmse});
    text += line({place, "scans", {}, static_cast<double>(ours.n), {}});
    for (const eval::Duel& duel : row.duels) {
      if (duel.trials > 0) text += duel_lines(place, duel);
    }
    if (row.method == eval::kBeam) text += coverage_line(place, result.beam_coverage);
    if (row.method == eval::kBeamToGround) {
      text += coverage_line(place, result.beam_to_ground_coverage);
    }
  }
  return text;
}

}  // namespace

std::string tables_csv(const Results& results) {
  std::string text =
      "table,row,noise_mm,pose_jitter_deg,method,statistic,published,ours,difference,low,high\n";
  for (const ErrorRow& row : results.errors) text += error_lines(row);
  for (const SlopeBlock& block : results.slopes) text += slope_lines(block);
  return text;
}

std::string estimates_csv(const Results& results) {
  std::string text = "table,row,noise_mm,pose_jitter_deg,method,trial,angle_deg\n";
  for (const SlopeBlock& block : results.slopes) {
    for (const eval::MethodRow& row : block.result.rows) {
      const std::string place =
          place_of(block.table, block.result.slope, block.result.conditions.range_sigma,
                   block.result.conditions.tilt_sigma, row.method);
      for (std::size_t k = 0; k < row.summary.series.size(); ++k) {
        const std::optional<double>& angle = row.summary.series[k];
        if (angle) text += place + "," + std::to_string(k + 1) + "," + fixed(*angle, 6) + "\n";
      }
    }
  }
  return text;
}
