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
    take_over();
    origin_number_ = number;
    origin_is_finite_ = is_finite(place);
    CellKey key{};
    origin_in_range_ = origin_is_finite_ && grid_.find_key(place, key);
    origin_ = {grid_, place, key};
  }
  [[nodiscard]] std::uint32_t origin_number() const { return origin_number_; }

  void add(Place end) {
    if (!origin_is_finite_) {
      ++result_.non_finite;
      return;
    }
    if (options_.discretize && !go_to_new_centre(end)) return;
    workspace_.ends.add(end);
    if (workspace_.ends.size == EndBatch::kCapacity) take_over();
  }

  [[nodiscard]] InsertionResult finish() {
    take_over();
    walk();
    return result_;
  }

 private:
  // Replaces the end of a ray by the centre of its cell; false if another ray ends there already.
  [[nodiscard]] bool go_to_new_centre(Place& end) {
    if (!is_finite(end)) {
      ++result_.non_finite;
      return false;
    }
    CellKey key{};
    if (!grid_.find_key(end, key)) {
      ++result_.out_of_range;
      return false;
    }
    if (!workspace_.rays.insert(origin_number_, code_of(key))) return false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      end[axis] = static_cast<float>(grid_.centre(key[axis]));
    }
    return true;
  }

  // Makes rays of the ends so far.
  void take_over() {
    EndBatch& ends = workspace_.ends;
    ends.measure(origin_, grid_, options_.max_range);
    for (std::size_t k = 0; k < ends.size; ++k) {
      const std::uint32_t flags = ends.flags[k];
      if ((flags & kFiniteEnd) == 0) {
        ++result_.non_finite;
        continue;
      }
      // The rounded centre of a far, small cell may lie beyond: that is not counted.
      if ((flags & kEndInRange) == 0 && !options_.discretize) ++result_.out_of_range;
      if ((flags & kInRange) != 0) add_ray(ends, k);
    }
    ends.size = 0;
  }

  void add_ray(const EndBatch& ends, std::size_t k) {
    const CellCode code = ends.code[k];
    if ((ends.flags[k] & kShort) != 0) {
      if (code != last_occupied_) workspace_.cells.mark_occupied(code);
      last_occupied_ = code;
    }
    ++result_.rays;
    if (!origin_in_range_ || code == origin_.code) return;
    workspace_.batch.add(origin_, ends.end(k), ends.cells[k], code);
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
  workspace.ends.size = 0;
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
