// SPDX-License-Identifier: BSD-3-Clause
#include "truth_output.h"

#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <utility>
#include <vector>

#include "mrpt_terrain/sim/truth.h"
#include "mrpt_terrain/sim/truth_files.h"
#include "surroundings.h"

using namespace mrpt_terrain;
namespace fs = std::filesystem;

namespace {

constexpr float kStepsPerMetre = 8192.0F;
constexpr float kStepsPerRadian = 8192.0F;

/// Multiples of a power of two; NaN stays, -0 becomes 0.
void round_all(std::vector<float>& values, float steps) {
  for (float& value : values) value = std::round(value * steps) / steps + 0.0F;
}

void round_cells(sim::CellTruth& truth) {
  for (auto* heights : {&truth.min, &truth.mean, &truth.max, &truth.ground_height}) {
    round_all(*heights, kStepsPerMetre);
  }
  round_all(truth.slope, kStepsPerRadian);
  round_all(truth.slope_direction, kStepsPerRadian);
  const float half_turn = std::round(static_cast<float>(M_PI) * kStepsPerRadian) / kStepsPerRadian;
  for (std::size_t k = 0; k < truth.slope.size(); ++k) {
    // Level cells rise nowhere, and half a turn either way is the same direction.
    if (truth.slope[k] == 0.0F) truth.slope_direction[k] = 0.0F;
    if (truth.slope_direction[k] == -half_turn) truth.slope_direction[k] = half_turn;
  }
}

/// Whether the folder was written by an earlier run.
bool is_truth(const std::string& folder) { return fs::exists(fs::path(folder) / "format.json"); }

}  // namespace

TruthOutput::TruthOutput(std::string folder, double cell_size)
    : folder_(std::move(folder)), part_(folder_ + ".part"), cell_size_(cell_size) {
  if (fs::exists(folder_) && !is_truth(folder_)) {
    throw std::runtime_error(folder_ + ": cannot be written: there is something else of that name");
  }
  fs::remove_all(part_);
  sim::write_truth_format(part_);
}

TruthOutput::~TruthOutput() {
  std::error_code ignored;
  fs::remove_all(part_, ignored);
}

void TruthOutput::add_scene(const Simulation& simulation) {
  sim::write_object_truth(part_, sim::truth_of_objects(simulation.world));
  const Surroundings around = surroundings_of(simulation);
  Eigen::Isometry3d T_map_grid = Eigen::Isometry3d::Identity();
  T_map_grid.translation().head<2>() = 0.5 * (around.low + around.high);
  const Eigen::Vector2d size = around.high - around.low;
  sim::CellTruth cells = sim::truth_of_cells(*simulation.caster, T_map_grid,
                                             GridGeometry(size.x(), size.y(), cell_size_));
  round_cells(cells);
  sim::write_cell_truth(part_, T_map_grid, cells);
}

void TruthOutput::add_sweep(const Simulation& simulation, const sim::Sweep& sweep) {
  sim::PointTruth truth = sim::truth_of(*simulation.caster, sweep);
  round_all(truth.true_range, kStepsPerMetre);
  round_all(truth.height, kStepsPerMetre);
  sim::write_point_truth(part_, sweeps_, truth);
  ++sweeps_;
}

void TruthOutput::commit() {
  fs::remove_all(folder_);
  fs::rename(part_, folder_);
}
