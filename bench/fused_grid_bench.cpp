// SPDX-License-Identifier: BSD-3-Clause
// A drive with the fused grid: every scan is fused into the rolling window, published, and the
// window around the robot is described.
#include <cmath>
#include <vector>

#include "bench_support.h"
#include "mrpt_terrain/core/apply_free_space.h"
#include "mrpt_terrain/core/describe_fused.h"
#include "mrpt_terrain/core/fused_cell.h"

namespace mrpt_terrain::bench {
namespace {

constexpr double kStep = 1.0;  // metres from scan to scan

/// The benchmark scan again and again along a straight way: every scan brings as many new cells.
struct Drive {
  FusionParams fusion;
  DescriptionParams params = benchmark_params();
  FusedGrid grid;
  FusionWorkspace workspace;
  FusedDescriptionWorkspace describing;
  FusedDescription description;
  FusedSnapshot published;
  int scans = 0;

  explicit Drive(FusionExtent extent) : grid(with(extent)) {
    params.grid.length = params.grid.width = 60.0;
  }
  FusionParams& with(FusionExtent extent) {
    fusion.extent = extent;
    return fusion;
  }
  [[nodiscard]] PosedScan scan() const {
    PosedScan now;
    now.points = Described::points();
    now.T_map_robot.translation().x() = kStep * scans;
    now.time = 0.1 * scans;
    return now;
  }
  void fuse() {
    ++scans;
    fuse_scan(scan(), fusion, workspace, grid);
  }
  void publish() { published = grid.snapshot(); }
  void describe() {
    describe_fused(grid.now(), {scan(), {}, 0}, {params, fusion}, describing, description);
  }
  void go(int n) {
    for (int k = 0; k < n; ++k) fuse();
  }
};

bool is_good(const Drive& drive) {
  FusedCell cell;
  MapCell where;
  return drive.grid.now().lattice.cell_at(kStep * drive.scans + 6.0, 0.1, where) &&
         read_cell(drive.grid.now(), where, drive.fusion, cell) && std::abs(cell.height) < 0.5;
}

// After so many metres of driving; the cost must not grow with them.
void fused_scan(benchmark::State& state, FusionExtent extent, bool publishes) {
  Drive drive(extent);
  drive.go(static_cast<int>(state.range(0)));
  if (!is_good(drive)) state.SkipWithError("the ground ahead is not in the map");
  run_counted(state, [&] {
    drive.fuse();
    if (publishes) drive.publish();
  });
  const FusedMemory memory = memory_of(drive.grid);
  const double area =
      static_cast<double>(memory.cells) * drive.fusion.cell_size * drive.fusion.cell_size;
  state.counters["MB"] = static_cast<double>(memory.tiles + memory.spare) * 1e-6;
  state.counters["bytes_per_m2"] = static_cast<double>(memory.tiles) / area;
}
BENCHMARK_CAPTURE(fused_scan, rolling, FusionExtent::kRolling, false)
    ->Arg(150)
    ->Arg(2000)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(fused_scan, rolling_published, FusionExtent::kRolling, true)
    ->Arg(150)
    ->Arg(2000)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(fused_scan, growing_published, FusionExtent::kGrowing, true)
    ->Arg(150)
    ->Arg(1000)
    ->Unit(benchmark::kMicrosecond);

void fused_description(benchmark::State& state) {
  Drive drive(FusionExtent::kRolling);
  drive.go(150);
  drive.describe();
  if (drive.description.description.grid.observed() < 10000) {
    state.SkipWithError("too little of the window is known");
  }
  run_counted(state, [&] { drive.describe(); });
  state.counters["cells"] = static_cast<double>(drive.description.description.grid.observed());
}
BENCHMARK(fused_description)->Unit(benchmark::kMicrosecond);

void fused_window(benchmark::State& state) {
  Drive drive(FusionExtent::kRolling);
  drive.go(150);
  const WindowFrame frame = window_around(drive.grid.now().lattice, drive.params.grid,
                                          drive.scan().T_map_robot.translation());
  ElevationGrid grid;
  WindowCells cells;
  run_counted(state, [&] { read_window(drive.grid.now(), frame, drive.fusion, grid, cells); });
  state.counters["cells"] = static_cast<double>(grid.observed());
}
BENCHMARK(fused_window)->Unit(benchmark::kMicrosecond);

// Free space over all that is known, from 0.2 m above the ground up.
void free_space(benchmark::State& state) {
  Drive drive(FusionExtent::kRolling);
  drive.go(150);
  FreeSpaceGrid free;
  free.lattice = drive.grid.now().lattice;
  const MapCellRect window = drive.grid.now().window;
  for (std::int32_t i = window.low.i; i < window.high.i; ++i) {
    for (std::int32_t j = window.low.j; j < window.high.j; ++j) {
      free.begin_cell({i, j});
      free.add_span({1, 10});
    }
  }
  FreeSpaceCounts counts;
  run_counted(state, [&] {
    drive.fuse();
    free.time = 0.1 * drive.scans;
    counts = apply_free_space(free, drive.fusion, drive.grid);
  });
  if (counts.bins_guarded + counts.bins_removed == 0) state.SkipWithError("nothing was judged");
  state.counters["removed"] = static_cast<double>(counts.bins_removed);
}
BENCHMARK(free_space)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace mrpt_terrain::bench
