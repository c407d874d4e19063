// SPDX-License-Identifier: BSD-3-Clause
#include "top_view_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "mrpt_terrain/view/cell_raster.h"
#include "mrpt_terrain/view/text.h"

namespace mrpt_terrain::view {
namespace {

constexpr double kLeastGridStep = 55.0;  // pixels between grid lines
constexpr double kMargin = 24.0;         // pixels

const TextStyle kCaption{14.0, true, Align::kLeft, kInk, false};

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

std::string paper_text(const DescriptionParams& params) {
  return "T_diff " + shortest(params.ground.t_diff) + " m, T_high " +
         shortest(params.ground.t_high) + " m, T_low " + shortest(params.ground.t_low) +
         " m;  T_c " + std::to_string(params.clusters.t_c) + " cells;  T_pos " +
         shortest(params.classes.t_pos) + " m, T_neg " + shortest(params.classes.t_neg) + " m";
}

// Heights are above the ground reference there.
std::string field_text(const DescriptionParams& params) {
  return "field mode: reference in cells of " + shortest(params.ground_surface.cell_size) +
         " m;  things of " + std::to_string(params.field_clusters.t_c) + " cells or " +
         std::to_string(params.field_clusters.t_points) + " points;  holes from " +
         shortest(params.holes.mean_depth) + " m;  T_pos " + shortest(params.classes.t_pos) +
         " m, T_neg " + shortest(params.classes.t_neg) + " m";
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

}  // namespace

void draw_frame(Canvas& canvas, const MapPanel& panel) {
  const PixelPosition origin = panel.pixel_of({0.0, 0.0});
  canvas.fill_box({origin.x - 3.0, origin.y - 3.0, 6.0, 6.0}, kWhite);
  canvas.fill_box({origin.x - 2.0, origin.y - 2.0, 4.0, 4.0}, kInk);
  canvas.frame_box(box_of(panel), kFaintInk);
}

bool tells_unseen(const ElevationGrid& grid, const TopViewOptions& options) {
  return options.unseen != nullptr &&
         options.unseen->size() == static_cast<std::size_t>(grid.geometry.array_size());
}

void paint_unseen(const ElevationGrid& grid, const TopViewOptions& options,
                  Raster<std::uint32_t>& pixels) {
  if (!tells_unseen(grid, options)) return;
  const auto reasons = unseen_raster(grid, *options.unseen, pixels.width, pixels.height);
  for (std::size_t k = 0; k < pixels.values.size(); ++k) {
    if (reasons.values[k] != UnseenReason::kSeen)
      pixels.values[k] = packed(colour_of(reasons.values[k]));
  }
}

void draw_unseen_legend(Canvas& canvas, double left, double base, double width,
                        const ElevationGrid& grid, const TopViewOptions& options) {
  if (!tells_unseen(grid, options)) {
    const std::size_t cells = static_cast<std::size_t>(grid.geometry.cells_l()) *
                              static_cast<std::size_t>(grid.geometry.cells_w());
    draw_legend_entry(canvas, left, base, kUnobservedColour,
                      "not observed: " + grouped(cells - grid.observed()));
    return;
  }
  const auto counts = count_unseen(grid, *options.unseen);
  const auto entry = [&](double place, UnseenReason reason, const std::string& name) {
    draw_legend_entry(canvas, left + place * width, base, colour_of(reason),
                      name + ": " + grouped(counts[static_cast<std::size_t>(reason)]));
  };
  entry(0.0, UnseenReason::kOccluded, "occluded");
  entry(1.0 / 3.0, UnseenReason::kNoReturn, "no return");
  entry(2.0 / 3.0, UnseenReason::kOutOfView, "out of view");
}

void draw_grid(Canvas& canvas, const MapPanel& panel, ViewAxes axes) {
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
  const bool of_robot = axes == ViewAxes::kRobot;
  canvas.text_upwards(panel.left - 42.0, panel.top + 0.5 * panel.height,
                      of_robot ? "x, forward [m]" : "x (map) [m]", kTick);
  canvas.text(panel.left + 0.5 * panel.width, bottom + 33.0,
              of_robot ? "y, left [m]" : "y (map) [m]", kTick);
  canvas.frame_box(box_of(panel), kFaintInk);
}

Box robot_box(const MapPanel& panel) {
  const PixelPosition origin = panel.pixel_of({0.0, 0.0});
  return {origin.x - panel.left - 52.0, origin.y - panel.top - 54.0, 64.0, 66.0};
}

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

void draw_legend_entry(Canvas& canvas, double left, double base, Rgb colour,
                       const std::string& text) {
  const Box swatch{left, base - 10.0, 14.0, 12.0};
  canvas.fill_box(swatch, colour);
  canvas.frame_box(swatch, kFaintInk);
  canvas.text(left + 20.0, base, text, kSmall);
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
  const bool field = params.description.mode == DescriptionMode::kField;
  const std::string grid = "map " + number(params.grid.length) + " m x " +
                           number(params.grid.width) + " m, cells of " +
                           number(params.grid.cell_size) + " m, points below " +
                           number(params.grid.max_height) + " m;  ";
  const std::string stages = field ? field_text(params) : paper_text(params);
  const std::string features =
      "slopes " + fixed(params.classes.slope_min * degrees, 0) + "° to " +
      fixed(params.classes.slope_max * degrees, 0) + "°;  T_ratio " +
      number(params.roughness.t_ratio) + ", T_L " + number(params.roughness.t_l) + " m², T_S " +
      number(params.roughness.t_s) + " m²" +
      (params.slope.method == SlopeMethod::kBeam
           ? std::string(";  slopes by beams")
           : ";  T_q " + number(params.slope.inlier_distance) + " m, T_Inlier " +
                 number(params.slope.inlier_share) + ", MaxIterations " +
                 std::to_string(params.slope.max_iterations));
  const TextStyle style{11.0, false, Align::kLeft, kFaintInk, false};
  const double base = layout.footer_top + 18.0;
  canvas.line(kMargin, layout.footer_top + 0.5, layout.width - kMargin, layout.footer_top + 0.5,
              kFaintInk, 1.0, 0.5);
  canvas.text(kMargin, base, grid + stages, style);
  canvas.text(kMargin, base + 17.0, features, style);
}

void clip_to(Canvas& canvas, const MapPanel& panel) {
  cairo_save(canvas.context());
  cairo_rectangle(canvas.context(), panel.left, panel.top, panel.width, panel.height);
  cairo_clip(canvas.context());
}

void draw_heights(Canvas& canvas, const TopViewLayout& layout, const Description& description,
                  ViewAxes axes) {
  const HeightRange range = robust_range(description.grid);
  const MapPanel& panel = layout.heights;
  if (!range.empty) paint_heights(canvas, panel, description.grid, range);
  draw_grid(canvas, panel, axes);
  clip_to(canvas, panel);
  draw_robot(canvas, panel);
  cairo_restore(canvas.context());
  draw_caption(canvas, panel, layout.left_column, layout.left_column + layout.column_width,
               "Heights: mean of each cell");
  draw_height_key(canvas, layout, range);
}

}  // namespace mrpt_terrain::view
