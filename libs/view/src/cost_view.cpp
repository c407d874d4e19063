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

/// \param missing cells without ground, which are lethal though nothing was seen of them; sorted
void paint_costs(Canvas& canvas, const MapPanel& panel, const ElevationGrid& grid,
                 const std::vector<Cost>& costs, const std::vector<std::int32_t>& missing,
                 const TopViewOptions& options) {
  const Raster<Slot> slots = slot_raster(
      grid, panel.width, panel.height,
      [&](std::size_t a, std::size_t b) { return rank_of(costs[a]) < rank_of(costs[b]); });
  Raster<std::uint32_t> pixels(panel.width, panel.height);
  std::transform(slots.values.begin(), slots.values.end(), pixels.values.begin(), [&](Slot slot) {
    return packed(slot == kUnobserved ? kUnobservedColour
                                      : colour_of(costs[static_cast<std::size_t>(slot)]));
  });
  paint_unseen(grid, options, pixels);
  const auto lethal = marked_raster(grid.geometry, missing, panel.width, panel.height);
  for (std::size_t k = 0; k < pixels.values.size(); ++k) {
    if (lethal.values[k] != 0) pixels.values[k] = packed(kLethalColour);
  }
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

void draw_cost_legend(Canvas& canvas, const TopViewLayout& layout, const std::vector<Cost>& costs,
                      std::size_t missing, const ElevationGrid& grid,
                      const TopViewOptions& options) {
  std::array<std::size_t, 4> cells{};
  for (const Cost& cost : costs) ++cells[static_cast<std::size_t>(cost.status)];
  cells[static_cast<std::size_t>(CostStatus::kLethal)] += missing;
  const double left = layout.right_column;
  const double base = layout.key_top + 12.0;
  canvas.text(left, base, "cost", kSmall);
  draw_cost_bar(canvas, {left + 64.0, base - 10.0, 180.0, 14.0});
  const auto count = [&](CostStatus status) {
    return grouped(cells[static_cast<std::size_t>(status)]);
  };
  canvas.text(left + 290.0, base + 22.0, "below 1: " + count(CostStatus::kOk), kSmall);
  draw_legend_entry(canvas, left + 290.0, base, kLethalColour,
                    "lethal: " + count(CostStatus::kLethal));
  draw_legend_entry(canvas, left + 410.0, base, kUnknownColour,
                    "cost unknown: " + count(CostStatus::kUnknown));
  canvas.text(left, base + 44.0, "not seen", kSmall);
  draw_unseen_legend(canvas, left + 64.0, base + 44.0, layout.column_width - 64.0, grid, options);
}

std::string caption_of(const RobotParams& robot, const CellCosts& costs) {
  const double degrees = 180.0 / 3.14159265358979323846;
  const std::string slope = fixed(std::min(robot.max_climb, robot.max_tilt) * degrees, 0) + "°";
  const std::string step = fixed(robot.max_step, 2) + " m";
  const std::string roughness = fixed(robot.max_roughness, 3) + " m";
  if (!costs.has(CostPart::kObstacle))
    return "Costs: slope to " + slope + ", step to " + step + ", roughness to " + roughness;
  return "Costs: to " + slope + ", steps " + step + ", roughness " + roughness + ", free above " +
         fixed(robot.height + robot.overhead_reserve, 1) + " m";
}

/// The options with the reasons that the costs know.
TopViewOptions with_unseen(const TopViewOptions& options, const CellCosts& costs) {
  TopViewOptions result = options;
  if (!costs.unseen.empty()) result.unseen = &costs.unseen;
  return result;
}

constexpr int kSheetColumns = 4;
constexpr int kSheetGap = 14;    // pixels
constexpr int kSheetTitle = 30;  // above each map
constexpr int kSheetMargin = 24;
constexpr int kSheetHead = 44;
constexpr int kSheetKey = 60;

/// A layer of the sheet: its name and the cost of every cell as if it were the only part.
struct Layer {
  std::string name;
  std::vector<Cost> costs;
  std::vector<std::int32_t> missing;  // cells without ground, if they belong to it
};

std::vector<Layer> layers_of(const CellCosts& costs, const std::vector<Cost>& all) {
  std::vector<Layer> layers;
  for (const auto& entry : enum_names(CostPart{})) {
    if (!costs.has(entry.value)) continue;
    Layer layer{entry.name, all, {}};
    if (entry.value == CostPart::kPothole) layer.missing = costs.missing;
    for (std::size_t k = 0; k < all.size(); ++k) {
      const double part = all[k].parts.of(entry.value);
      const bool of_plane = entry.value == CostPart::kSlope || entry.value == CostPart::kRoughness;
      const bool known = !of_plane || costs.status[k] == FeatureStatus::kOk;
      layer.costs[k].cost = std::min(part, 1.0);
      layer.costs[k].status = !known        ? CostStatus::kUnknown
                              : part >= 1.0 ? CostStatus::kLethal
                                            : CostStatus::kOk;
    }
    layers.push_back(std::move(layer));
  }
  layers.push_back({"cost: the largest of all", all, costs.missing});
  return layers;
}

/// Where the k-th map of a sheet lies.
MapPanel panel_of_sheet(const MapPanel& extent, std::size_t k, int width, int height) {
  MapPanel panel = extent;
  panel.width = width;
  panel.height = height;
  const auto column = static_cast<int>(k) % kSheetColumns,
             row = static_cast<int>(k) / kSheetColumns;
  panel.left = kSheetMargin + column * (width + kSheetGap);
  panel.top = kSheetHead + kSheetTitle + row * (height + kSheetTitle + kSheetGap);
  return panel;
}

std::string lethal_text(const Layer& layer) {
  const auto lethal = std::count_if(layer.costs.begin(), layer.costs.end(), [](const Cost& cost) {
    return cost.status == CostStatus::kLethal;
  });
  return layer.name +
         ", lethal: " + grouped(static_cast<std::size_t>(lethal) + layer.missing.size());
}

void draw_sheet_key(Canvas& canvas, double top, const ElevationGrid& grid,
                    const TopViewOptions& options) {
  const double left = kSheetMargin, base = top + 14.0;
  canvas.text(left, base, "part of the limit", kSmall);
  draw_cost_bar(canvas, {left + 110.0, base - 10.0, 180.0, 14.0});
  draw_legend_entry(canvas, left + 330.0, base, kLethalColour, "1 and more: lethal");
  draw_legend_entry(canvas, left + 480.0, base, kUnknownColour, "unknown");
  canvas.text(left + 580.0, base, "not seen", kSmall);
  draw_unseen_legend(canvas, left + 644.0, base, 480.0, grid, options);
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
                     const TopViewOptions& given) {
  const TopViewOptions options = with_unseen(given, costs);
  const TopViewLayout layout =
      top_view_layout(description.grid.geometry, options.max_width, options.max_height);
  Canvas canvas(layout.width, layout.height);
  const std::vector<Cost> worst = costs_of(costs, robot);
  TopViewOptions of_title = options;
  of_title.max_labels = description.things.size();  // no numbers here
  draw_title(canvas, layout, description, of_title);
  draw_heights(canvas, layout, description, options.axes);
  const MapPanel& panel = layout.classes;
  paint_costs(canvas, panel, description.grid, worst, costs.missing, options);
  draw_grid(canvas, panel, options.axes);
  clip_to(canvas, panel);
  draw_robot(canvas, panel);
  cairo_restore(canvas.context());
  draw_caption(canvas, panel, layout.right_column, layout.right_column + layout.column_width,
               caption_of(robot, costs));
  draw_cost_legend(canvas, layout, worst, costs.missing.size(), description.grid, options);
  draw_footer(canvas, layout, options.params);
  files::write_atomically(file, png_bytes(canvas.pixels()));
}

void write_cost_layers(const std::string& file, const Description& description,
                       const CellCosts& costs, const RobotParams& robot,
                       const TopViewOptions& given) {
  const TopViewOptions options = with_unseen(given, costs);
  const MapPanel extent =
      top_view_layout(description.grid.geometry, options.max_width, options.max_height).classes;
  const std::vector<Layer> layers = layers_of(costs, costs_of(costs, robot));
  const int room = (options.max_width - 2 * kSheetMargin - (kSheetColumns - 1) * kSheetGap);
  const double scale =
      static_cast<double>(room / kSheetColumns) / std::max(extent.width, extent.height);
  const int width = std::max(1, static_cast<int>(scale * extent.width));
  const int height = std::max(1, static_cast<int>(scale * extent.height));
  const int rows = (static_cast<int>(layers.size()) + kSheetColumns - 1) / kSheetColumns;
  const int key_top = kSheetHead + rows * (height + kSheetTitle + kSheetGap);
  Canvas canvas(options.max_width, key_top + kSheetKey);
  canvas.text(kSheetMargin, 30.0, "Parts of the costs, worst heading: " + base_name(options.source),
              {19.0, true, Align::kLeft, kInk, false});
  for (std::size_t k = 0; k < layers.size(); ++k) {
    const MapPanel panel = panel_of_sheet(extent, k, width, height);
    paint_costs(canvas, panel, description.grid, layers[k].costs, layers[k].missing, options);
    draw_frame(canvas, panel);
    canvas.text(panel.left, panel.top - 9.0, lethal_text(layers[k]),
                {13.0, true, Align::kLeft, kInk, false});
  }
  draw_sheet_key(canvas, key_top, description.grid, options);
  files::write_atomically(file, png_bytes(canvas.pixels()));
}

}  // namespace mrpt_terrain::view
