// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mrpt_terrain/view/scan_record.h"

namespace mrpt_terrain::view {

/// A scan that is worth a look.
struct ScanReference {
  std::string file;
  std::size_t entry = 0;  ///< index in the file as rawlog tools count
  std::size_t index = 0;  ///< number of the scan in this run, from 0
  std::string why;        ///< for people
};

/// Totals over a run; fill it with `add_scan` and write it with `summary_json`.
struct RunSummary {
  std::string version;              ///< of the program
  std::vector<std::string> inputs;  ///< files as the user named them
  std::size_t scans_processed = 0;
  std::map<std::string, std::size_t> scans_skipped;    ///< reason -> number of observations
  std::map<std::string, std::size_t> unknown_classes;  ///< class names that MRPT does not know
  std::size_t points = 0;                              ///< of all processed scans
  LeftOutReturns left_out;                             ///< of all scans, skipped ones included
  std::array<std::size_t, kClassCount> clusters{};     ///< index: TerrainClass
  std::vector<ScanMilliseconds> milliseconds;          ///< one per processed scan
  std::size_t slowest = 0;                             ///< position in `milliseconds`
  std::optional<ScanReference> slowest_scan;           ///< the same scan, named
  std::optional<ScanReference> worst_scan;             ///< by whatever measure its `why` names
  double wall_seconds = 0.0;                           ///< the run from start to end
};

/// Adds the returns that were left out of one scan.
void add(LeftOutReturns& sum, const LeftOutReturns& scan);

/// Counts one processed scan.
void add_scan(RunSummary& summary, const ScanRecord& scan);

/// Median, 95th percentile (both by nearest rank: always a measured value) and maximum.
struct Quantiles {
  double median = 0.0;
  double p95 = 0.0;
  double max = 0.0;
};

/// All 0 without values.
[[nodiscard]] Quantiles quantiles(std::vector<double> values);

/// The summary as JSON, indented by two, ending in a newline. Times carry their unit in the key.
/// Bytes of names that are not UTF-8 become U+FFFD.
[[nodiscard]] std::string summary_json(const RunSummary& summary);

}  // namespace mrpt_terrain::view
