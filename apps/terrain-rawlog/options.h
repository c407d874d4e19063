// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "messages.h"

/// Which observations of the inputs are meant.
struct Selection {
  std::string sensor_label = ".*";  ///< regular expression that the whole label must match
  std::size_t from_index = 0;       ///< first entry
  std::size_t to_index = std::numeric_limits<std::size_t>::max();  ///< last entry
  std::size_t only_first_n = 0;                                    ///< scans of the run; 0: all
};

/// What `process`, `map` and `label` read, and how observations become scans.
struct InputOptions {
  std::vector<std::string> inputs;
  bool scan_files = false;  ///< they are files of one scan each (KITTI's .bin), not recordings
  Selection selection;
  std::string poses;          ///< TUM file; empty: what the rawlog holds
  std::string sensor_pose;    ///< replaces the one of the observations; empty: keep
  std::string externals_dir;  ///< folder of externally stored data; empty: MRPT's rule
  bool find_ground = false;
};

struct ProcessOptions {
  InputOptions input;
  std::string config;                 ///< .ini file; empty: defaults
  std::vector<std::string> settings;  ///< "section.key=value", after the file
  std::string output_dir = "out";
  std::size_t every = 0;  ///< views of every n-th scan; 0: first, worst and last
  std::size_t table_rows = 15;
  Verbosity verbosity = Verbosity::kInfo;
};

struct LabelOptions {
  InputOptions input;
  std::string config;                 ///< .ini file; empty: defaults
  std::vector<std::string> settings;  ///< "section.key=value", after the file
  std::string output_dir = "out/labels";
  Verbosity verbosity = Verbosity::kInfo;
};

struct MapOptions {
  InputOptions input;
  std::string config;                 ///< a map's definition (.ini); empty: defaults
  std::vector<std::string> settings;  ///< "section.key=value", after the file
  std::string output = "out/map";     ///< beginning of the files' names, or a folder
  Verbosity verbosity = Verbosity::kInfo;
};

struct ExportOptions {
  std::string input;
  std::vector<std::string> settings;  ///< "renderOpts.key=value"
  std::string output;                 ///< beginning of the files' names, or a folder
  std::string points;                 ///< PLY file for the last scan's points; empty: none
  Verbosity verbosity = Verbosity::kInfo;
};

struct InfoOptions {
  std::vector<std::string> inputs;
  std::string externals_dir;
};

struct ImportCommandOptions {
  std::vector<std::string> inputs;
  std::string output;
  std::string format;  ///< kitti, pcd, ply; empty: by what the inputs are
  std::string sensor_pose;
  std::string sensor_label = "lidar";
  double period = 0.1;  ///< seconds
  std::size_t only_first_n = 0;
  Verbosity verbosity = Verbosity::kInfo;
};

/// The commands. Each returns an ExitCode and prints its own messages.
int run_process(const ProcessOptions& options);
int run_label(const LabelOptions& options);
int run_map(const MapOptions& options);
int run_export(const ExportOptions& options);
int run_info(const InfoOptions& options);
int run_import(const ImportCommandOptions& options);
