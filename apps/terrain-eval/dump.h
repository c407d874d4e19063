// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mrpt_terrain/core/points.h"
#include "mrpt_terrain/eval/world_score.h"

/// Writes FOLDER/FAMILY_SEED/{velodyne,labels,predictions}/NNNNNN.*, named by the sweep, and
/// objects.csv as in truth files. Throws std::runtime_error.
void dump_scan(const std::string& folder, const mrpt_terrain::eval::ScoredScan& scored);

/// Points, and labels of every kind, of one scan in the layout of SemanticKITTI.
struct DumpedScan {
  std::string name;                              ///< "000012"
  const mrpt_terrain::Points* points = nullptr;  ///< null: not written
  std::vector<std::uint32_t> truth;              ///< empty: not written
  std::vector<std::uint32_t> predictions;
};
void dump(const std::string& folder, const DumpedScan& scan);
