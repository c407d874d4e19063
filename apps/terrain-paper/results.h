// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "mrpt_terrain/eval/paper_experiments.h"
#include "mrpt_terrain/eval/paper_tables.h"

/// A row of Table 2 (centimetres) or 3 (degrees).
struct ErrorRow {
  int table = 0;
  std::string target;
  double range_sigma = 0.0;  ///< metres
  double truth = 0.0;
  mrpt_terrain::eval::SeriesSummary summary;
  std::size_t split = 0;  ///< trials in which the target fell into several clusters
};

/// One block of Table 4 or 5.
struct SlopeBlock {
  int table = 0;
  mrpt_terrain::eval::SlopeResult result;
  std::size_t split = 0;
};

/// One target of Tables 2 and 3 over all trials at the noise of the figures.
struct TargetSeries {
  std::string target;
  double height = 0.0;                      ///< truth, centimetres
  double slope = 0.0;                       ///< truth, degrees
  mrpt_terrain::eval::Series height_index;  ///< centimetres
  mrpt_terrain::eval::Series rough;         ///< 0 or 1
  mrpt_terrain::eval::Series angle;         ///< degrees
};

/// First scan of a scene at the noise of the figures.
struct SceneCloud {
  std::string scene;
  std::vector<std::string> targets;
  mrpt_terrain::eval::ScanPicture picture;
};

/// All that a run found out.
struct Results {
  bool complete = false;             ///< false: the run was interrupted
  std::vector<std::string> methods;  ///< names of the estimators that ran
  std::size_t trials = 0;
  double figure_sigma = 0.0;  ///< noise of the figures, metres
  std::vector<ErrorRow> errors;
  std::vector<SlopeBlock> slopes;
  std::vector<TargetSeries> series;
  std::vector<SceneCloud> clouds;
  double seconds = 0.0;
};
