// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "mrpt_terrain/core/describe.h"
#include "mrpt_terrain/eval/world_score.h"
#include "mrpt_terrain/sim/families.h"
#include "options.h"

/// What all worlds of a run share.
struct Plan {
  std::vector<mrpt_terrain::sim::Family> families;
  mrpt_terrain::sim::SeedRange seeds{0, 0};
  mrpt_terrain::eval::ScanOptions scans;
  mrpt_terrain::DescriptionParams description;
  mrpt_terrain::eval::ScoreRules rules;
  [[nodiscard]] std::size_t worlds_per_family() const {
    return static_cast<std::size_t>(seeds.end - seeds.first);
  }
  [[nodiscard]] std::size_t worlds() const { return families.size() * worlds_per_family(); }
};

/// Throws what is wrong with the options.
[[nodiscard]] Plan make_plan(const WorldsOptions& options);
