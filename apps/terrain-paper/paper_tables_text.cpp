// SPDX-License-Identifier: BSD-3-Clause
#include "paper_tables_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>

#include "mrpt_terrain/eval/published_tables.h"
#include "mrpt_terrain/view/text.h"

namespace {

namespace eval = mrpt_terrain::eval;
using mrpt_terrain::view::fixed;

constexpr const char* kNone = "-";
constexpr std::size_t kPublishedTrials = 50;
const std::array<const char*, 9> kPublishedMethods = {"ransac",  "lmeds",         "msac",
                                                      "rransac", "mlesac",        "prosac",
                                                      "pca",     "least_squares", "paper_method"};

std::string with_sign(double value, int decimals) {
  const std::string text = fixed(value, decimals);
  return text.find_first_not_of("-0.") == std::string::npos || text[0] == '-' ? text : "+" + text;
}

std::string interval(const eval::Interval& interval, int decimals) {
  return "[" + fixed(interval.low, decimals) + ", " + fixed(interval.high, decimals) + "]";
}

std::string millimetres(double metres) { return fixed(1e3 * metres, 0); }

bool with_intervals(const Results& results) { return results.trials > kPublishedTrials; }

std::string of_scans(std::size_t count, const Results& results) {
  return std::to_string(count) + " of " + std::to_string(results.trials) + " scans";
}

constexpr const char* kSplitRule =
    " falls into several clusters; the one with most of its returns is measured.";

/// A statistic of Tables 2 and 3: its name and where it is in theirs and ours.
struct ErrorColumn {
  const char* name;
  double eval::PublishedErrors::*published;
  double eval::ErrorStatistics::*ours;
};
constexpr std::array<ErrorColumn, 4> kErrorColumns = {
    {{"mean error", &eval::PublishedErrors::mean_error, &eval::ErrorStatistics::mean_error},
     {"mean |error|", &eval::PublishedErrors::mean_abs_error,
      &eval::ErrorStatistics::mean_abs_error},
     {"RMS error", &eval::PublishedErrors::rms_error, &eval::ErrorStatistics::rms_error},
     {"max |error|", &eval::PublishedErrors::max_abs_error,
      &eval::ErrorStatistics::max_abs_error}}};

std::vector<std::string> published_row(const eval::PublishedErrors& published,
                                       std::size_t columns) {
  std::vector<std::string> row{"published"};
  for (const ErrorColumn& column : kErrorColumns) {
    row.push_back(fixed(published.*column.published, 4));
    row.emplace_back(kNone);
  }
  row.resize(columns, kNone);
  return row;
}

std::vector<std::string> error_row(const ErrorRow& row, const eval::PublishedErrors& published,
                                   bool intervals) {
  std::vector<std::string> cells{millimetres(row.range_sigma) + " mm"};
  for (const ErrorColumn& column : kErrorColumns) {
    const double ours = row.summary.statistics.*column.ours;
    cells.push_back(fixed(ours, 4));
    cells.push_back(with_sign(std::abs(ours) - std::abs(published.*column.published), 4));
  }
  if (intervals) {
    cells.push_back(interval(row.summary.intervals.bias, 4));
    cells.push_back(interval(row.summary.intervals.rmse, 4));
  }
  return cells;
}

std::string error_note(const Results& results, const std::vector<const ErrorRow*>& rows) {
  std::string missing;
  std::string split;
  for (const ErrorRow* row : rows) {
    const std::string at = " at " + millimetres(row->range_sigma) + " mm,";
    if (row->summary.missing > 0) missing += " " + of_scans(row->summary.missing, results) + at;
    if (row->split > 0) split += " " + of_scans(row->split, results) + at;
  }
  std::string note = "diff: magnitude of ours minus magnitude of the published value.";
  if (!missing.empty()) note += " Not found in" + missing.substr(0, missing.size() - 1) + ".";
  if (!split.empty()) note += " In" + split + " it" + kSplitRule;
  return note;
}

TextTable error_table(const Results& results, const std::vector<const ErrorRow*>& rows) {
  const ErrorRow& first = *rows.front();
  const std::string unit = first.table == 2 ? "cm" : "deg";
  const auto published = eval::published_errors(first.target).value_or(eval::PublishedErrors{});
  TextTable table;
  table.title = "Table " + std::to_string(first.table) + ", " +
                (first.table == 2 ? "height index of the " : "slope angle of ") + first.target +
                ": truth " + fixed(first.truth, 2) + " " + unit + ", errors in " + unit + ", " +
                std::to_string(results.trials) + " scans";
  table.header = {"range noise"};
  for (const ErrorColumn& column : kErrorColumns) {
    table.header.emplace_back(column.name);
    table.header.emplace_back("diff");
  }
  const bool intervals = with_intervals(results);
  if (intervals) table.header.insert(table.header.end(), {"mean 95 %", "RMS 95 %"});
  table.rows.push_back(published_row(published, table.header.size()));
  for (const ErrorRow* row : rows) {
    table.rows.push_back(error_row(*row, published, intervals));
  }
  table.note = error_note(results, rows);
  return table;
}

std::string slope_title(const SlopeBlock& block, const Results& results) {
  const eval::SlopeResult& result = block.result;
  std::string title = "Table " + std::to_string(block.table) + ", slope " + result.slope +
                      ": truth " + fixed(result.truth, 2) + " deg; range noise " +
                      millimetres(result.conditions.range_sigma) + " mm, ";
  constexpr double kDegrees = 57.29577951308232;
  title += result.conditions.tilt_sigma > 0.0
               ? "pose jitter " + fixed(kDegrees * result.conditions.tilt_sigma, 2) + " deg"
               : "no pose jitter";
  return title + "; " + std::to_string(results.trials) + " scans";
}

const eval::MethodRow* row_of(const eval::SlopeResult& result, const std::string& method) {
  const auto row = std::find_if(result.rows.begin(), result.rows.end(),
                                [&](const eval::MethodRow& r) { return r.method == method; });
  return row == result.rows.end() ? nullptr : &*row;
}

// The nine methods of the paper, whether they ran or not, then ours.
std::vector<std::string> methods_of(const eval::SlopeResult& result) {
  std::vector<std::string> methods(kPublishedMethods.begin(), kPublishedMethods.end());
  for (const char* ours : {eval::kBeam, eval::kBeamToGround}) {
    if (row_of(result, ours) != nullptr) methods.emplace_back(ours);
  }
  return methods;
}

std::vector<std::string> verdicts(const eval::Duel& duel) {
  if (duel.trials == 0) return {kNone, kNone, kNone};
  std::vector<std::string> cells;
  for (const eval::Interval& difference :
       {duel.differences.abs_bias, duel.differences.variance, duel.differences.rmse}) {
    cells.emplace_back(mrpt_terrain::name_of(eval::verdict(difference)));
  }
  return cells;
}

/// A published number beside ours: three cells.
void add_comparison(const double* published, const double* ours, int decimals,
                    std::vector<std::string>& cells) {
  cells.push_back(published != nullptr ? fixed(*published, decimals) : kNone);
  cells.push_back(ours != nullptr ? fixed(*ours, decimals) : kNone);
  const bool both = published != nullptr && ours != nullptr;
  cells.push_back(both ? with_sign(*ours - *published, decimals) : kNone);
}

std::vector<std::string> slope_row(const eval::SlopeResult& result, const std::string& method,
                                   std::size_t columns) {
  const auto published = eval::published_slope(result.slope, method);
  const eval::MethodRow* row = row_of(result, method);
  const bool ran = row != nullptr && row->summary.statistics.n > 0;
  const eval::ErrorStatistics* ours = ran ? &row->summary.statistics : nullptr;
  std::vector<std::string> cells{method};
  add_comparison(published ? &published->mean : nullptr, ran ? &ours->mean : nullptr, 3, cells);
  const bool legible = published && published->variance;
  add_comparison(legible ? &*published->variance : nullptr, ran ? &ours->variance : nullptr, 4,
                 cells);
  if (!ran) {
    cells.resize(columns, kNone);
    return cells;
  }
  cells.push_back(with_sign(ours->mean_error, 3));
  cells.push_back(fixed(ours->rms_error, 3));
  cells.push_back(std::to_string(ours->n));
  for (const eval::Duel& duel : row->duels) {
    for (std::string& cell : verdicts(duel)) cells.push_back(std::move(cell));
  }
  cells.resize(columns, "");
  return cells;
}

std::string coverage_text(const std::string& method,
                          const std::optional<eval::Coverage>& coverage) {
  if (!coverage) return {};
  return " The truth is within twice the uncertainty that " + method + " states in " +
         fixed(100.0 * coverage->share, 1) + " % of " + std::to_string(coverage->n) +
         " scans (95 % interval " + fixed(100.0 * coverage->interval.low, 1) + " to " +
         fixed(100.0 * coverage->interval.high, 1) + " %).";
}

std::string slope_note(const SlopeBlock& block, const Results& results) {
  const eval::SlopeResult& result = block.result;
  std::string note;
  for (const eval::MethodRow& row : result.rows) {
    if (row.summary.missing == 0) continue;
    note += " " + row.method + " has no answer in " + of_scans(row.summary.missing, results) + ".";
  }
  if (block.split > 0) {
    note += " In " + of_scans(block.split, results) + " the slope" + kSplitRule;
  }
  note += coverage_text(eval::kBeam, result.beam_coverage);
  note += coverage_text(eval::kBeamToGround, result.beam_to_ground_coverage);
  return note.empty() ? note : note.substr(1);
}

TextTable slope_table(const Results& results, const SlopeBlock& block) {
  const eval::SlopeResult& result = block.result;
  TextTable table;
  table.title = slope_title(block, results);
  table.header = {"method", "mean publ.", "ours", "diff", "var. publ.",
                  "ours",   "diff",       "bias", "RMSE", "scans"};
  for (const char* ours : {eval::kBeam, eval::kBeamToGround}) {
    if (row_of(result, ours) == nullptr) continue;
    const std::string name = ours == std::string(eval::kBeam) ? "beam: " : "to ground: ";
    for (const char* statistic : {"bias", "var.", "RMSE"}) table.header.push_back(name + statistic);
  }
  for (const std::string& method : methods_of(result)) {
    table.rows.push_back(slope_row(result, method, table.header.size()));
  }
  table.note = slope_note(block, results);
  return table;
}

TextTable interval_table(const Results& results, const SlopeBlock& block) {
  TextTable table;
  table.title = "95 % intervals: " + slope_title(block, results);
  table.header = {"method", "bias, deg", "variance, deg^2", "RMSE, deg"};
  for (const eval::MethodRow& row : block.result.rows) {
    if (row.summary.statistics.n == 0) continue;
    const eval::ErrorIntervals& intervals = row.summary.intervals;
    table.rows.push_back({row.method, interval(intervals.bias, 4), interval(intervals.variance, 5),
                          interval(intervals.rmse, 4)});
  }
  return table;
}

// Verdicts of all blocks with or without pose jitter in one line each.
TextTable verdict_table(const Results& results) {
  TextTable table;
  table.title = "Verdicts over all slopes and noise levels: better / tie / worse";
  table.header = {"estimator", "pose jitter", "bias", "variance", "RMSE"};
  std::map<std::pair<std::string, bool>, std::array<std::array<int, 3>, 3>> counts;
  for (const SlopeBlock& block : results.slopes) {
    for (const eval::MethodRow& row : block.result.rows) {
      for (const eval::Duel& duel : row.duels) {
        if (duel.trials == 0) continue;
        auto& count = counts[{duel.ours, block.result.conditions.tilt_sigma > 0.0}];
        const std::array<eval::Interval, 3> all = {
            duel.differences.abs_bias, duel.differences.variance, duel.differences.rmse};
        for (std::size_t k = 0; k < all.size(); ++k) {
          ++count[k][static_cast<std::size_t>(eval::verdict(all[k]))];
        }
      }
    }
  }
  for (const auto& [key, count] : counts) {
    std::vector<std::string> cells{key.first, key.second ? "yes" : "no"};
    for (const auto& n : count) {
      cells.push_back(std::to_string(n[0]) + " / " + std::to_string(n[1]) + " / " +
                      std::to_string(n[2]));
    }
    table.rows.push_back(std::move(cells));
  }
  return table;
}

}  // namespace

std::vector<TextTable> paper_tables(const Results& results) {
  std::vector<TextTable> tables;
  std::vector<const ErrorRow*> rows;
  // Rows of one target at all noise levels make one table.
  std::vector<std::string> targets;
  for (const ErrorRow& row : results.errors) {
    if (std::find(targets.begin(), targets.end(), row.target) == targets.end()) {
      targets.push_back(row.target);
    }
  }
  for (const std::string& target : targets) {
    rows.clear();
    for (const ErrorRow& row : results.errors) {
      if (row.target == target) rows.push_back(&row);
    }
    tables.push_back(error_table(results, rows));
  }
  for (const SlopeBlock& block : results.slopes) {
    tables.push_back(slope_table(results, block));
    if (with_intervals(results)) tables.push_back(interval_table(results, block));
  }
  TextTable summary = verdict_table(results);
  if (!summary.rows.empty()) tables.push_back(std::move(summary));
  return tables;
}
