// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <string>

#include "beam_worlds.h"
#include "bench_support.h"

namespace mrpt_terrain::bench {
namespace {

constexpr double kAngle = 0.3231;

/// A described scan and what the estimate of its ramp needs.
struct RampScan {
  Points points;
  DescriptionWorkspace workspace;
  Description description;
  std::size_t cluster = 0;

  /// \param beams of the sensor; the more, the more points the ramp has
  explicit RampScan(int beams) {
    RandomGenerator random(7);
    worlds::LidarModel model = worlds::thirty_two_beams(0.02);
    model.beams = beams;
    points = worlds::scan(worlds::ramp_scene(kAngle), model, random).points;
    describe(view(), worlds::beam_params(), workspace, description);
    for (std::size_t k = 0; k < description.things.size(); ++k) {
      if (description.things[k].points > description.things[cluster].points) cluster = k;
    }
  }
  [[nodiscard]] ScanView view() const { return {points.view(), {&worlds::kLidarOrigin, nullptr}}; }
};

// The whole estimate of one cluster, ground plane around it included. The argument is the number of
// beams: 28 give a cluster of 2,400 points, 56 one of 5,000.
void beam_slope_of_cluster(benchmark::State& state) {
  RampScan scan(static_cast<int>(state.range(0)));
  const ScanView view = scan.view();
  const BeamSlopeInput input{view.points,
                             view.origins,
                             scan.description.grid,
                             scan.description.ground,
                             scan.description.clusters,
                             scan.workspace.points_of,
                             scan.description.grid.sums};
  BeamSlopeWorkspace workspace;
  Slope slope;
  run_counted(state, [&] { slope = estimate_beam_slope(input, scan.cluster, {}, 1, workspace); });
  if (slope.status != FeatureStatus::kOk || std::abs(slope.angle - kAngle) > 0.003) {
    state.SkipWithError("wrong slope");
  }
  state.counters["angle_deg"] = slope.angle * 57.29577951308232;
  state.counters["points"] = slope.points;
}
BENCHMARK(beam_slope_of_cluster)->Arg(28)->Arg(56)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace mrpt_terrain::bench
