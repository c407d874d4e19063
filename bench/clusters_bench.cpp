// SPDX-License-Identifier: BSD-3-Clause
#include "bench_support.h"

namespace mrpt_terrain::bench {
namespace {

void clusters(benchmark::State& state) {
  Described d;
  if (d.description.clusters.size() == 0) state.SkipWithError("no clusters");
  run_counted(state, [&] {
    find_clusters(d.description.grid, d.description.ground, d.params.clusters, d.workspace.clusters,
                  d.description.clusters);
  });
}
BENCHMARK(clusters)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace mrpt_terrain::bench
