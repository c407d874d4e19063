// SPDX-License-Identifier: BSD-3-Clause
// terrain-rawlog label: a label per point of every scan, in the order of the input.
#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "app_params.h"
#include "exit_code.h"
#include "label_inputs.h"
#include "mrpt_terrain/files/atomic_file.h"
#include "mrpt_terrain/io/label_file.h"
#include "mrpt_terrain/io/slot_labels.h"
#include "mrpt_terrain/params/ini.h"
#include "mrpt_terrain/view/text.h"
#include "options.h"
#include "output_place.h"
#include "scan_pipeline.h"
#include "scan_reading.h"
#include "stop_signal.h"

namespace {

using namespace mrpt_terrain;
using Clock = std::chrono::steady_clock;
namespace fs = std::filesystem;

const ScanWords kWords{"[grid]", "labelled without"};
constexpr const char* kParams = "params.ini";

/// What became of the point slots of all scans.
struct SlotCounts {
  std::size_t slots = 0;
  std::map<std::uint16_t, std::size_t> per_class;  ///< of the labels that were written
  std::array<std::size_t, view::kReasonCount> per_reason{};
};

/// State of one run of `label`.
struct LabelRun {
  std::string folder;
  ScanReading reading;
  ScanDescriber describer;
  std::vector<std::uint32_t> labels;
  SlotCounts counts;
  std::string first_file, last_file;

  LabelRun(const std::string& output_dir, const InputOptions& input, const AppParams& params,
           Messages& messages)
      : folder(made_folder(output_dir)),
        reading(input, messages, params.input, params.ground_plane) {
    describer.params = params.description;
    reading.empty_scans = true;
    files::write_atomically((fs::path(folder) / kParams).string(), params::dump_ini(params));
  }
};

// Label files have the same names everywhere, and the truth of a data set is not to be replaced by
// what is to be judged. What this command wrote stands beside its parameters.
void refuse_labels_of_others(const std::string& folder) {
  if (folder.empty()) throw std::invalid_argument("--output-dir: needs a name");
  std::error_code error;
  if (fs::exists(fs::path(folder) / kParams, error)) return;
  fs::directory_iterator entry(folder, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    if (entry->path().extension() != ".label") continue;
    throw std::invalid_argument("--output-dir: " + folder +
                                " holds label files of another origin (there is no " + kParams +
                                " beside them); give another folder");
  }
}

void count(const view::ScanRecord& record, const std::vector<std::uint32_t>& labels,
           SlotCounts& counts) {
  counts.slots += labels.size();
  for (const std::uint32_t label : labels) ++counts.per_class[io::label_class(label)];
  for (std::size_t k = 0; k < view::kReasonCount; ++k) {
    counts.per_reason[k] += record.counts.per_reason[k];
  }
}

void label_scan(view::ScanRecord& record, LabelRun& run) {
  ScanReading& reading = run.reading;
  describe_scan(reading.pipeline, run.describer, record);
  io::label_slots(reading.pipeline.scan, run.describer.description.labels, run.labels);
  const std::string file =
      (fs::path(run.folder) /
       (reading.options.scan_files ? label_name(record.file) : label_name(record.index)))
          .string();
  io::write_labels(file, run.labels);
  if (run.first_file.empty()) run.first_file = file;
  run.last_file = file;
  count(record, run.labels, run.counts);
  view::add_scan(reading.summary, record);
  reading.messages.debug(place_of(record, reading.options) + ": " +
                         view::grouped(run.labels.size()) + " labels: " + file + "\n");
  if (record.counts.points != 0) warn_about(record, kWords, reading);
}

std::string points_text(SlotCounts& counts) {
  std::string text = view::grouped(counts.slots) + " points";
  const char* separator = ": ";
  for (const Support support :
       {Support::kGround, Support::kAbove, Support::kBelow, Support::kUnknown}) {
    const std::uint16_t id = io::label_class(io::slot_label(support, TerrainClass::kNone));
    text += separator + view::grouped(counts.per_class[id]) + " " + name_of(support) + " (" +
            std::to_string(id) + ")";
    separator = ", ";
  }
  return text + "\n";
}

std::string unknown_text(SlotCounts& counts, const view::RunSummary& summary) {
  const view::LeftOutReturns& left_out = summary.left_out;
  const std::size_t given = left_out.no_return + left_out.not_finite + left_out.out_of_range;
  // Decimated depth images; columns of range images that their maker left empty.
  const std::size_t not_read = counts.slots - std::min(counts.slots, summary.points + given);
  std::vector<std::pair<std::string, std::size_t>> parts = {
      {"without return", left_out.no_return}, {"out of range", left_out.out_of_range}};
  std::size_t told = given + not_read;
  for (const auto& [reason, name] : enum_names(UnknownReason{})) {
    if (reason == UnknownReason::kNone) continue;
    const std::size_t number = counts.per_reason[static_cast<std::size_t>(reason)];
    const bool finite = reason != UnknownReason::kNotFinite;
    std::string words = name;
    std::replace(words.begin(), words.end(), '_', ' ');
    parts.emplace_back(words, number + (finite ? 0 : left_out.not_finite));
    told += number;
  }
  parts.emplace_back("not read", not_read);
  parts.emplace_back("undecided", counts.per_class[0] - std::min(counts.per_class[0], told));
  std::string text;
  for (const auto& [name, number] : parts) {
    if (number == 0) continue;
    text += (text.empty() ? "unknown: " : ", ") + view::grouped(number) + " " + name;
  }
  return text.empty() ? text : text + "\n";
}

void report(LabelRun& run) {
  const view::RunSummary& summary = run.reading.summary;
  const std::size_t scans = summary.scans_processed;
  if (scans != 0) {
    std::string text = std::to_string(scans) + (scans == 1 ? " scan" : " scans") + " labelled in " +
                       view::fixed(summary.wall_seconds, 2) + " s: " + run.first_file;
    if (scans != 1) text += " to " + view::base_name(run.last_file);
    text += "\n" + points_text(run.counts) + unknown_text(run.counts, summary);
    if (!summary.scans_skipped.empty()) {
      text += "not labelled, or 0 only:\n" + counts_text(summary.scans_skipped);
    }
    run.reading.messages.info(text);
  }
  complain_about_nothing("no scan was labelled", run.reading);
}

int label_all(LabelRun& run) {
  const Clock::time_point start = Clock::now();
  read_inputs(run.reading, [&run](view::ScanRecord& record) { label_scan(record, run); });
  run.reading.summary.wall_seconds = std::chrono::duration<double>(Clock::now() - start).count();
  report(run);
  if (!stop_requested()) return run.reading.exit_code;
  run.reading.messages.warn("interrupted; the scans up to here are labelled");
  return kExitInterrupted;
}

/// The inputs, as far as they can be read at all; an exit code if there are none.
int check_inputs(const LabelInputs& found, const Selection& asked, Messages& messages) {
  for (const std::string& problem : found.problems) messages.error(problem);
  if (!found.input.inputs.empty()) {
    return any_readable(found.input, messages) ? kExitOk : kExitInput;
  }
  if (!found.problems.empty()) return kExitInput;
  messages.error("no scan was labelled\n  no input has an entry " +
                 std::to_string(asked.from_index) + " (--from-index)");
  return kExitIncomplete;
}

}  // namespace

int run_label(const LabelOptions& options) {
  Messages messages(options.verbosity);
  AppParams params;
  LabelInputs found;
  const auto prepare = [&] {
    params = load_params(options.config, options.settings);
    check_options(options.input);
    refuse_labels_of_others(options.output_dir);
    found = find_label_inputs(options.input);
  };
  return run_command(messages, "[grid]", prepare, [&]() -> int {
    const int problem = check_inputs(found, options.input.selection, messages);
    if (problem != kExitOk) return problem;
    LabelRun run(options.output_dir, found.input, params, messages);
    if (!found.problems.empty()) run.reading.exit_code = kExitInput;
    return label_all(run);
  });
}
