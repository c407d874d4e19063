// SPDX-License-Identifier: BSD-3-Clause
#include "thing_parts.h"

namespace mrpt_terrain {
namespace {

/// The parts of their cells that points stand for, as bits of FieldCells::parts.
class PartOf {
 public:
  PartOf(const ScanView& scan, const GridGeometry& geometry)
      : scan_(scan),
        half_length_(geometry.half_length()),
        half_width_(geometry.half_width()),
        parts_per_metre_(FieldCells::kParts / geometry.cell_size()) {}

  [[nodiscard]] std::uint16_t operator()(std::size_t point) const {
    constexpr auto kAll = static_cast<std::uint16_t>(~0U);
    if (!scan_.origins.is_measured(point)) return kAll;
    const int l = part(scan_.points.x[point], half_length_);
    const int w = part(scan_.points.y[point], half_width_);
    return static_cast<std::uint16_t>(1U << (FieldCells::kParts * l + w));
  }

 private:
  [[nodiscard]] int part(float position, double half) const {
    const auto place = static_cast<int>((static_cast<double>(position) + half) * parts_per_metre_);
    return place % FieldCells::kParts;
  }

  const ScanView& scan_;
  double half_length_, half_width_, parts_per_metre_;
};

}  // namespace

void mark_thing_parts(const ScanView& scan, const FieldPoints& points,
                      const std::vector<float>& raised, const PointSlots& point_slots,
                      const ElevationGrid& grid, FieldCells& cells) {
  const PartOf part_of(scan, grid.geometry);
  cells.parts.assign(grid.observed(), 0);
  for (std::size_t i = 0; i < point_slots.size(); ++i) {
    const bool of_thing = points.support[i] == Support::kAbove || raised[i] > 0.0F;
    if (!of_thing || point_slots[i] < 0) continue;
    std::uint16_t& parts = cells.parts[static_cast<std::size_t>(point_slots[i])];
    parts = static_cast<std::uint16_t>(parts | part_of(i));
  }
}

}  // namespace mrpt_terrain
