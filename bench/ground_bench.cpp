// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "bench_support.h"

namespace mrpt_terrain::bench {
namespace {

void ground(benchmark::State& state) {
  Described d;
  const auto& rule = d.description.ground.rule;
  if (std::count(rule.begin(), rule.end(), GroundRule::kGround) == 0) {
    state.SkipWithError("no ground");
  }
  run_counted(state, [&] {
    segment_ground(d.description.grid, d.params.ground, d.workspace.ground, d.description.ground);
  });
}
BENCHMARK(ground)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace mrpt_terrain::bench
