// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <numeric>

#include "bench_support.h"
#include "mrpt_terrain/core/random.h"

namespace mrpt_terrain::bench {
namespace {

// A ramp of 13.86 deg with 1 cm of noise and a tenth of outliers.
Points ramp(std::size_t n) {
  RandomGenerator random(7);
  Points points;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = 1.25 + 1.2 * random.uniform();
    const double y = random.uniform() - 0.5;
    const double noise = 0.01 * (random.uniform() + random.uniform() + random.uniform() - 1.5);
    const double z = i % 10 == 0 ? random.uniform() : std::tan(0.2419) * (x - 1.25) + noise;
    points.push_back(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
  }
  return points;
}

// RANSAC that must use all of its 1000 hypotheses, and least squares, on one cluster.
void slope_of_cluster(benchmark::State& state) {
  const Points points = ramp(static_cast<std::size_t>(state.range(0)));
  std::vector<std::int32_t> members(points.size());
  std::iota(members.begin(), members.end(), 0);
  const IndexRange all{members.data(), members.data() + members.size()};
  SlopeWorkspace workspace;
  Slope slope;
  run_counted(state, [&] { slope = estimate_slope(points.view(), all, {}, 0, workspace); });
  if (std::abs(slope.angle - 0.2419) > 0.01) state.SkipWithError("wrong slope");
  state.counters["angle_deg"] = slope.angle * 57.29577951308232;
  state.counters["hypotheses"] = slope.iterations;
}
BENCHMARK(slope_of_cluster)->Arg(500)->Arg(5000)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace mrpt_terrain::bench
