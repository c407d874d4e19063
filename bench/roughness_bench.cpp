// SPDX-License-Identifier: BSD-3-Clause
#include "bench_support.h"

namespace mrpt_terrain::bench {
namespace {

// Of all clusters of the scan, from their pooled moments.
void roughness_of_all(benchmark::State& state) {
  Described d;
  std::size_t flat = 0;
  run_counted(state, [&] {
    flat = 0;
    for (const Moments& moments : d.workspace.cluster_moments) {
      flat += roughness(moments, d.params.roughness).rough ? 0U : 1U;
    }
  });
  if (d.workspace.cluster_moments.empty()) state.SkipWithError("no clusters");
  state.counters["clusters"] = static_cast<double>(d.workspace.cluster_moments.size());
  state.counters["flat"] = static_cast<double>(flat);
}
BENCHMARK(roughness_of_all)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace mrpt_terrain::bench
