// SPDX-License-Identifier: BSD-3-Clause
// Cost of describing a KITTI scan (about 124k points, 0.2 m cells, 100 m x 100 m), whole and per
// stage, beside the reference loop on the same points.
#include <benchmark/benchmark.h>

#include <array>
#include <chrono>
#include <cstdio>

#include "allocation_counter.h"
#include "mrpt_terrain/core/describe.h"
#include "reference_loop.h"
#include "scan_files.h"

namespace mrpt_terrain::bench {
namespace {

const Points& scan() {
  static const Points points = kitti_scan(0).value_or(Points{});
  return points;
}

DescriptionParams wide_map() {
  DescriptionParams params;
  params.grid.length = params.grid.width = kReferenceCells * double{kReferenceCellSize};
  params.grid.cell_size = double{0.2};
  return params;
}

/// Sums of the reference and of the description agree: neither of the two skips points.
bool counts_agree() {
  std::vector<ReferenceCell> grid;
  reference_loop(scan().view(), grid);
  std::size_t reference = 0;
  for (const ReferenceCell& cell : grid) reference += static_cast<std::size_t>(cell.count);
  DescriptionWorkspace workspace;
  Description description;
  describe(scan().view(), wide_map(), workspace, description);
  std::size_t labelled = 0;
  for (const Support support : description.labels.support) {
    labelled += support != Support::kUnknown ? 1U : 0U;
  }
  // A few points on the very edge of a cell may fall to either side in float and double.
  const std::size_t in_map = description.projection.in_map;
  return labelled == in_map && in_map + 5 > reference && reference + 5 > in_map;
}

void reference(benchmark::State& state) {
  std::vector<ReferenceCell> grid;
  reference_loop(scan().view(), grid);
  for (auto _ : state) {
    reference_loop(scan().view(), grid);
    benchmark::DoNotOptimize(grid.data());
  }
  state.counters["points"] = static_cast<double>(scan().size());
}

class StageTimes : public StageListener {
 public:
  using Clock = std::chrono::steady_clock;
  void start() { last_ = Clock::now(); }
  void stage_done(Stage stage) override {
    const Clock::time_point now = Clock::now();
    seconds_[static_cast<std::size_t>(stage)] += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }
  [[nodiscard]] double seconds(std::size_t stage) const { return seconds_[stage]; }

 private:
  std::array<double, kStageCount> seconds_{};
  Clock::time_point last_;
};

void description(benchmark::State& state) {
  const DescriptionParams params = wide_map();
  DescriptionWorkspace workspace;
  Description description;
  describe(scan().view(), params, workspace, description);
  describe(scan().view(), params, workspace, description);
  StageTimes times;
  const std::size_t allocated = allocations();
  for (auto _ : state) {
    times.start();
    describe(scan().view(), params, workspace, description, &times);
    benchmark::DoNotOptimize(description.labels.support.data());
  }
  state.counters["allocations"] = static_cast<double>(allocations() - allocated);
  for (std::size_t k = 0; k < kStageCount; ++k) {
    state.counters[std::string(name_of(static_cast<Stage>(k))) + "_us"] =
        benchmark::Counter(times.seconds(k) * 1e6, benchmark::Counter::kAvgIterations);
  }
  state.counters["clusters"] = static_cast<double>(description.things.size());
  std::size_t slopes = 0;
  for (const auto& thing : description.things) {
    slopes += thing.slope.status != FeatureStatus::kNotNeeded ? 1U : 0U;
  }
  state.counters["fitted"] = static_cast<double>(slopes);
}

BENCHMARK(reference)->Unit(benchmark::kMicrosecond);
BENCHMARK(description)->Unit(benchmark::kMicrosecond);

}  // namespace

bool ready() {
  if (scan().size() == 0) {
    std::printf("SKIPPED: no KITTI scan in %s\n", data_folder().c_str());
    return false;
  }
  if (!counts_agree()) {
    std::printf("FAILED: the reference loop and the description see different points\n");
    return false;
  }
  return true;
}

}  // namespace mrpt_terrain::bench

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  if (!mrpt_terrain::bench::ready()) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
