// SPDX-License-Identifier: BSD-3-Clause
// The whole insertion of a scan into a CTerrainMap: description, OctoMap, snapshot.
#include <benchmark/benchmark.h>

#include <cmath>

#include "mrpt_terrain/map/terrain_map.h"
#include "scan_files.h"

namespace {

using namespace mrpt_terrain;

/// Whether somebody asks every snapshot for a cost: who does so first takes the time for all of
/// them.
enum class Costs { kNotAsked, kAsked };

/// A 64-beam scan of a vehicle that drives on between insertions.
void insertion(benchmark::State& state, Fusion fusion, bool octree,
               DescriptionMode mode = DescriptionMode::kPaper, Costs costs = Costs::kNotAsked) {
  MapParams params;
  params.creation.fusion = fusion;
  params.creation.octree = octree;
  params.description.grid.length = params.description.grid.width = 60.0;
  params.description.grid.cell_size = 0.2;
  params.description.grid.max_height = 3.0;
  params.description.description.mode = mode;
  if (mode == DescriptionMode::kField) params.description.slope.method = SlopeMethod::kBeam;
  CTerrainMap map(params);
  io::Scan scan;
  scan.points = bench::benchmark_scan().points;
  scan.ray_origins.push_back({0.0F, 0.0F, 1.73F});
  double driven = 0.0;
  const auto insert = [&] {
    scan.stamp += 0.1;
    driven += 1.0;
    map.insert_scan(scan, mrpt::poses::CPose3D(driven, 0, 0, 0, 0, 0));
    if (costs == Costs::kAsked) benchmark::DoNotOptimize(map.cost_at(driven + 5.0, 0.0, 0.0));
  };
  for (int k = 0; k < 10; ++k) insert();
  if (map.snapshot()->clusters.empty()) state.SkipWithError("nothing was described");
  for (auto _ : state) insert();
  state.counters["cells"] = static_cast<double>(map.snapshot()->description.grid.observed());
}

BENCHMARK_CAPTURE(insertion, scan, Fusion::kScan, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(insertion, scan_without_octree, Fusion::kScan, false)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(insertion, rolling, Fusion::kRolling, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(insertion, scan_and_cost, Fusion::kScan, true, DescriptionMode::kPaper,
                  Costs::kAsked)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(insertion, rolling_and_cost, Fusion::kRolling, true, DescriptionMode::kPaper,
                  Costs::kAsked)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(insertion, rolling_without_octree, Fusion::kRolling, false)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(insertion, scan_field, Fusion::kScan, true, DescriptionMode::kField)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(insertion, rolling_field, Fusion::kRolling, true, DescriptionMode::kField)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(insertion, rolling_field_and_cost, Fusion::kRolling, true,
                  DescriptionMode::kField, Costs::kAsked)
    ->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
