// SPDX-License-Identifier: BSD-3-Clause
#include "collect_cells.h"

#include <cassert>
#include <cmath>

namespace mrpt_terrain::octree {
namespace {

bool is_finite(const Place& place) {
  return std::isfinite(place[0]) && std::isfinite(place[1]) && std::isfinite(place[2]);
}

template <Ties kTies>
class Collector {
 public:
  Collector(const InsertionOptions& options, double resolution, CollectionWorkspace& workspace)
      : options_(options), grid_(resolution), workspace_(workspace) {}

  void set_origin(std::uint32_t number, const Place& place) {
    origin_number_ = number;
    origin_is_finite_ = is_finite(place);
    CellKey key{};
    origin_in_range_ = origin_is_finite_ && grid_.find_key(place, key);
    origin_ = {grid_, place, key};
  }
  [[nodiscard]] std::uint32_t origin_number() const { return origin_number_; }

  void add(Place end) {
    if (!origin_is_finite_ || !is_finite(end)) {
      ++result_.non_finite;
      return;
    }
    CellKey end_key{};
    bool end_in_range = grid_.find_key(end, end_key);
    if (!end_in_range) ++result_.out_of_range;
    if (options_.discretize) {
      if (!end_in_range) return;
      if (!workspace_.rays.insert(origin_number_, code_of(end_key))) return;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        end[axis] = static_cast<float>(grid_.centre(end_key[axis]));
      }
      // The rounded centre of a far, small cell may lie in its neighbour.
      end_in_range = grid_.find_key(end, end_key);
    }
    add_measured(end, end_key, end_in_range);
  }

  [[nodiscard]] InsertionResult finish() {
    walk();
    return result_;
  }

 private:
  void add_measured(const Place& end, const CellKey& end_key, bool end_in_range) {
    const bool is_short =
        options_.max_range < 0.0 || distance_between(origin_.place, end) <= options_.max_range;
    if (is_short) {
      if (!end_in_range) return;
      const CellCode code = code_of(end_key);
      if (code != last_occupied_) workspace_.cells.mark_occupied(code);
      last_occupied_ = code;
      add_ray(end, end_key, code);
      return;
    }
    const Place cut = cut_ray(origin_.place, end, options_.max_range);
    CellKey cut_key{};
    if (grid_.find_key(cut, cut_key)) add_ray(cut, cut_key, code_of(cut_key));
  }

  void add_ray(const Place& end, const CellKey& key, CellCode code) {
    ++result_.rays;
    if (!origin_in_range_ || code == origin_.code) return;
    workspace_.batch.add(origin_, end, key, code);
    if (workspace_.batch.size == RayBatch::kCapacity) walk();
  }

  void walk() {
    workspace_.batch.prepare(grid_.resolution);
    walk_rays<kTies>(workspace_.batch, workspace_.cells);
  }

  const InsertionOptions& options_;
  CellGrid grid_;
  CollectionWorkspace& workspace_;
  std::uint32_t origin_number_ = 0;
  RayOrigin origin_;
  CellCode last_occupied_ = ~CellCode{0};  // points side by side often share a cell
  bool origin_is_finite_ = false;
  bool origin_in_range_ = false;
  InsertionResult result_;
};

}  // namespace

template <Ties kTies>
InsertionResult collect_cells(const RayEnds& ends, const RayOrigins& origins,
                              const InsertionOptions& options, double resolution,
                              CollectionWorkspace& workspace) {
  workspace.cells.clear();
  workspace.batch.size = 0;
  if (options.discretize) workspace.rays.reset(ends.size);
  Collector<kTies> collector(options, resolution, workspace);
  collector.set_origin(0, origins.origins[0]);
  for (std::size_t k = 0; k < ends.size; ++k) {
    const std::uint32_t origin = origins.origin_of == nullptr ? 0 : origins.origin_of[k];
    assert(origin < origins.size);
    if (origin != collector.origin_number()) collector.set_origin(origin, origins.origins[origin]);
    collector.add({ends.x[k], ends.y[k], ends.z[k]});
  }
  return collector.finish();
}

template InsertionResult collect_cells<Ties::kAsOctomap>(const RayEnds&, const RayOrigins&,
                                                         const InsertionOptions&, double,
                                                         CollectionWorkspace&);
template InsertionResult collect_cells<Ties::kFlipped>(const RayEnds&, const RayOrigins&,
                                                       const InsertionOptions&, double,
                                                       CollectionWorkspace&);

}  // namespace mrpt_terrain::octree
