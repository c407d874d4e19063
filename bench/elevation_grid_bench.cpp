// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "bench_support.h"

namespace mrpt_terrain::bench {
namespace {

// The reference of all ratios; see reference_loop.h.
void reference(benchmark::State& state) {
  std::vector<ReferenceCell> grid;
  run_counted(state, [&] { reference_loop(Described::points(), grid); });
}
BENCHMARK(reference)->Unit(benchmark::kMicrosecond);

void elevation_grid(benchmark::State& state) {
  Described d;
  // The reference loop must see the same points; float and double may part on the edges of cells.
  std::vector<ReferenceCell> cells;
  reference_loop(Described::points(), cells);
  double reference_points = 0;
  for (const ReferenceCell& cell : cells) reference_points += cell.count;
  double points = 0;
  for (const MomentSums& sums : d.description.grid.sums) points += sums.n;
  if (std::abs(points - reference_points) > 5) state.SkipWithError("not the reference's points");
  run_counted(state, [&] {
    build_elevation_grid(Described::points(), d.params.grid, d.workspace.grid, d.description.grid,
                         d.workspace.point_slots);
  });
}
BENCHMARK(elevation_grid)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace mrpt_terrain::bench
