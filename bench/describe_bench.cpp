// SPDX-License-Identifier: BSD-3-Clause
// The whole description of one scan, all stages and labels, with the time of each stage.
#include <array>
#include <chrono>
#include <string>

#include "bench_support.h"

namespace mrpt_terrain::bench {
namespace {

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
  Described d;
  std::size_t labelled = 0;
  for (const Support support : d.description.labels.support) {
    labelled += support != Support::kUnknown ? 1U : 0U;
  }
  if (labelled == 0 || labelled != d.description.projection.in_map) {
    state.SkipWithError("not every point in the map has a label");
  }
  run_counted(state, [&] { describe(Described::points(), d.params, d.workspace, d.description); });
  state.counters["points"] = static_cast<double>(Described::points().size);
  state.counters["clusters"] = static_cast<double>(d.description.things.size());
}
BENCHMARK(description)->Unit(benchmark::kMicrosecond);

// The same with a clock between the stages; `slope_us` is the share of RANSAC.
void description_by_stage(benchmark::State& state) {
  Described d;
  StageTimes times;
  for (auto _ : state) {
    times.start();
    describe(Described::points(), d.params, d.workspace, d.description, &times);
  }
  for (std::size_t k = 0; k < kStageCount; ++k) {
    state.counters[std::string(name_of(static_cast<Stage>(k))) + "_us"] =
        benchmark::Counter(times.seconds(k) * 1e6, benchmark::Counter::kAvgIterations);
  }
}
BENCHMARK(description_by_stage)->Unit(benchmark::kMicrosecond);

// Field mode: the ground reference and the labels of the points, as label_by_height gives them.
void field_ground_and_labels(benchmark::State& state) {
  FieldDescribed d;
  FieldWorkspace field;
  run_counted(state, [&] {
    find_field_ground(Described::points(), d.params.ground_surface, d.params.ground_labels, field);
  });
  std::size_t ground = 0;
  for (const Support support : field.points.support)
    ground += support == Support::kGround ? 1U : 0U;
  if (2 * ground < Described::points().size) state.SkipWithError("less than half is ground");
  state.counters["points"] = static_cast<double>(Described::points().size);
}
BENCHMARK(field_ground_and_labels)->Unit(benchmark::kMicrosecond);

// All stages and labels.
void field_description(benchmark::State& state) {
  FieldDescribed d;
  run_counted(state, [&] { describe(d.scan, d.params, d.workspace, d.description); });
  if (d.description.things.empty()) state.SkipWithError("no thing was found");
  state.counters["clusters"] = static_cast<double>(d.description.things.size());
}
BENCHMARK(field_description)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace mrpt_terrain::bench

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::AddCustomContext("scan", mrpt_terrain::bench::benchmark_scan().source);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
