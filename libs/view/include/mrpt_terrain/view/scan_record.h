// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "mrpt_terrain/core/describe.h"

namespace mrpt_terrain::view {

inline constexpr std::size_t kSupportCount = enum_names(Support{}).size();
inline constexpr std::size_t kReasonCount = enum_names(UnknownReason{}).size();
inline constexpr std::size_t kClassCount = enum_names(TerrainClass{}).size();

/// How many points, cells and clusters of one description are what.
struct DescriptionCounts {
  std::size_t points = 0;                                ///< given to `describe`
  std::array<std::size_t, kReasonCount> per_reason{};    ///< points, index: UnknownReason
  std::array<std::size_t, kSupportCount> per_support{};  ///< points, index: Support
  std::size_t observed_cells = 0;
  std::size_t ground_cells = 0;
  std::size_t non_ground_cells = 0;
  std::array<std::size_t, kClassCount> clusters{};  ///< clusters, index: TerrainClass
  std::size_t dropped_groups = 0;                   ///< groups too small to be a cluster
};

[[nodiscard]] DescriptionCounts count(const Description& description);

/// Wall time of one scan, milliseconds.
struct ScanMilliseconds {
  double io = 0.0;                          ///< reading and decoding the observation
  double transform = 0.0;                   ///< into the robot frame, de-skewing included
  std::array<double, kStageCount> stage{};  ///< index: Stage
  double total = 0.0;                       ///< all of the above and what lies between
};

/// Returns that the reader left out before there was a point to describe.
struct LeftOutReturns {
  std::size_t no_return = 0;     ///< zero returns and rays flagged invalid
  std::size_t not_finite = 0;    ///< NaN or infinite
  std::size_t out_of_range = 0;  ///< too close to the sensor or too far from it
};

/// All that is known of one described scan beside its description; a line of scans.csv.
struct ScanRecord {
  std::string file;       ///< as the user named it
  std::size_t entry = 0;  ///< index in the file as rawlog tools count
  std::size_t index = 0;  ///< number of the scan in this run, from 0
  double stamp = 0.0;     ///< seconds since the Unix epoch or the start of the data set
  std::string sensor_label;
  LeftOutReturns left_out;
  DescriptionCounts counts;
  ScanMilliseconds milliseconds;
};

}  // namespace mrpt_terrain::view
