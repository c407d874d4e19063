// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "messages.h"

/// The command line.
struct SimOptions {
  std::string scene;   ///< file; empty: a world of `family`
  std::string family;  ///< name or file
  std::uint64_t family_seed = 0;
  std::string sensor;                 ///< name or file; empty: the scene's
  std::string path;                   ///< "x,y; x,y ..." or a file; empty: the scene's
  std::optional<double> speed;        ///< metres per second; none: the scene's
  std::vector<std::string> settings;  ///< "section.key=value"
  bool perfect = false;               ///< no noise
  std::optional<double> max_range;    ///< metres; none: the sensor's
  std::uint64_t seed = 1;
  std::size_t sweeps = 0;          ///< at most; 0: all
  std::optional<double> duration;  ///< seconds; none: to the end of the path
  double every = 0.0;              ///< metres of way between sweeps; 0: all sweeps
  std::string output;              ///< rawlog; empty: none
  std::string label = "lidar";
  bool packets = false;
  bool deskewed = false;
  bool truth = true;
  double cell_size = 0.1;  ///< metres, of the truth
  std::string preview;     ///< PNG; empty: none
  Verbosity verbosity = Verbosity::kInfo;
};

/// Does what the command line asks. Returns an ExitCode and prints its own messages.
int run_simulation(const SimOptions& options);
