// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <benchmark/benchmark.h>

#include <array>

#include "allocation_counter.h"
#include "mrpt_terrain/core/describe.h"
#include "reference_loop.h"
#include "scan_files.h"

namespace mrpt_terrain::bench {

/// The map of all benchmarks: that of the reference loop, 100 m x 100 m of 0.2 m cells.
inline DescriptionParams benchmark_params() {
  DescriptionParams params;
  params.grid.length = params.grid.width = 100.0;
  params.grid.cell_size = 0.2;
  return params;
}

/// The benchmark scan described once: the inputs of every single stage.
struct Described {
  DescriptionParams params = benchmark_params();
  DescriptionWorkspace workspace;
  Description description;
  Described() { describe(points(), params, workspace, description); }
  [[nodiscard]] static PointsView points() { return benchmark_scan().points.view(); }
};

/// The benchmark scan in field mode, with the sensor of the data set over the robot's origin.
struct FieldDescribed {
  DescriptionParams params = benchmark_params();
  DescriptionWorkspace workspace;
  Description description;
  std::array<float, 3> origin{0.0F, 0.0F, 1.73F};
  ScanView scan{Described::points(), {&origin, nullptr}};
  FieldDescribed() {
    params.description.mode = DescriptionMode::kField;
    params.grid.max_height = 3.0;
    params.slope.method = SlopeMethod::kBeam;
    describe(scan, params, workspace, description);
  }
};

/// Runs `work` as the benchmark's loop after two rounds that may still allocate, and counts the
/// allocations of the loop.
template <class Work>
void run_counted(benchmark::State& state, Work&& work) {
  work();
  work();
  const std::size_t before = allocations();
  for (auto _ : state) {
    work();
    benchmark::ClobberMemory();
  }
  state.counters["allocations"] = static_cast<double>(allocations() - before);
}

}  // namespace mrpt_terrain::bench
