// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mrpt_terrain/sim/truth.h"

/// \file
/// Truth on disk: one folder per run, described in doc/truth-files.md.
///
///     format.json           version, names of the numbers below
///     objects.csv           one line per solid
///     cells.npy             one record per cell of a grid
///     labels/NNNNNN.label   per scan, one uint32 per return as in SemanticKITTI
///     points/NNNNNN.npy     per scan, one record per return
///
/// Every file appears as a whole or not at all, and folders are made as needed. All numbers are
/// little-endian. The writers throw std::runtime_error "FILE: cannot be written: reason".
namespace mrpt_terrain::sim {

/// Of the files; another number means that a reader of this one would misread them.
inline constexpr int kTruthVersion = 1;

/// Classes in the low 16 bits of labels; 0 is SemanticKITTI's "unlabeled".
inline constexpr std::uint16_t kLabelNotCounted = 0;
inline constexpr std::uint16_t kLabelGround = 40;
inline constexpr std::uint16_t kLabelAbove = 50;
inline constexpr std::uint16_t kLabelBelow = 52;

/// Labels of the returns of one scan: class by support in the low 16 bits, the solid's id in the
/// high 16 bits.
[[nodiscard]] std::vector<std::uint32_t> labels_of(const PointTruth& truth);

void write_truth_format(const std::string& folder);

void write_object_truth(const std::string& folder, const std::vector<ObjectTruth>& objects);

/// Writes heights, directions and centres of the cells in the map frame.
/// \param T_map_grid as given to `truth_of_cells`
void write_cell_truth(const std::string& folder, const Eigen::Isometry3d& T_map_grid,
                      const CellTruth& truth);

/// Writes labels and records of one scan.
/// \param scan its number, from 0
void write_point_truth(const std::string& folder, std::size_t scan, const PointTruth& truth);

}  // namespace mrpt_terrain::sim
