// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "messages.h"
#include "mrpt_terrain/eval/labelled_scans.h"

/// What both commands take.
struct CommonOptions {
  std::string config;                 ///< .ini; empty: defaults
  std::vector<std::string> settings;  ///< "section.key=value"
  double pitch_deg = 0.0;             ///< disturbance
  double raise = 0.0;                 ///< disturbance, metres
  double radius = 0.0;                ///< metres; 0: everything counts
  std::string csv;                    ///< empty: none
  std::string dump;                   ///< folder; empty: none
  bool details = false;
  Verbosity verbosity = Verbosity::kInfo;
};

struct WorldsOptions {
  CommonOptions common;
  std::vector<std::string> families = {"all"};
  std::string seeds = "0:10";  ///< "first:end"
  bool judging = false;        ///< seeds for judging are permitted
  std::size_t scans = 8;       ///< per world
  std::size_t threads = 1;
  bool approach = false;
  std::size_t follow = 0;  ///< consecutive scans
  std::size_t fused = 0;   ///< scans per world that a terrain map takes; 0: no map
  std::string sensor;      ///< instead of the world's
  double sensor_z = 0.0;   ///< instead of the world's; 0: the world's
  double speed = 0.0;      ///< instead of the world's; 0: the world's
  std::uint64_t noise_seed = 1;
  bool skewed = false;
  bool level = false;
  std::string false_potholes;  ///< CSV; empty: none
  std::string things;          ///< CSV; empty: none
  std::string costs;           ///< robot file; empty: costs are not looked at
  bool grid_costs = false;     ///< costs of the grid alone
};

struct LabelledOptions {
  CommonOptions common;
  std::vector<std::string> folders;
  mrpt_terrain::eval::LabelSet classes = mrpt_terrain::eval::LabelSet::kSemanticKitti;
  double sensor_height = 0.0;  ///< metres above the ground
  bool find_ground = false;
};

/// Do what the command line asks. Return an ExitCode and print their own messages.
int run_worlds(const WorldsOptions& options);
int run_fused_worlds(const WorldsOptions& options);
int run_labelled(const LabelledOptions& options);
