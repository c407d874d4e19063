// SPDX-License-Identifier: BSD-3-Clause
// terrain-rawlog import: data sets of other families as rawlogs.
#include "mrpt_terrain/io/import.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "exit_code.h"
#include "input_support.h"
#include "mrpt_terrain/io/observation_reader.h"
#include "mrpt_terrain/view/text.h"
#include "options.h"
#include "stop_signal.h"

namespace {

using namespace mrpt_terrain;

// A folder is KITTI's; files say it by their name.
std::string format_of(const ImportCommandOptions& options) {
  for (const std::string& input : options.inputs) {
    if (!std::filesystem::exists(input)) throw io::ReadError(input + ": no such file or folder");
    std::error_code different;
    if (std::filesystem::equivalent(input, options.output, different)) {
      throw std::invalid_argument("--output: " + options.output + " is one of the inputs");
    }
  }
  if (!options.format.empty()) return options.format;
  if (std::filesystem::is_directory(options.inputs.front())) return "kitti";
  const std::string extension = lower_extension(options.inputs.front());
  if (extension == ".pcd" || extension == ".ply") return extension.substr(1);
  throw std::invalid_argument(options.inputs.front() +
                              ": neither a folder (KITTI) nor a .pcd or .ply file; say which it is "
                              "with --format");
}

io::ImportSummary import_inputs(const ImportCommandOptions& options, const io::ImportOptions& how) {
  const std::string format = format_of(options);
  if (format == "pcd") return io::import_pcd(options.inputs, how, options.output);
  if (format == "ply") return io::import_ply(options.inputs, how, options.output);
  if (options.inputs.size() != 1) {
    throw std::invalid_argument("one KITTI folder at a time, please");
  }
  return io::import_kitti(options.inputs.front(), how, options.output);
}

void print(const io::ImportSummary& summary, Messages& messages) {
  messages.info(summary.rawlog + ": " + std::to_string(summary.scans) + " scans, " +
                view::grouped(summary.points) + " points, " + std::to_string(summary.poses) +
                " with a pose, " + std::to_string(summary.labelled_scans) + " with labels\n");
  if (!summary.poses_file.empty()) messages.info("poses: " + summary.poses_file + "\n");
  if (!summary.labels_folder.empty()) messages.info("labels: " + summary.labels_folder + "\n");
}

}  // namespace

int run_import(const ImportCommandOptions& options) {
  Messages messages(options.verbosity);
  try {
    io::ImportOptions how;
    if (!options.sensor_pose.empty()) how.T_robot_sensor = parse_pose(options.sensor_pose);
    how.sensor_label = options.sensor_label;
    how.period = options.period;
    how.max_scans = options.only_first_n;
    how.progress = [&messages](std::size_t done, std::size_t total) {
      messages.bar().show(
          static_cast<double>(done) / static_cast<double>(std::max<std::size_t>(1, total)),
          std::to_string(done) + " scans");
      return !stop_requested();
    };
    const io::ImportSummary summary = import_inputs(options, how);
    if (summary.stopped) {
      messages.warn("interrupted; nothing was written");
      return kExitInterrupted;
    }
    print(summary, messages);
    return kExitOk;
  } catch (const io::ReadError& error) {
    messages.error(error.what());
    return kExitInput;
  } catch (const std::invalid_argument& error) {
    messages.error(error.what());
    return kExitUsage;
  } catch (const std::exception& error) {
    messages.error(error.what());
    return kExitOutput;
  }
}
