// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <regex>
#include <string>

#include "exit_code.h"
#include "messages.h"
#include "mrpt_terrain/core/ground_plane.h"
#include "mrpt_terrain/io/scan.h"
#include "mrpt_terrain/view/run_summary.h"
#include "mrpt_terrain/view/scan_record.h"
#include "options.h"
#include "scan_pipeline.h"

/// State of one run over the scans of the inputs: what was used so far, and what was passed over
/// and why.
struct ScanReading {
  const InputOptions& options;
  Messages& messages;
  RepeatedWarnings warnings{messages};
  std::regex sensor_label;
  ScanPipeline pipeline;
  mrpt_terrain::view::RunSummary summary;          ///< the command adds the scans that it used
  bool ground_known = false;                       ///< `--find-ground` has found it
  std::size_t entries = 0;                         ///< that were read, asked for or not
  std::map<std::string, std::size_t> no_geometry;  ///< observations that never have points
  /// Hand on scans of which every return was left out, too; they are told all the same.
  bool empty_scans = false;
  int exit_code = kExitOk;

  /// Needs options that `check_options` has passed. Throws std::runtime_error if the project's
  /// sensor models cannot be read.
  ScanReading(const InputOptions& given, Messages& to, const mrpt_terrain::io::InputParams& input,
              const mrpt_terrain::GroundPlaneParams& ground_plane);

  /// Not all scans could be used as asked.
  void incomplete();
  /// An observation that should have been used was not.
  void pass_over(const std::string& kind, const std::string& place, const std::string& reason);
  /// Whether there are as many scans as asked for, or the user wants to stop.
  [[nodiscard]] bool enough() const;
};

/// Gets each scan that was asked for. Its points are in `pipeline.sensor_points`, in the sensor's
/// frame; file, entry, number, label and time of reading are filled in.
using ScanHandler = std::function<void(mrpt_terrain::view::ScanRecord& record)>;

/// Refuses wrong use that would otherwise be met with half of the work done, or never. Throws
/// std::invalid_argument, or std::runtime_error for what is wrong in the TUM file.
void check_options(const InputOptions& options);

/// Whether any input can be read; the problems of all are told if not. A run without any must not
/// replace the results of an earlier one.
[[nodiscard]] bool any_readable(const InputOptions& options, Messages& messages);

/// Reads the inputs one after the other until there is `enough`. Damage is told, and the scans
/// before it were handed on.
void read_inputs(ScanReading& reading, const ScanHandler& handle);

/// "FILE: entry N", or "FILE" where that is one scan: the beginning of messages.
[[nodiscard]] std::string place_of(const mrpt_terrain::view::ScanRecord& record,
                                   const InputOptions& options);

/// What messages about scans say differently for each command.
struct ScanWords {
  std::string extent;        ///< where the extent of the map is given
  std::string without_pose;  ///< what was done with a scan for which `--poses` has no pose
};

/// Tells what a person should know about a scan that gave little or nothing (`record.counts`), or
/// that has no pose although `--poses` was given.
void warn_about(const mrpt_terrain::view::ScanRecord& record, const ScanWords& words,
                ScanReading& reading);

/// Lines "  3 x reason".
[[nodiscard]] std::string counts_text(const std::map<std::string, std::size_t>& counts);

/// Tells why a run over readable files used no scan, if it did not; `complaint` says so.
void complain_about_nothing(const std::string& complaint, ScanReading& reading);

/// The exceptions of a command: those of `prepare` are wrong use; running out of memory in `run`
/// is an input that is too large, and everything else an output that cannot be written.
/// \param smaller what to make smaller when the memory does not suffice
/// \return an ExitCode
int run_command(Messages& messages, const std::string& smaller,
                const std::function<void()>& prepare, const std::function<int()>& run);
