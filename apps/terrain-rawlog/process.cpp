// SPDX-License-Identifier: BSD-3-Clause
// terrain-rawlog process: describes every scan of rawlogs and simple maps.
#include <chrono>
#include <stdexcept>
#include <string>
#include <vector>

#include "app_params.h"
#include "exit_code.h"
#include "mrpt_terrain/core/unseen_cells.h"
#include "mrpt_terrain/view/run_summary.h"
#include "mrpt_terrain/view/tables.h"
#include "mrpt_terrain/view/text.h"
#include "options.h"
#include "outputs.h"
#include "scan_pipeline.h"
#include "scan_reading.h"
#include "stop_signal.h"

namespace {

using namespace mrpt_terrain;
const ScanWords kWords{"[grid]", "described without"};

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// State of one run of `process`.
struct Run {
  const ProcessOptions& options;
  ScanReading reading;
  ScanDescriber describer;
  Outputs outputs;
  DrawableScan worst;  ///< so far; valid if summary.worst_scan
  double worst_share = -1.0;
  view::ScanRecord last;

  Run(const ProcessOptions& given, const AppParams& params, Messages& messages)
      : options(given),
        reading(given.input, messages, params.input, params.ground_plane),
        outputs(given.output_dir, params) {
    describer.params = params.description;
  }
};

std::string scan_title(const view::ScanRecord& record) {
  std::string title = "scan " + std::to_string(record.index) + ": " + view::base_name(record.file) +
                      " entry " + std::to_string(record.entry);
  if (!record.sensor_label.empty()) title += ", " + view::printable(record.sensor_label);
  return title + ", " + view::time_text(record.stamp);
}

void print_scan(const view::ScanRecord& record, Run& run) {
  if (!run.reading.messages.shows(Verbosity::kInfo)) return;
  const Description& description = run.describer.description;
  run.reading.messages.info(scan_title(record) + "\n" + view::class_summary(description) + "\n" +
                            view::cluster_table(description, run.options.table_rows) +
                            view::hole_table(description, run.options.table_rows) + "\n");
  run.reading.messages.debug("milliseconds: reading " + view::fixed(record.milliseconds.io, 2) +
                             ", total " + view::fixed(record.milliseconds.total, 2) + "\n\n");
}

// Share of the points in the map that are not ground: the larger, the less the method understood.
double trouble(const view::ScanRecord& record) {
  const auto ground = record.counts.per_support[static_cast<std::size_t>(Support::kGround)];
  const auto unknown = record.counts.per_support[static_cast<std::size_t>(Support::kUnknown)];
  const std::size_t in_map = record.counts.points - unknown;
  return in_map == 0 ? 1.0 : 1.0 - static_cast<double>(ground) / static_cast<double>(in_map);
}

// Of the scan that was described last; nothing in paper mode.
std::vector<UnseenReason> unseen_cells(Run& run) {
  std::vector<UnseenReason> reasons;
  if (run.describer.params.description.mode != DescriptionMode::kField) return reasons;
  UnseenWorkspace workspace;
  explain_unseen_cells(view_of(run.reading.pipeline.scan), run.describer.workspace,
                       run.describer.description, workspace, reasons);
  return reasons;
}

void keep_for_views(const view::ScanRecord& record, Run& run) {
  const Description& description = run.describer.description;
  const Points& points = run.reading.pipeline.scan.points;
  if (run.options.every != 0) {
    if (record.index % run.options.every == 0) {
      run.outputs.write_views(record, points, description, unseen_cells(run),
                              "scan " + std::to_string(record.index));
    }
  } else if (record.index == 0) {
    run.outputs.write_views(record, points, description, unseen_cells(run), "first scan");
  }
  const double share = trouble(record);
  if (share > run.worst_share) {
    run.worst_share = share;
    if (run.options.every == 0) run.worst = {record, points, description, unseen_cells(run)};
    run.reading.summary.worst_scan = view::ScanReference{
        record.file, record.entry, record.index,
        view::fixed(100 * share, 1) + " % of its points in the map are not ground"};
  }
  run.last = record;
}

void process_scan(view::ScanRecord& record, Run& run) {
  describe_scan(run.reading.pipeline, run.describer, record);
  record.milliseconds.total += record.milliseconds.io;
  run.outputs.add_rows(record, run.describer.description);
  view::add_scan(run.reading.summary, record);
  print_scan(record, run);
  warn_about(record, kWords, run.reading);
  keep_for_views(record, run);
}

void write_last_views(Run& run) {
  if (run.reading.summary.scans_processed == 0 || run.options.every != 0) return;
  run.outputs.write_views(run.worst.record, run.worst.points, run.worst.description,
                          run.worst.unseen, "worst scan");
  run.outputs.write_views(run.last, run.reading.pipeline.scan.points, run.describer.description,
                          unseen_cells(run), "last scan");
}

void report(Run& run) {
  const view::RunSummary& summary = run.reading.summary;
  const std::size_t scans = summary.scans_processed;
  std::string text = std::to_string(scans) + (scans == 1 ? " scan" : " scans") + " described in " +
                     view::fixed(summary.wall_seconds, 2) + " s\n";
  if (scans != 0 && !summary.scans_skipped.empty()) {
    text += "not described:\n" + counts_text(summary.scans_skipped);
  }
  for (const View& view : run.outputs.views()) text += view.why + ": " + view.picture + "\n";
  text += "tables, scenes, clouds, configuration: " + run.outputs.folder() + "\n";
  run.reading.messages.info(text);
  complain_about_nothing("no scan was described", run.reading);
}

int run_all(Run& run) {
  const Clock::time_point start = Clock::now();
  view::RunSummary& summary = run.reading.summary;
  try {
    read_inputs(run.reading, [&run](view::ScanRecord& record) { process_scan(record, run); });
    write_last_views(run);
  } catch (const std::exception&) {
    run.outputs.finish(summary);  // keeps the rows that there are
    throw;
  }
  summary.wall_seconds = seconds_since(start);
  run.outputs.finish(summary);
  report(run);
  if (!stop_requested()) return run.reading.exit_code;
  run.reading.messages.warn("interrupted; the files hold the scans up to here");
  return kExitInterrupted;
}

}  // namespace

int run_process(const ProcessOptions& options) {
  Messages messages(options.verbosity);
  AppParams params;
  const auto prepare = [&] {
    params = load_params(options.config, options.settings);
    check_options(options.input);
    if (options.output_dir.empty()) throw std::invalid_argument("--output-dir: needs a name");
  };
  return run_command(messages, "[grid]", prepare, [&]() -> int {
    if (!any_readable(options.input, messages)) return kExitInput;
    Run run(options, params, messages);
    return run_all(run);
  });
}
