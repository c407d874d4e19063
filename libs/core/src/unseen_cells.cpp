// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/unseen_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace mrpt_terrain {
namespace {

constexpr int kSectors = 720;
// Sectors to each side that tell how far down the beams of a sector reach: ten degrees.
constexpr int kViewReach = 20;
// Things that begin higher above the ground hang, metres.
constexpr float kHanging = 0.5F;
// Cells are in the shadow of what stands at least so much nearer, metres: not of their own points.
constexpr float kBehind = 0.3F;
constexpr float kNothing = std::numeric_limits<float>::max();

// Angle of (dx, dy) from the x axis, radians within [-pi, pi], to less than a hundredth of a
// sector. The polynomial is a least-squares fit of atan over [0, 1], weighted until its errors were
// even.
float angle_of(float dx, float dy) {
  const float ax = std::abs(dx), ay = std::abs(dy);
  const float longer = std::max(ax, ay);
  if (!(longer > 0.0F)) return 0.0F;
  const float t = std::min(ax, ay) / longer;
  const float q = t * t;
  const float part =
      (((0.0208660F * q - 0.0851982F) * q + 0.1801866F) * q - 0.3303112F) * q + 0.9998667F;
  constexpr auto kPi = static_cast<float>(M_PI);
  float angle = part * t;
  if (ay > ax) angle = 0.5F * kPi - angle;
  if (dx < 0.0F) angle = kPi - angle;
  return dy < 0.0F ? -angle : angle;
}

SectorPlace look_at(const std::array<float, 3>& origin, float x, float y) {
  constexpr auto kSectorsPerRadian = static_cast<float>(kSectors / (2.0 * M_PI));
  const float dx = x - origin[0], dy = y - origin[1];
  const float turned = angle_of(dx, dy) + static_cast<float>(M_PI);
  const int sector = std::clamp(static_cast<int>(turned * kSectorsPerRadian), 0, kSectors - 1);
  return {sector, std::sqrt(dx * dx + dy * dy)};
}

float tangent(const std::array<float, 3>& origin, float z, float range) {
  return (z - origin[2]) / std::max(range, 1e-3F);
}

void look_at_points(const PointsView& points, const std::array<float, 3>& origin,
                    std::vector<SectorPlace>& places) {
  places.resize(points.size);
  for (std::size_t i = 0; i < points.size; ++i) {
    const bool finite =
        std::isfinite(points.x[i]) && std::isfinite(points.y[i]) && std::isfinite(points.z[i]);
    places[i] = finite ? look_at(origin, points.x[i], points.y[i]) : SectorPlace{};
  }
}

// Cells lie where they lay before as long as grid and sensor stay the same.
void look_at_cells(const GridGeometry& geometry, const std::array<float, 3>& origin,
                   UnseenWorkspace& workspace) {
  const bool same = workspace.geometry == geometry && workspace.origin == origin;
  if (same && !workspace.cells.empty()) return;
  workspace.geometry = geometry;
  workspace.origin = origin;
  workspace.cells.clear();
  for (int l = 0; l < geometry.cells_l(); ++l) {
    for (int w = 0; w < geometry.cells_w(); ++w) {
      const Position2 centre = geometry.centre_of({l, w});
      workspace.cells.push_back(
          look_at(origin, static_cast<float>(centre.x), static_cast<float>(centre.y)));
    }
  }
}

// How far down the beams reach, per sector, from those that came back nearby.
void measure_view(const PointsView& points, const std::array<float, 3>& origin,
                  UnseenWorkspace& workspace) {
  std::vector<float>& lowest = workspace.lowest;
  // The second half is what is seen in the sector itself.
  lowest.assign(2 * kSectors, kNothing);
  for (std::size_t i = 0; i < points.size; ++i) {
    const SectorPlace seen = workspace.places[i];
    if (seen.sector < 0) continue;
    float& low = lowest[static_cast<std::size_t>(kSectors + seen.sector)];
    low = std::min(low, tangent(origin, points.z[i], seen.range));
  }
  for (int sector = 0; sector < kSectors; ++sector) {
    for (int step = -kViewReach; step <= kViewReach; ++step) {
      const int near = (sector + step + kSectors) % kSectors;
      float& low = lowest[static_cast<std::size_t>(sector)];
      low = std::min(low, lowest[static_cast<std::size_t>(kSectors + near)]);
    }
  }
}

// Calls f(sector, range, top) for every point of a thing that stands on the ground.
template <class F>
void for_standing(const ScanView& scan, const DescriptionWorkspace& reference,
                  const Description& description, const std::vector<SectorPlace>& places, F&& f) {
  const std::array<float, 3>& origin = scan.origins.of(0);
  const FieldPoints& field = reference.field.points;
  for (std::size_t i = 0; i < scan.points.size; ++i) {
    const std::int32_t slot = reference.point_slots[i];
    if (slot < 0 || field.support[i] != Support::kAbove) continue;
    if (description.field.low[static_cast<std::size_t>(slot)] >= kHanging) continue;
    const SectorPlace seen = places[i];
    f(seen.sector, seen.range, tangent(origin, scan.points.z[i], seen.range));
  }
}

// Things by sector and range; each is as high as those before it.
void collect_things(const ScanView& scan, const DescriptionWorkspace& reference,
                    const Description& description, UnseenWorkspace& workspace) {
  workspace.count.assign(kSectors, 0);
  for_standing(scan, reference, description, workspace.places, [&](int sector, float, float) {
    ++workspace.count[static_cast<std::size_t>(sector)];
  });
  workspace.first.assign(kSectors + 1, 0);
  for (std::size_t sector = 0; sector < kSectors; ++sector)
    workspace.first[sector + 1] = workspace.first[sector] + workspace.count[sector];
  workspace.things.resize(static_cast<std::size_t>(workspace.first[kSectors]));
  std::copy(workspace.first.begin(), workspace.first.end() - 1, workspace.count.begin());
  for_standing(scan, reference, description, workspace.places,
               [&](int sector, float range, float top) {
                 const auto at = workspace.count[static_cast<std::size_t>(sector)]++;
                 workspace.things[static_cast<std::size_t>(at)] = {range, top};
               });
  for (std::size_t sector = 0; sector < kSectors; ++sector) {
    const auto begin = workspace.things.begin() + workspace.first[sector];
    const auto end = workspace.things.begin() + workspace.first[sector + 1];
    std::sort(begin, end, [](const SectorThing& a, const SectorThing& b) {
      return a.range != b.range ? a.range < b.range : a.top < b.top;
    });
    float top = std::numeric_limits<float>::lowest();
    for (auto thing = begin; thing != end; ++thing) thing->top = top = std::max(top, thing->top);
  }
}

bool is_occluded(const UnseenWorkspace& workspace, SectorPlace seen, float ground) {
  const auto sector = static_cast<std::size_t>(seen.sector);
  const auto begin = workspace.things.begin() + workspace.first[sector];
  const auto end = workspace.things.begin() + workspace.first[sector + 1];
  const auto behind =
      std::lower_bound(begin, end, seen.range - kBehind,
                       [](const SectorThing& t, float range) { return t.range < range; });
  return behind != begin && (behind - 1)->top >= ground;
}

bool is_seen(const Description& description, Slot slot) {
  if (slot == kUnobserved) return false;
  const auto s = static_cast<std::size_t>(slot);
  return description.field.on[s] + description.field.below[s] > 0;
}

}  // namespace

void explain_unseen_cells(const ScanView& scan, const DescriptionWorkspace& reference,
                          const Description& description, UnseenWorkspace& workspace,
                          std::vector<UnseenReason>& reasons) {
  const ElevationGrid& grid = description.grid;
  const bool known = scan.origins.known() && scan.points.size > 0;
  reasons.assign(static_cast<std::size_t>(grid.geometry.array_size()), UnseenReason::kNoReturn);
  if (known) {
    look_at_points(scan.points, scan.origins.of(0), workspace.places);
    look_at_cells(grid.geometry, scan.origins.of(0), workspace);
    measure_view(scan.points, scan.origins.of(0), workspace);
    collect_things(scan, reference, description, workspace);
  }
  std::size_t number = 0;
  for (int l = 0; l < grid.geometry.cells_l(); ++l) {
    for (int w = 0; w < grid.geometry.cells_w(); ++w, ++number) {
      const CellIndex cell{l, w};
      UnseenReason& reason = reasons[static_cast<std::size_t>(value_of(grid.geometry.id_of(cell)))];
      const Slot slot = grid.slot_at(cell);
      if (is_seen(description, slot)) {
        reason = UnseenReason::kSeen;
        continue;
      }
      if (slot != kUnobserved) reason = UnseenReason::kOccluded;  // under something
      if (slot != kUnobserved || !known) continue;
      const Position2 centre = grid.geometry.centre_of(cell);
      const auto x = static_cast<float>(centre.x), y = static_cast<float>(centre.y);
      const SectorPlace seen = workspace.cells[number];
      const float ground =
          tangent(scan.origins.of(0), reference.field.surface.height_at(x, y), seen.range);
      const float lowest = workspace.lowest[static_cast<std::size_t>(seen.sector)];
      if (is_occluded(workspace, seen, ground))
        reason = UnseenReason::kOccluded;
      else if (lowest == kNothing || ground < lowest)
        reason = UnseenReason::kOutOfView;
    }
  }
}

}  // namespace mrpt_terrain
