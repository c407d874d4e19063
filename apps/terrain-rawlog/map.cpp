// SPDX-License-Identifier: BSD-3-Clause
// terrain-rawlog map: one terrain map out of the scans of rawlogs and simple maps.
#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <string>

#include "exit_code.h"
#include "map_settings.h"
#include "map_text.h"
#include "mrpt_terrain/map/map_file.h"
#include "mrpt_terrain/map/terrain_map.h"
#include "mrpt_terrain/view/text.h"
#include "options.h"
#include "output_place.h"
#include "scan_reading.h"
#include "stop_signal.h"

namespace {

using namespace mrpt_terrain;
using Clock = std::chrono::steady_clock;

const ScanWords kWords{"[..._creationOpts]", "inserted at the origin of the map"};

/// State of one run of `map`.
struct MapRun {
  std::string prefix;
  ScanReading reading;
  CTerrainMap map;
  std::size_t without_pose = 0;  ///< scans that were inserted at the origin
  double total_ms = 0.0, longest_ms = 0.0;

  MapRun(const MapOptions& options, const MapParams& params, Messages& messages)
      : prefix(map_prefix(options.output)),
        reading(options.input, messages, params.input, GroundPlaneParams{}),
        map(params) {}
};

// Only scans that are described each by itself can do without a pose.
bool may_insert(const view::ScanRecord& record, MapRun& run) {
  if (run.reading.pipeline.scan.T_map_robot) return true;
  if (run.map.params().creation.fusion == Fusion::kScan) {
    ++run.without_pose;
    return true;
  }
  const std::string& poses = run.reading.options.poses;
  run.reading.pass_over(
      "no pose", place_of(record, run.reading.options),
      (poses.empty() ? "there is no pose for its time " : poses + " has no pose for its time ") +
          view::fixed(record.stamp, 6) + " s; not inserted");
  return false;
}

void insert(view::ScanRecord& record, MapRun& run) {
  const Clock::time_point start = Clock::now();
  place_scan(run.reading.pipeline, record);
  if (!may_insert(record, run)) return;
  const io::Scan& scan = run.reading.pipeline.scan;
  if (!run.map.insert_scan(scan, scan.T_map_robot.value_or(mrpt::poses::CPose3D()))) {
    run.reading.pass_over("no finite point", place_of(record, run.reading.options),
                          "none of its points is finite");
    return;
  }
  const double ms = 1e3 * std::chrono::duration<double>(Clock::now() - start).count();
  run.total_ms += ms;
  run.longest_ms = std::max(run.longest_ms, ms);
  record.milliseconds.total = ms + record.milliseconds.io;
  record.counts = view::count(run.map.snapshot()->description);
  view::add_scan(run.reading.summary, record);
  run.reading.messages.debug(place_of(record, run.reading.options) + ": inserted in " +
                             view::fixed(ms, 1) + " ms\n");
  warn_about(record, kWords, run.reading);
}

void report(const MapRun& run) {
  const view::RunSummary& summary = run.reading.summary;
  const std::size_t scans = summary.scans_processed;
  std::string text = std::to_string(scans) + (scans == 1 ? " scan" : " scans") + " inserted in " +
                     view::fixed(summary.wall_seconds, 2) + " s; milliseconds per scan: mean " +
                     view::fixed(run.total_ms / static_cast<double>(scans), 1) + ", longest " +
                     view::fixed(run.longest_ms, 1) + "\n";
  if (!summary.scans_skipped.empty()) {
    text += "not inserted:\n" + counts_text(summary.scans_skipped);
  }
  if (run.without_pose != 0) {
    text += std::to_string(run.without_pose) + " without a pose: inserted at the origin\n";
  }
  run.reading.messages.info(text + map_text(run.map) +
                            files_text(run.map, run.prefix, ".metricmap"));
}

int build(MapRun& run) {
  const Clock::time_point start = Clock::now();
  check_writable(run.prefix);
  read_inputs(run.reading, [&run](view::ScanRecord& record) { insert(record, run); });
  run.reading.summary.wall_seconds = std::chrono::duration<double>(Clock::now() - start).count();
  const bool any = run.reading.summary.scans_processed != 0;
  if (any) {
    save_map_file(run.map, run.prefix + ".metricmap");
    run.map.saveMetricMapRepresentationToFile(run.prefix);
    report(run);
  }
  complain_about_nothing("no scan was inserted; nothing was written", run.reading);
  if (!stop_requested()) return run.reading.exit_code;
  run.reading.messages.warn(any ? "interrupted; the map holds the scans up to here"
                                : "interrupted; nothing was written");
  return kExitInterrupted;
}

}  // namespace

int run_map(const MapOptions& options) {
  Messages messages(options.verbosity);
  MapParams params;
  const auto prepare = [&] {
    params = load_map_settings(options.config, options.settings);
    check_options(options.input);
    if (options.output.empty()) throw std::invalid_argument("--output: needs a name");
  };
  return run_command(messages, "[..._creationOpts]", prepare, [&]() -> int {
    if (!any_readable(options.input, messages)) return kExitInput;
    MapRun run(options, params, messages);
    return build(run);
  });
}
