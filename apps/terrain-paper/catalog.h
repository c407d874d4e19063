// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "mrpt_terrain/eval/paper_experiments.h"

/// A scene of params/scenes and what is measured in it.
struct CatalogEntry {
  int table = 0;      ///< of the paper
  std::string scene;  ///< file without folder and extension
  std::vector<mrpt_terrain::eval::Target> targets;
};

/// The scenes of Tables 2 to 5, in the order of the paper.
[[nodiscard]] const std::vector<CatalogEntry>& catalog();

/// Noise levels at which a table is made unless others are asked for, millimetres.
[[nodiscard]] std::vector<double> usual_noise_mm(int table);
