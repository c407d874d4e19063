// SPDX-License-Identifier: BSD-3-Clause
#include "report_files.h"

#include <array>
#include <cmath>
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

constexpr const char* kStyle =
    "body{font:15px/1.45 sans-serif;margin:2em auto;max-width:72em;padding:0 1em;color:#222}"
    "table{border-collapse:collapse;font-variant-numeric:tabular-nums;font-size:13px;"
    "display:block;overflow-x:auto}"
    "th,td{padding:.2em .6em;text-align:right;border-bottom:1px solid #ddd;white-space:nowrap}"
    "th{border-bottom:2px solid #888}"
    "th:first-child,td:first-child{text-align:left}"
    "td.better{color:#176b1c}td.worse{color:#a61b1b}td.tie{color:#777}"
    "img{max-width:100%;height:auto}figure{margin:1.5em 0}figcaption{color:#444}"
    "pre{background:#f4f4f4;padding:.6em;overflow-x:auto}";

std::string seconds_text(double seconds) {
  const auto whole = static_cast<long>(std::lround(seconds));
  return std::to_string(whole / 60) + " min " + std::to_string(whole % 60) + " s";
}

std::string how_it_was_made(const Options& options, const Results& results,
                            const std::vector<std::string>& remarks) {
  std::string html = "<h2>How this was made</h2>\n<pre>" + html_escaped(options.command) +
                     "</pre>\n<p>terrain-paper " MRPT_TERRAIN_VERSION ", " +
                     std::to_string(results.trials) + " scans per scene and condition, seed " +
                     std::to_string(options.seed) + ", inlier distance T_q " +
                     fixed(1e3 * options.inlier_distance, 1) + " mm, " +
                     std::to_string(options.resamples) + " bootstrap resamples; it took " +
                     seconds_text(results.seconds) +
                     ". Each scan is one turn of a simulated HDL-32E, level at 0.81 m, with range "
                     "noise and nothing else; scenes are in params/scenes, the description is that "
                     "of params/paper.ini. All numbers are in <a href=\"tables.csv\">tables.csv</a>"
                     ", all angles in <a href=\"estimates.csv\">estimates.csv</a>; scripts and "
                     "data of the figures are in <code>figures/</code>.</p>\n";
  for (const std::string& remark : remarks) html += "<p>" + html_escaped(remark) + "</p>\n";
  return html;
}

constexpr const char* kReading =
    "<h2>How to read the tables</h2>\n<p>diff is ours minus published; in Tables 2 and 3 of the "
    "magnitudes. The verdicts compare our estimators (<b>beam</b>: angle against the robot's "
    "horizontal; <b>to ground</b>: against the ground seen in the same scan) with the method of "
    "the row, in the same scans: <i>better</i> and <i>worse</i> if the 95 % bootstrap interval of "
    "the paired difference leaves out zero, <i>tie</i> otherwise. bias compares the magnitudes of "
    "the mean errors. Angles are in degrees, variances in degrees squared.</p>\n";

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

std::string report_html(const Options& options, const Results& results,
                        const std::vector<TextTable>& tables, const std::vector<Figure>& figures,
                        const std::vector<std::string>& remarks) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width\">\n"
      "<title>Terrain description: the paper's experiments repeated</title>\n<style>";
  html += kStyle;
  html +=
      "</style>\n</head>\n<body>\n<h1>Terrain description: the paper's experiments repeated</h1>\n"
      "<p>Tables 2 to 5 and Figures 6 to 14 of X. Meng, Z. Cao, S. Liang, L. Pang, S. Wang, C. "
      "Zhou, <i>A terrain description method for traversability analysis based on elevation grid "
      "map</i>, Int. J. of Advanced Robotic Systems, 2018, DOI 10.1177/1729881417751530, repeated "
      "in simulation.</p>\n";
  html += how_it_was_made(options, results, remarks) + kReading + "<h2>Tables</h2>\n";
  for (const TextTable& table : tables) html += as_html(table);
  if (!figures.empty()) html += "<h2>Figures</h2>\n";
  for (const Figure& figure : figures) {
    const std::string number =
        std::to_string(std::stoi(figure.name.substr(figure.name.size() - 2)));
    const std::string path = "figures/" + figure.name;
    html += "<figure><a href=\"" + path + ".svg\"><img src=\"" + path + ".png\" alt=\"Figure " +
            number + "\"></a>\n<figcaption>Figure " + number + ". " + html_escaped(figure.caption) +
            "</figcaption></figure>\n";
  }
  return html + "</body>\n</html>\n";
}
