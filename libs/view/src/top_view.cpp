// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/top_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "canvas.h"
#include "mrpt_terrain/files/atomic_file.h"
#include "mrpt_terrain/view/cell_raster.h"
#include "mrpt_terrain/view/cluster_order.h"
#include "mrpt_terrain/view/label_placement.h"
#include "mrpt_terrain/view/palette.h"
#include "mrpt_terrain/view/png_file.h"
#include "mrpt_terrain/view/scan_record.h"
#include "mrpt_terrain/view/text.h"
#include "mrpt_terrain/view/top_view_layout.h"

namespace mrpt_terrain::view {
namespace {

constexpr Rgb kInk{34, 34, 34};
constexpr Rgb kFaintInk{105, 105, 105};
constexpr Rgb kWhite{255, 255, 255};
constexpr double kLeastGridStep = 55.0;  // pixels between grid lines
constexpr double kMargin = 24.0;         // pixels

const TextStyle kSmall{11.5, false, Align::kLeft, kInk, false};
const TextStyle kTick{11.0, false, Align::kCentre, kFaintInk, false};
const TextStyle kNumber{11.0, true, Align::kCentre, kInk, false};
const TextStyle kCaption{14.0, true, Align::kLeft, kInk, false};

std::uint32_t packed(Rgb colour) {
  return (std::uint32_t{colour.r} << 16U) | (std::uint32_t{colour.g} << 8U) | colour.b;
}

TextStyle aligned(TextStyle style, Align align) {
  style.align = align;
  return style;
}

Box box_of(const MapPanel& panel) {
  return {static_cast<double>(panel.left), static_cast<double>(panel.top),
          static_cast<double>(panel.width), static_cast<double>(panel.height)};
}

/// Multiples of a round step within [low, high].
std::vector<double> ticks(double low, double high, double step) {
  std::vector<double> result;
  const double slack = 1e-9 * step;
  for (double k = std::ceil((low - slack) / step); k * step <= high + slack; k += 1.0) {
    result.push_back(k * step);
  }
  return result;
}

void paint_heights(Canvas& canvas, const MapPanel& panel, const ElevationGrid& grid,
                   const HeightRange& range) {
  const auto heights = height_raster(grid, panel.width, panel.height);
  // Rounding to 256 colours costs nothing that an eye can see and keeps the file small.
  std::array<std::uint32_t, 256> colours{};
  for (std::size_t k = 0; k < colours.size(); ++k) {
    colours[k] = packed(height_colour(static_cast<double>(k) / 255.0));
  }
  const float factor = static_cast<float>(255.0 / (range.high - range.low));
  const auto low = static_cast<float>(range.low);
  Raster<std::uint32_t> pixels(panel.width, panel.height);
  std::transform(heights.values.begin(), heights.values.end(), pixels.values.begin(),
                 [&](float height) {
                   if (std::isnan(height)) return packed(kUnobservedColour);
                   const float place = std::clamp((height - low) * factor, 0.0F, 255.0F);
                   return colours[static_cast<std::size_t>(std::lround(place))];
                 });
  canvas.paint(pixels, panel.left, panel.top);
}

void paint_kinds(Canvas& canvas, const MapPanel& panel, const Raster<CellKind>& kinds) {
  Raster<std::uint32_t> pixels(panel.width, panel.height);
  std::transform(kinds.values.begin(), kinds.values.end(), pixels.values.begin(),
                 [](CellKind kind) { return packed(colour_of(kind)); });
  canvas.paint(pixels, panel.left, panel.top);
}

void draw_grid(Canvas& canvas, const MapPanel& panel) {
  const double step = round_step(kLeastGridStep / panel.pixels_per_metre());
  const int decimals = decimals_of(step);
  const double right = panel.left + panel.width;
  const double bottom = panel.top + panel.height;
  for (const double x : ticks(panel.x_min, panel.x_max, step)) {
    const double row = std::round(panel.pixel_of({x, 0.0}).y) - 0.5;
    canvas.line(panel.left, row, right, row, kInk, 1.0, 0.14);
    canvas.line(panel.left - 4.0, row, panel.left, row, kFaintInk, 1.0);
    canvas.text(panel.left - 7.0, row + 4.0, fixed(x, decimals), aligned(kTick, Align::kRight));
  }
  for (const double y : ticks(panel.y_min, panel.y_max, step)) {
    const double column = std::round(panel.pixel_of({0.0, y}).x) - 0.5;
    canvas.line(column, panel.top, column, bottom, kInk, 1.0, 0.14);
    canvas.line(column, bottom, column, bottom + 4.0, kFaintInk, 1.0);
    canvas.text(column, bottom + 16.0, fixed(y, decimals), kTick);
  }
  canvas.text_upwards(panel.left - 42.0, panel.top + 0.5 * panel.height, "x, forward [m]", kTick);
  canvas.text(panel.left + 0.5 * panel.width, bottom + 33.0, "y, left [m]", kTick);
  canvas.frame_box(box_of(panel), kFaintInk);
}

/// Pixels of the panel that the robot and its axes take.
Box robot_box(const MapPanel& panel) {
  const PixelPosition origin = panel.pixel_of({0.0, 0.0});
  return {origin.x - panel.left - 52.0, origin.y - panel.top - 54.0, 64.0, 66.0};
}

void draw_arrow(Canvas& canvas, PixelPosition from, PixelPosition to) {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  const double dx = (to.x - from.x) / length;
  const double dy = (to.y - from.y) / length;
  for (const bool rim : {true, false}) {
    const Rgb colour = rim ? kWhite : kInk;
    canvas.line(from.x, from.y, to.x - 4.0 * dx, to.y - 4.0 * dy, colour, rim ? 4.0 : 1.6);
    cairo_t* context = canvas.context();
    cairo_move_to(context, to.x, to.y);
    cairo_line_to(context, to.x - 8.0 * dx + 3.5 * dy, to.y - 8.0 * dy - 3.5 * dx);
    cairo_line_to(context, to.x - 8.0 * dx - 3.5 * dy, to.y - 8.0 * dy + 3.5 * dx);
    cairo_close_path(context);
    canvas.set_colour(colour);
    if (rim) {
      cairo_set_line_width(context, 2.4);
      cairo_stroke(context);
    } else {
      cairo_fill(context);
    }
  }
}

/// A triangle that points along x, and the axes.
void draw_robot(Canvas& canvas, const MapPanel& panel) {
  const PixelPosition origin = panel.pixel_of({0.0, 0.0});
  draw_arrow(canvas, origin, {origin.x, origin.y - 40.0});
  draw_arrow(canvas, origin, {origin.x - 40.0, origin.y});
  TextStyle style{12.0, true, Align::kCentre, kInk, true};
  canvas.text(origin.x, origin.y - 43.0, "x", style);
  canvas.text(origin.x - 47.0, origin.y + 4.0, "y", style);
  cairo_t* context = canvas.context();
  cairo_move_to(context, origin.x, origin.y - 11.0);
  cairo_line_to(context, origin.x + 8.0, origin.y + 8.0);
  cairo_line_to(context, origin.x, origin.y + 4.0);
  cairo_line_to(context, origin.x - 8.0, origin.y + 8.0);
  cairo_close_path(context);
  canvas.set_colour(kInk);
  cairo_fill_preserve(context);
  canvas.set_colour(kWhite);
  cairo_set_line_width(context, 1.5);
  cairo_stroke(context);
}

void draw_caption(Canvas& canvas, const MapPanel& panel, int left, int right,
                  const std::string& caption) {
  const double base = panel.top - 11.0;
  canvas.text(left, base, caption, kCaption);
  const double metres = round_step(70.0 / panel.pixels_per_metre());
  const double length = metres * panel.pixels_per_metre();
  const std::string text = fixed(metres, decimals_of(metres)) + " m";
  const double start = right - length - 1.0;
  canvas.text(start - 8.0, base, text, aligned(kSmall, Align::kRight));
  canvas.line(start, base - 4.0, right - 1.0, base - 4.0, kInk, 2.0);
  canvas.line(start, base - 9.0, start, base + 1.0, kInk, 1.5);
  canvas.line(right - 1.0, base - 9.0, right - 1.0, base + 1.0, kInk, 1.5);
}

/// The cluster's cell that lies nearest to its centroid, which itself may lie outside a bent one.
Position2 anchor_of(const Description& description, std::size_t cluster) {
  const Position2 centroid = description.things[cluster].centroid;
  const GridGeometry& geometry = description.grid.geometry;
  Position2 best = centroid;
  double least = std::numeric_limits<double>::infinity();
  for (const Slot slot : description.clusters.slots.row(cluster)) {
    const CellId id = description.grid.cell[static_cast<std::size_t>(slot)];
    const Position2 centre = geometry.centre_of(geometry.index_of(id));
    const double distance = std::hypot(centre.x - centroid.x, centre.y - centroid.y);
    if (distance >= least) continue;
    least = distance;
    best = centre;
  }
  return best;
}

Raster<std::uint8_t> busy_pixels(const Raster<CellKind>& kinds) {
  Raster<std::uint8_t> busy(kinds.width, kinds.height);
  std::transform(kinds.values.begin(), kinds.values.end(), busy.values.begin(), [](CellKind kind) {
    if (kind == CellKind::kPothole) return std::uint8_t{2};
    return static_cast<std::uint8_t>(kind >= CellKind::kOther ? 1 : 0);
  });
  return busy;
}

/// The number of a cluster and the thing it names, pixels of the picture.
struct NumberLabel {
  std::string text;
  Rgb colour;
  LabelRequest request;
};

/// The line from a label to the thing it names, if it is not over it.
void draw_leader(Canvas& canvas, const NumberLabel& label, const Box& box) {
  const double x = box.left + 0.5 * box.width;
  const double y = box.top + 0.5 * box.height;
  if (std::hypot(x - label.request.x, y - label.request.y) <= 0.5 * box.height) return;
  canvas.line(x, y, label.request.x, label.request.y, kWhite, 3.0, 0.8);
  canvas.line(x, y, label.request.x, label.request.y, kInk, 1.0);
}

void draw_number(Canvas& canvas, const NumberLabel& label, const Box& box) {
  canvas.fill_box(box, kWhite);
  canvas.frame_box(box, label.colour);
  canvas.text(box.left + 0.5 * box.width, box.top + box.height - 4.0, label.text, kNumber);
}

std::vector<NumberLabel> make_labels(Canvas& canvas, const MapPanel& panel,
                                     const Description& description, std::size_t at_most) {
  std::vector<NumberLabel> labels;
  for (const std::size_t cluster : largest_clusters(description, at_most)) {
    const PixelPosition place = panel.pixel_of(anchor_of(description, cluster));
    NumberLabel label{std::to_string(cluster),
                      colour_of(description.things[cluster].terrain_class),
                      {place.x, place.y, 0.0, 15.0}};
    label.request.width = std::ceil(canvas.text_width(label.text, kNumber)) + 7.0;
    labels.push_back(label);
  }
  return labels;
}

void draw_numbers(Canvas& canvas, const MapPanel& panel, const Description& description,
                  const Raster<CellKind>& kinds, std::size_t at_most) {
  const auto labels = make_labels(canvas, panel, description, at_most);
  std::vector<LabelRequest> requests;
  for (const NumberLabel& label : labels) {
    requests.push_back(label.request);
    requests.back().x -= panel.left;
    requests.back().y -= panel.top;
  }
  auto places = place_labels(requests, busy_pixels(kinds), {robot_box(panel)});
  for (auto& place : places) {
    if (!place) continue;
    place->left += panel.left;
    place->top += panel.top;
  }
  // All lines first: none may cross out a number.
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (places[k]) draw_leader(canvas, labels[k], *places[k]);
  }
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (places[k]) draw_number(canvas, labels[k], *places[k]);
  }
}

void draw_bar(Canvas& canvas, const Box& bar) {
  for (int column = 0; column < static_cast<int>(bar.width); ++column) {
    canvas.fill_box({bar.left + column, bar.top, 1.0, bar.height},
                    height_colour((column + 0.5) / bar.width));
  }
  // Pointed ends: the end colours go on beyond the scale.
  cairo_t* context = canvas.context();
  for (const bool is_high : {false, true}) {
    const double edge = is_high ? bar.left + bar.width : bar.left;
    cairo_move_to(context, edge, bar.top);
    cairo_line_to(context, edge + (is_high ? 10.0 : -10.0), bar.top + 0.5 * bar.height);
    cairo_line_to(context, edge, bar.top + bar.height);
    cairo_close_path(context);
    canvas.set_colour(height_colour(is_high ? 1.0 : 0.0));
    cairo_fill(context);
  }
}

void draw_height_key(Canvas& canvas, const TopViewLayout& layout, const HeightRange& range) {
  const double top = layout.key_top + 2.0;
  if (range.empty) {
    canvas.text(layout.left_column, top + 12.0, "no cell was observed", kSmall);
    return;
  }
  const Box bar{layout.left_column + 84.0, top, layout.column_width - 2.0 * 84.0, 14.0};
  draw_bar(canvas, bar);
  const double metres_per_pixel = (range.high - range.low) / bar.width;
  const double step = round_step(60.0 * metres_per_pixel);
  for (const double height : ticks(range.low, range.high, step)) {
    const double column = bar.left + (height - range.low) / metres_per_pixel;
    canvas.line(column, bar.top + bar.height, column, bar.top + bar.height + 4.0, kFaintInk, 1.0);
    canvas.text(column, bar.top + bar.height + 16.0, fixed(height, decimals_of(step)), kTick);
  }
  canvas.text(layout.left_column, bar.top + 11.5, "height [m]", kSmall);
  canvas.text(bar.left + 0.5 * bar.width, bar.top + bar.height + 34.0,
              "the colours span 2 % to 98 % of the cells; lowest cell " + fixed(range.lowest, 2) +
                  " m, highest " + fixed(range.highest, 2) + " m",
              kTick);
}

void draw_legend_entry(Canvas& canvas, double left, double base, CellKind kind,
                       const std::string& text) {
  const Box swatch{left, base - 10.0, 14.0, 12.0};
  canvas.fill_box(swatch, colour_of(kind));
  canvas.frame_box(swatch, kFaintInk);
  canvas.text(left + 20.0, base, text, kSmall);
}

void draw_legend(Canvas& canvas, const TopViewLayout& layout, const Description& description) {
  const DescriptionCounts counts = count(description);
  const auto clusters = [&](TerrainClass kind) {
    return std::string(name_of(kind)) + ": " +
           grouped(counts.clusters[static_cast<std::size_t>(kind)]);
  };
  const GridGeometry& geometry = description.grid.geometry;
  const std::size_t cells =
      static_cast<std::size_t>(geometry.cells_l()) * static_cast<std::size_t>(geometry.cells_w());
  const double first = layout.key_top + 12.0;
  const double second = first + 22.0;
  const double left = layout.right_column;
  const double width = layout.column_width;
  canvas.text(left, first, "clusters", kSmall);
  canvas.text(left, second, "cells", kSmall);
  const double indent = left + 64.0;
  const double quarter = (width - 64.0) / 4.0;
  draw_legend_entry(canvas, indent, first, CellKind::kObstacle, clusters(TerrainClass::kObstacle));
  draw_legend_entry(canvas, indent + quarter, first, CellKind::kSlope,
                    clusters(TerrainClass::kSlope));
  draw_legend_entry(canvas, indent + 2.0 * quarter, first, CellKind::kPothole,
                    clusters(TerrainClass::kPothole));
  draw_legend_entry(canvas, indent + 3.0 * quarter, first, CellKind::kOther,
                    clusters(TerrainClass::kOther));
  draw_legend_entry(canvas, indent, second, CellKind::kGround,
                    "ground: " + grouped(counts.ground_cells));
  draw_legend_entry(canvas, indent + quarter + 10.0, second, CellKind::kDropped,
                    "in " + grouped(counts.dropped_groups) + " groups too small");
  draw_legend_entry(canvas, indent + 2.0 * quarter + 64.0, second, CellKind::kUnobserved,
                    "not observed: " + grouped(cells - counts.observed_cells));
}

/// Leaves out the middle of a text that is too long for its place.
std::string shortened(Canvas& canvas, const std::string& text, const TextStyle& style,
                      double room) {
  if (canvas.text_width(text, style) <= room) return text;
  for (std::size_t keep = text.size() / 2; keep > 0; --keep) {
    const std::string shorter =
        printable(text.substr(0, keep)) + "…" + printable(text.substr(text.size() - keep));
    if (canvas.text_width(shorter, style) <= room) return shorter;
  }
  return "…";
}

void draw_title(Canvas& canvas, const TopViewLayout& layout, const Description& description,
                const TopViewOptions& options) {
  const TextStyle bold{19.0, true, Align::kLeft, kInk, false};
  const TextStyle plain{15.0, false, Align::kRight, kFaintInk, false};
  const double right = layout.width - kMargin;
  const std::string when =
      "scan " + std::to_string(options.scan_index) + "   " + time_text(options.stamp);
  canvas.text(right, 34.0, when, plain);
  const double room = right - kMargin - canvas.text_width(when, plain) - 30.0;
  const std::string name = printable(base_name(options.source));
  canvas.text(kMargin, 34.0, shortened(canvas, name, bold, room), bold);
  const ProjectionCounts& points = description.projection;
  const std::size_t all = points.in_map + points.not_finite + points.too_high + points.outside_map;
  std::string line = grouped(all) + " points: " + grouped(points.in_map) + " in the map, " +
                     grouped(points.outside_map) + " outside, " + grouped(points.too_high) +
                     " too high";
  if (points.not_finite > 0) line += ", " + grouped(points.not_finite) + " not finite";
  line += ".   " + grouped(description.things.size()) + " clusters";
  if (description.things.size() > options.max_labels) {
    line += ", numbered: the largest " + std::to_string(options.max_labels);
  }
  canvas.text(kMargin, 57.0, line + ".", {13.0, false, Align::kLeft, kInk, false});
}

void draw_footer(Canvas& canvas, const TopViewLayout& layout, const DescriptionParams& params) {
  const auto number = [](double value) { return shortest(value); };
  const double degrees = 180.0 / 3.14159265358979323846;
  const std::string grid =
      "map " + number(params.grid.length) + " m x " + number(params.grid.width) + " m, cells of " +
      number(params.grid.cell_size) + " m, points below " + number(params.grid.max_height) +
      " m;  T_diff " + number(params.ground.t_diff) + " m, T_high " + number(params.ground.t_high) +
      " m, T_low " + number(params.ground.t_low) + " m;  T_c " +
      std::to_string(params.clusters.t_c) + " cells;  T_pos " + number(params.classes.t_pos) +
      " m, T_neg " + number(params.classes.t_neg) + " m";
  const std::string features =
      "slopes " + fixed(params.classes.slope_min * degrees, 0) + "° to " +
      fixed(params.classes.slope_max * degrees, 0) + "°;  T_ratio " +
      number(params.roughness.t_ratio) + ", T_L " + number(params.roughness.t_l) + " m², T_S " +
      number(params.roughness.t_s) + " m²;  T_q " + number(params.slope.inlier_distance) +
      " m, T_Inlier " + number(params.slope.inlier_share) + ", MaxIterations " +
      std::to_string(params.slope.max_iterations);
  const TextStyle style{11.0, false, Align::kLeft, kFaintInk, false};
  const double base = layout.footer_top + 18.0;
  canvas.line(kMargin, layout.footer_top + 0.5, layout.width - kMargin, layout.footer_top + 0.5,
              kFaintInk, 1.0, 0.5);
  canvas.text(kMargin, base, grid, style);
  canvas.text(kMargin, base + 17.0, features, style);
}

void clip_to(Canvas& canvas, const MapPanel& panel) {
  cairo_save(canvas.context());
  cairo_rectangle(canvas.context(), panel.left, panel.top, panel.width, panel.height);
  cairo_clip(canvas.context());
}

void draw_heights(Canvas& canvas, const TopViewLayout& layout, const Description& description) {
  const HeightRange range = robust_range(description.grid);
  const MapPanel& panel = layout.heights;
  if (!range.empty) paint_heights(canvas, panel, description.grid, range);
  draw_grid(canvas, panel);
  clip_to(canvas, panel);
  draw_robot(canvas, panel);
  cairo_restore(canvas.context());
  draw_caption(canvas, panel, layout.left_column, layout.left_column + layout.column_width,
               "Heights: mean of each cell");
  draw_height_key(canvas, layout, range);
}

void draw_classes(Canvas& canvas, const TopViewLayout& layout, const Description& description,
                  std::size_t max_labels) {
  const MapPanel& panel = layout.classes;
  const auto kinds = kind_raster(description, panel.width, panel.height);
  paint_kinds(canvas, panel, kinds);
  draw_grid(canvas, panel);
  clip_to(canvas, panel);
  draw_robot(canvas, panel);
  draw_numbers(canvas, panel, description, kinds, max_labels);
  cairo_restore(canvas.context());
  draw_caption(canvas, panel, layout.right_column, layout.right_column + layout.column_width,
               "Classes of clusters");
  draw_legend(canvas, layout, description);
}

}  // namespace

void write_top_view(const std::string& file, const Description& description,
                    const TopViewOptions& options) {
  const TopViewLayout layout =
      top_view_layout(description.grid.geometry, options.max_width, options.max_height);
  Canvas canvas(layout.width, layout.height);
  draw_title(canvas, layout, description, options);
  draw_heights(canvas, layout, description);
  draw_classes(canvas, layout, description, options.max_labels);
  draw_footer(canvas, layout, options.params);
  files::write_atomically(file, png_bytes(canvas.pixels()));
}

}  // namespace mrpt_terrain::view
