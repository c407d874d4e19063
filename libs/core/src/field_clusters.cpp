// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/field_clusters.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "carried_things.h"
#include "continued_things.h"
#include "crossing_strips.h"
#include "gentle_rises.h"
#include "length_of.h"
#include "loose_things.h"
#include "slots_around.h"
#include "standing_things.h"
#include "thing_pieces.h"
#include "wall_columns.h"

namespace mrpt_terrain {
namespace {

// Widest gap, cells, however far away.
constexpr int kMostReach = 3;

/// What decides whether two cells are of one thing.
struct Linker {
  const ElevationGrid& grid;
  const GroundSegmentation& ground;
  const FieldCells& cells;
  float step;
  float flat;
  float level;
  const PassedBeams* beams;  ///< null: unknown

  [[nodiscard]] bool is_member(std::size_t slot) const {
    return !ground.is_ground(slot) || cells.raised[slot] > 0;
  }
  [[nodiscard]] float low(std::size_t slot) const { return low_of(cells, slot); }
  [[nodiscard]] float high(std::size_t slot) const { return high_of(cells, slot); }
  [[nodiscard]] bool is_hole(std::size_t slot) const {
    return ground.rule[slot] == GroundRule::kLow;
  }
  // A deck and its side, which does not rise above it, are one thing; what stands on the deck or
  // beside it is another.
  [[nodiscard]] bool same_kind(std::size_t a, std::size_t b) const {
    if ((cells.deck[a] >= 0) == (cells.deck[b] >= 0)) return true;
    const std::size_t deck = cells.deck[a] >= 0 ? a : b, other = cells.deck[a] >= 0 ? b : a;
    return cells.above[other] == 0 || high(other) <= high(deck) + level;
  }
  // Upright surfaces have no gaps; what lies flat is seen by a ring here and one there.
  [[nodiscard]] bool may_have_gaps(std::size_t slot) const {
    return is_hole(slot) || high(slot) - low(slot) <= flat;
  }
  [[nodiscard]] bool compatible(std::size_t a, std::size_t b) const {
    if (is_hole(a) || is_hole(b)) return is_hole(a) && is_hole(b);
    if (!same_kind(a, b)) return false;
    return std::max(low(a), low(b)) - std::min(high(a), high(b)) <= step;
  }
  // Whether two near cells are of two things all the same.
  [[nodiscard]] bool divided(std::size_t a, std::size_t b) const {
    return beams != nullptr && beams->divide(a, b);
  }
};

int reach_of(const ElevationGrid& grid, const FieldClusterParams& params, CellIndex index) {
  const Position2 centre = grid.geometry.centre_of(index);
  const double gap = params.link + params.link_growth * length_of(centre.x, centre.y);
  const int reach = 1 + static_cast<int>(gap / grid.geometry.cell_size());
  return std::min(reach, kMostReach);
}

// Unites a cell with those marked so far, which are before it in the order of the slots, that are
// near enough, and marks it.
void link_back(const Linker& linker, std::size_t slot, const FieldClusterParams& params,
               FieldClusterWorkspace& workspace) {
  std::vector<std::int32_t>& parent = workspace.parent;
  const ElevationGrid& grid = linker.grid;
  const CellIndex at = grid.geometry.index_of(grid.cell[slot]);
  auto root = static_cast<std::int32_t>(slot);
  const auto link = [&](CellIndex near) {
    const Slot other = grid.slot_within(near);
    const auto beside = static_cast<std::size_t>(other);
    if (parent[beside] == root) return;
    const std::int32_t other_root = root_of(parent, other);
    if (other_root == root) return;
    if (!linker.compatible(slot, beside) || linker.divided(slot, beside)) return;
    root = unite_roots(parent, root, other_root);
  };
  workspace.members.for_marked_before(at, 1, link);
  workspace.members.mark(at);
  if (!linker.may_have_gaps(slot)) return;
  // Most of what is farther away is of one thing with what touches: then nothing more is asked.
  workspace.flat.for_marked_before(at, reach_of(grid, params, at), [&](CellIndex near) {
    if (at.l - near.l > 1 || std::abs(at.w - near.w) > 1) link(near);
  });
  workspace.flat.mark(at);
}

/// Links cells of raised ground with nothing but unseen cells between them: a curb or a ramp that
/// two rings meet far apart.
class UnseenLinker {
 public:
  UnseenLinker(const Linker& linker, const FieldClusterParams& params)
      : linker_(linker),
        level_(static_cast<float>(params.level)),
        reach_(static_cast<int>(params.unseen / linker.grid.geometry.cell_size())) {}

  // As the function above.
  void link_back(std::size_t slot, CellBits& raised, std::vector<std::int32_t>& parent) const {
    if (!is_raised_only(slot)) return;
    const ElevationGrid& grid = linker_.grid;
    const CellIndex at = grid.geometry.index_of(grid.cell[slot]);
    raised.for_marked_before(at, reach_, [&](CellIndex near) {
      const Slot other = grid.slot_within(near);
      if (as_high(slot, static_cast<std::size_t>(other)) && is_unseen(at, near))
        unite(parent, static_cast<std::int32_t>(slot), other);
    });
    raised.mark(at);
  }

 private:
  [[nodiscard]] bool is_raised_only(std::size_t slot) const {
    return linker_.ground.is_ground(slot) && linker_.cells.raised[slot] > 0;
  }
  [[nodiscard]] bool as_high(std::size_t a, std::size_t b) const {
    const float sum_a = linker_.low(a) + linker_.high(a), sum_b = linker_.low(b) + linker_.high(b);
    return 0.5F * std::abs(sum_a - sum_b) <= level_;
  }
  // Whether no cell between the two was observed but for cells of things.
  [[nodiscard]] bool is_unseen(CellIndex a, CellIndex b) const {
    return !any_slot_between(linker_.grid, a, b,
                             [this](std::size_t slot) { return !linker_.is_member(slot); });
  }

  const Linker& linker_;
  float level_;
  int reach_;
};

void count_members(const Linker& linker, FieldClusterWorkspace& workspace) {
  const GroundSegmentation& ground = linker.ground;
  const FieldCells& cells = linker.cells;
  const std::size_t n = cells.size();
  workspace.cells_of.assign(n, 0);
  workspace.stands.assign(n, 0);
  for (auto* counts :
       {&workspace.points_of, &workspace.sharp_of, &workspace.smooth_of, &workspace.above_of})
    counts->assign(n, 0);
  for (std::size_t slot = 0; slot < n; ++slot) {
    if (!linker.is_member(slot)) continue;
    workspace.parent[slot] = root_of(workspace.parent, static_cast<std::int32_t>(slot));
    const auto root = static_cast<std::size_t>(workspace.parent[slot]);
    ++workspace.cells_of[root];
    if (cells.level[slot] == 0) workspace.stands[root] = 1;
    workspace.sharp_of[root] += cells.sharp_edges[slot];
    workspace.smooth_of[root] += cells.smooth_edges[slot];
    // The floor of a hole is ground, but never a swell.
    const bool hole = ground.rule[slot] == GroundRule::kLow;
    const std::int32_t own = hole ? cells.on[slot] + cells.below[slot] : cells.above[slot];
    workspace.above_of[root] += own;
    workspace.points_of[root] += own + (hole ? 0 : cells.raised[slot]);
  }
}

void number_things(const FieldClusterParams& params, FieldClusterWorkspace& workspace,
                   Clusters& result) {
  workspace.number_of.assign(workspace.cells_of.size(), kNoCluster);
  result.slots.first.assign(1, 0);
  result.dropped = 0;
  for (std::size_t root = 0; root < workspace.cells_of.size(); ++root) {
    const std::int32_t cells = workspace.cells_of[root];
    if (cells == 0) continue;
    const std::int32_t edges = workspace.sharp_of[root] + workspace.smooth_of[root];
    const bool swell = is_swell(workspace.above_of[root], workspace.points_of[root],
                                workspace.sharp_of[root], edges, params);
    const bool level = workspace.stands[root] == 0;
    const bool gentle = workspace.gentle[root] != 0;
    if (level || swell || gentle ||
        (cells < params.t_c && workspace.points_of[root] < params.t_points)) {
      ++result.dropped;
      continue;
    }
    workspace.number_of[root] = static_cast<std::int32_t>(result.slots.rows());
    result.slots.first.push_back(result.slots.first.back() + cells);
  }
  result.slots.items.resize(static_cast<std::size_t>(result.slots.first.back()));
}

}  // namespace

void find_field_clusters(const ElevationGrid& grid, const GroundSegmentation& ground,
                         const FieldCells& cells, const FieldClusterParams& params,
                         FieldClusterWorkspace& workspace, Clusters& result,
                         const std::array<float, 3>* sensor) {
  const std::optional<PassedBeams> beams =
      sensor == nullptr ? std::nullopt : std::optional<PassedBeams>({grid, cells, *sensor});
  const Linker linker{grid,
                      ground,
                      cells,
                      static_cast<float>(params.step),
                      static_cast<float>(params.flat),
                      static_cast<float>(params.level),
                      beams ? &*beams : nullptr};
  const std::size_t n = grid.observed();
  workspace.parent.resize(n);
  for (auto* bits : {&workspace.members, &workspace.flat, &workspace.raised})
    bits->clear(grid.geometry);
  for (std::size_t slot = 0; slot < n; ++slot) {
    workspace.parent[slot] = static_cast<std::int32_t>(slot);
    if (linker.is_member(slot)) link_back(linker, slot, params, workspace);
  }
  const UnseenLinker unseen(linker, params);
  for (std::size_t slot = 0; slot < n; ++slot)
    unseen.link_back(slot, workspace.raised, workspace.parent);
  const ThingPieces pieces{grid, ground, cells, params, workspace};
  pieces.find_members();
  pieces.measure();
  pieces.list_cells();
  const bool standing = divide_standing_things(pieces);
  const bool crossing = divide_crossing_strips(pieces);
  if (standing || crossing) pieces.measure();
  if (beams && link_wall_columns(pieces, *beams)) pieces.measure();
  link_carried_things(pieces);
  link_loose_things(pieces);
  if (beams) link_continued_things(pieces, *beams);
  pieces.measure();
  link_abutments(pieces, linker.beams);
  find_gentle_rises(pieces);
  count_members(linker, workspace);
  number_things(params, workspace, result);
  result.cluster_of.assign(n, kNoCluster);
  workspace.points_of.assign(result.slots.first.begin(), result.slots.first.end());
  for (std::size_t slot = 0; slot < n; ++slot) {
    if (!linker.is_member(slot)) continue;
    const std::int32_t cluster =
        workspace.number_of[static_cast<std::size_t>(workspace.parent[slot])];
    if (cluster == kNoCluster) continue;
    result.cluster_of[slot] = cluster;
    std::int32_t& next = workspace.points_of[static_cast<std::size_t>(cluster)];
    result.slots.items[static_cast<std::size_t>(next++)] = static_cast<std::int32_t>(slot);
  }
}

}  // namespace mrpt_terrain
