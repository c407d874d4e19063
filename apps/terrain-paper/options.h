// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "messages.h"

/// What the command line asked for.
struct Options {
  std::size_t trials = 50;  ///< scans per scene and condition
  int threads = 2;
  std::uint64_t seed = 1;
  std::string output_dir = "out";
  std::vector<int> tables = {2, 3, 4, 5};
  std::vector<double> noise_mm;  ///< standard deviations of the ranges; empty: each table's own
  double tilt_deg = 0.07;  ///< of roll and pitch in the rows with pose jitter; 0: no such rows
  double inlier_distance = 0.01;  ///< T_q, metres
  std::size_t lmeds_trials = 0;   ///< 0: all
  int resamples = 2000;
  bool refine = false;  ///< PCL's estimators refine their plane
  bool no_figures = false;
  Verbosity verbosity = Verbosity::kInfo;
  std::string command;  ///< as typed, for the report
};

/// Runs the experiments, prints the tables and writes the files. Returns an ExitCode.
int run_paper(const Options& options);
