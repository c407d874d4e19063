// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/cost_view.h"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "mrpt_terrain/files/atomic_file.h"
#include "mrpt_terrain/view/cell_raster.h"
#include "mrpt_terrain/view/png_file.h"
#include "mrpt_terrain/view/text.h"
#include "top_view_parts.h"

namespace mrpt_terrain::view {
namespace {

std::vector<Cost> costs_of(const CellCosts& costs, const RobotParams& robot) {
  std::vector<Cost> result(costs.size());
  for (std::size_t k = 0; k < result.size(); ++k) {
    result[k] = cost_of(costs, static_cast<Slot>(k), robot);
  }
  return result;
}

/// What shows where several cells share a pixel: the worst.
int rank_of(const Cost& cost) {
  switch (cost.status) {
    case CostStatus::kLethal:
      return 102;
    case CostStatus::kOk:
      return 1 + static_cast<int>(100.0 * cost.cost);
    case CostStatus::kUnknown:
    case CostStatus::kOutside:
      break;
  }
  return 0;
}

void paint_costs(Canvas& canvas, const MapPanel& panel, const ElevationGrid& grid,
                 const std::vector<Cost>& costs) {
  const Raster<Slot> slots = slot_raster(
      grid, panel.width, panel.height,
      [&](std::size_t a, std::size_t b) { return rank_of(costs[a]) < rank_of(costs[b]); });
  Raster<std::uint32_t> pixels(panel.width, panel.height);
  std::transform(slots.values.begin(), slots.values.end(), pixels.values.begin(), [&](Slot slot) {
    return packed(slot == kUnobserved ? kUnobservedColour
                                      : colour_of(costs[static_cast<std::size_t>(slot)]));
  });
  canvas.paint(pixels, panel.left, panel.top);
}

void draw_cost_bar(Canvas& canvas, const Box& bar) {
  for (int column = 0; column < static_cast<int>(bar.width); ++column) {
    canvas.fill_box({bar.left + column, bar.top, 1.0, bar.height},
                    cost_colour((column + 0.5) / bar.width));
  }
  for (const double cost : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const double x = bar.left + cost * bar.width;
    canvas.line(x, bar.top + bar.height, x, bar.top + bar.height + 4.0, kFaintInk, 1.0);
    canvas.text(x, bar.top + bar.height + 16.0, fixed(cost, 2), kTick);
  }
}

void draw_cost_legend(Canvas& canvas, const TopViewLayout& layout, const std::vector<Cost>& costs) {
  std::array<std::size_t, 4> cells{};
  for (const Cost& cost : costs) ++cells[static_cast<std::size_t>(cost.status)];
  const double left = layout.right_column;
  const double base = layout.key_top + 12.0;
  canvas.text(left, base, "cost", kSmall);
  draw_cost_bar(canvas, {left + 44.0, base - 10.0, 180.0, 14.0});
  const auto count = [&](CostStatus status) {
    return grouped(cells[static_cast<std::size_t>(status)]);
  };
  canvas.text(left + 44.0, base + 36.0, count(CostStatus::kOk) + " cells", kSmall);
  draw_legend_entry(canvas, left + 270.0, base, kLethalColour,
                    "lethal: " + count(CostStatus::kLethal));
  draw_legend_entry(canvas, left + 390.0, base, kUnknownColour,
                    "cost unknown: " + count(CostStatus::kUnknown));
  draw_legend_entry(canvas, left + 270.0, base + 22.0, kUnobservedColour, "not observed");
}

std::string caption_of(const RobotParams& robot) {
  const double degrees = 180.0 / 3.14159265358979323846;
  return "Costs: slope to " + fixed(std::min(robot.max_climb, robot.max_tilt) * degrees, 0) +
         "°, step to " + fixed(robot.max_step, 2) + " m, roughness to " +
         fixed(robot.max_roughness, 3) + " m";
}

}  // namespace

Rgb colour_of(const Cost& cost) {
  switch (cost.status) {
    case CostStatus::kOk:
      return cost_colour(cost.cost);
    case CostStatus::kLethal:
      return kLethalColour;
    case CostStatus::kUnknown:
    case CostStatus::kOutside:
      break;
  }
  return kUnknownColour;
}

void write_cost_view(const std::string& file, const Description& description,
                     const CellCosts& costs, const RobotParams& robot,
                     const TopViewOptions& options) {
  const TopViewLayout layout =
      top_view_layout(description.grid.geometry, options.max_width, options.max_height);
  Canvas canvas(layout.width, layout.height);
  const std::vector<Cost> worst = costs_of(costs, robot);
  draw_title(canvas, layout, description, options);
  draw_heights(canvas, layout, description, options.axes);
  const MapPanel& panel = layout.classes;
  paint_costs(canvas, panel, description.grid, worst);
  draw_grid(canvas, panel, options.axes);
  clip_to(canvas, panel);
  draw_robot(canvas, panel);
  cairo_restore(canvas.context());
  draw_caption(canvas, panel, layout.right_column, layout.right_column + layout.column_width,
               caption_of(robot));
  draw_cost_legend(canvas, layout, worst);
  draw_footer(canvas, layout, options.params);
  files::write_atomically(file, png_bytes(canvas.pixels()));
}

}  // namespace mrpt_terrain::view
