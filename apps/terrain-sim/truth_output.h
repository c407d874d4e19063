// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include "simulation.h"

/// Folder of truth files (sim/truth_files.h), with heights, ranges and angles rounded far below
/// what they are used for, so that the last bits of sines and cosines do not get into the files. It
/// is written as `<name>.part` and gets its name with `commit`; without, nothing is left.
class TruthOutput {
 public:
  /// \param cell_size of the grid of the cells, metres
  TruthOutput(std::string folder, double cell_size);
  ~TruthOutput();
  TruthOutput(const TruthOutput&) = delete;
  TruthOutput& operator=(const TruthOutput&) = delete;

  /// Objects and cells; the grid covers what the preview shows.
  void add_scene(const Simulation& simulation);
  /// The next sweep.
  void add_sweep(const Simulation& simulation, const mrpt_terrain::sim::Sweep& sweep);
  /// Replaces the truth of an earlier run. Throws std::runtime_error if the folder holds something
  /// else.
  void commit();
  [[nodiscard]] const std::string& folder() const { return folder_; }

 private:
  std::string folder_, part_;
  double cell_size_;
  std::size_t sweeps_ = 0;
};
