// SPDX-License-Identifier: BSD-3-Clause
#include "bench_support.h"

namespace mrpt_terrain::bench {
namespace {

void labels(benchmark::State& state) {
  Described d;
  if (d.description.labels.support.size() != Described::points().size) {
    state.SkipWithError("not a label per point");
  }
  run_counted(state, [&] {
    label_cells(d.description.ground, d.description.clusters, d.workspace.class_of,
                d.description.cells);
    label_points(Described::points(), d.workspace.point_slots, d.description.cells,
                 d.description.clusters, d.params.ground, d.workspace.labels, d.description.labels);
  });
}
BENCHMARK(labels)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace mrpt_terrain::bench
