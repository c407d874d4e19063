// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>

#include "bench_support.h"
#include "mrpt_terrain/core/costs.h"
#include "mrpt_terrain/core/field_costs.h"
#include "mrpt_terrain/core/unseen_cells.h"

namespace mrpt_terrain::bench {
namespace {

/// Every observed cell has sane numbers, some can be driven on and some not.
bool is_sane(const ElevationGrid& grid, const CellCosts& costs, const RobotParams& robot) {
  std::size_t free = 0;
  std::size_t lethal = 0;
  for (std::size_t k = 0; k < costs.size(); ++k) {
    const Cost cost = cost_of(costs, static_cast<Slot>(k), robot);
    if (!(cost.cost >= 0.0 && cost.cost <= 1.0)) return false;
    free += cost.status == CostStatus::kOk ? 1U : 0U;
    lethal += cost.status == CostStatus::kLethal ? 1U : 0U;
  }
  return costs.size() == grid.observed() && free > 0 && lethal > 0;
}

void count_costs(const CellCosts& costs, const RobotParams& robot, benchmark::State& state) {
  double known = 0.0;
  double lethal = 0.0;
  for (std::size_t k = 0; k < costs.size(); ++k) {
    const CostStatus status = cost_of(costs, static_cast<Slot>(k), robot).status;
    known += status != CostStatus::kUnknown ? 1.0 : 0.0;
    lethal += status == CostStatus::kLethal ? 1.0 : 0.0;
  }
  state.counters["cells"] = static_cast<double>(costs.size());
  state.counters["known"] = known;
  state.counters["lethal"] = lethal;
}

// Of the benchmark scan; the argument is the size of the cells in centimetres.
void cell_costs(benchmark::State& state) {
  GridParams params = benchmark_params().grid;
  params.cell_size = 0.01 * static_cast<double>(state.range(0));
  ElevationGridWorkspace grid_workspace;
  ElevationGrid grid;
  PointSlots slots;
  build_elevation_grid(Described::points(), params, grid_workspace, grid, slots);
  const RobotParams robot;
  CostWorkspace workspace;
  CellCosts costs;
  compute_cell_costs(grid, robot, workspace, costs);
  if (!is_sane(grid, costs, robot)) state.SkipWithError("no sane costs");
  run_counted(state, [&] { compute_cell_costs(grid, robot, workspace, costs); });
  count_costs(costs, robot, state);
}
BENCHMARK(cell_costs)->Unit(benchmark::kMicrosecond)->Arg(20)->Arg(10)->Arg(5);

// Of the benchmark scan as field mode describes it.
void field_cell_costs(benchmark::State& state) {
  FieldDescribed d;
  const RobotParams robot;
  CostWorkspace workspace;
  CellCosts costs;
  const DescribedPoints points = described_points(d.scan.points, d.workspace);
  compute_cell_costs(d.description, points, robot, workspace, costs);
  if (!is_sane(d.description.grid, costs, robot)) state.SkipWithError("no sane costs");
  run_counted(state, [&] { compute_cell_costs(d.description, points, robot, workspace, costs); });
  count_costs(costs, robot, state);
}
BENCHMARK(field_cell_costs)->Unit(benchmark::kMicrosecond);

// Of the same grid, slope, step and roughness alone.
void grid_cell_costs(benchmark::State& state) {
  FieldDescribed d;
  const RobotParams robot;
  CostWorkspace workspace;
  CellCosts costs;
  run_counted(state, [&] { compute_cell_costs(d.description.grid, robot, workspace, costs); });
  count_costs(costs, robot, state);
}
BENCHMARK(grid_cell_costs)->Unit(benchmark::kMicrosecond);

// Why cells were not seen.
void unseen_cells(benchmark::State& state) {
  FieldDescribed d;
  UnseenWorkspace workspace;
  std::vector<UnseenReason> reasons;
  run_counted(
      state, [&] { explain_unseen_cells(d.scan, d.workspace, d.description, workspace, reasons); });
  std::array<double, kUnseenReasonCount> cells{};
  for (const UnseenReason reason : reasons) cells[static_cast<std::size_t>(reason)] += 1.0;
  if (cells[0] == 0.0 || cells[2] == 0.0) state.SkipWithError("nothing seen, or nothing hidden");
  for (const auto& entry : enum_names(UnseenReason{})) {
    state.counters[entry.name] = cells[static_cast<std::size_t>(entry.value)];
  }
}
BENCHMARK(unseen_cells)->Unit(benchmark::kMicrosecond);

// One query of a planner for the whole robot, in a heading.
void footprint_in_heading(benchmark::State& state) {
  FieldDescribed d;
  const RobotParams robot;
  CostWorkspace workspace;
  CellCosts costs;
  compute_cell_costs(d.description, described_points(d.scan.points, d.workspace), robot, workspace,
                     costs);
  double sum = 0.0;
  int k = 0;
  run_counted(state, [&] {
    const Position2 position{-20.0 + 0.37 * (k % 100), -20.0 + 0.41 * (k % 97)};
    sum += footprint_cost_at(d.description.grid, costs, position, robot, 0.01 * k).cost;
    k = (k + 1) % 9700;
  });
  benchmark::DoNotOptimize(sum);
}
BENCHMARK(footprint_in_heading)->Unit(benchmark::kNanosecond);

// One query of a planner, in a heading.
void cost_in_heading(benchmark::State& state) {
  Described d;
  const RobotParams robot;
  CostWorkspace workspace;
  CellCosts costs;
  compute_cell_costs(d.description.grid, robot, workspace, costs);
  if (!is_sane(d.description.grid, costs, robot)) state.SkipWithError("no sane costs");
  double sum = 0.0;
  int k = 0;
  run_counted(state, [&] {
    const Position2 position{-20.0 + 0.37 * (k % 100), -20.0 + 0.41 * (k % 97)};
    sum += cost_at(d.description.grid, costs, position, robot, 0.01 * k).cost;
    k = (k + 1) % 9700;
  });
  benchmark::DoNotOptimize(sum);
}
BENCHMARK(cost_in_heading)->Unit(benchmark::kNanosecond);

}  // namespace
}  // namespace mrpt_terrain::bench
