// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/site_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "canvas.h"
#include "mrpt_terrain/files/atomic_file.h"
#include "mrpt_terrain/view/label_placement.h"
#include "mrpt_terrain/view/palette.h"
#include "mrpt_terrain/view/png_file.h"
#include "mrpt_terrain/view/text.h"

namespace mrpt_terrain::view {
namespace {

constexpr Rgb kInk{34, 34, 34};
constexpr Rgb kFaintInk{105, 105, 105};
constexpr Rgb kWhite{255, 255, 255};
constexpr Rgb kPathColour{214, 39, 120};
constexpr int kLeft = 70;            // pixels, of the panel
constexpr int kTop = 96;             // pixels, of the panel
constexpr int kTableWidth = 250;     // pixels
constexpr int kKeyHeight = 104;      // pixels
constexpr int kLeastHeight = 420;    // pixels, of the picture
constexpr double kRowHeight = 17.0;  // pixels, of the table
constexpr double kTint = 0.6;        // share of the class colour over the relief
constexpr double kLeastSpan = 0.1;   // metres, of the height colours

const TextStyle kSmall{11.5, false, Align::kLeft, kInk, false};
const TextStyle kHead{11.5, true, Align::kLeft, kInk, false};
const TextStyle kTick{11.0, false, Align::kCentre, kFaintInk, false};
const TextStyle kNumber{11.0, true, Align::kCentre, kInk, false};

TextStyle aligned(TextStyle style, Align align) {
  style.align = align;
  return style;
}

struct Pixel {
  double x = 0.0, y = 0.0;
};

/// The part of the picture that shows the site.
struct Panel {
  PlanExtent extent;
  int width, height;

  [[nodiscard]] double scale() const { return width / (extent.x_max - extent.x_min); }
  [[nodiscard]] Pixel pixel_of(Position2 place) const {
    return {kLeft + (place.x - extent.x_min) * scale(), kTop + (extent.y_max - place.y) * scale()};
  }
  [[nodiscard]] Box box() const { return {kLeft, kTop, width * 1.0, height * 1.0}; }
  [[nodiscard]] double bottom() const { return kTop + height; }
  [[nodiscard]] double right() const { return kLeft + width; }
};

/// Heights that the colours span.
struct Span {
  double low = 0.0, high = 0.0;
  [[nodiscard]] double share(double height) const { return (height - low) / (high - low); }
};

/// Of the ground, without the lowest and highest two per cent.
Span height_span(const SitePlan& plan) {
  std::vector<float> known;
  for (std::size_t k = 0; k < plan.heights.values.size(); ++k) {
    const float height = plan.heights.values[k];
    if (!std::isnan(height) && plan.thing.values[k] < 0) known.push_back(height);
  }
  if (known.empty()) return {0.0, kLeastSpan};
  std::sort(known.begin(), known.end());
  const std::size_t cut = known.size() / 50;
  Span span{static_cast<double>(known[cut]), static_cast<double>(known[known.size() - 1 - cut])};
  const double missing = kLeastSpan - (span.high - span.low);
  if (missing > 0.0) {
    span.low -= 0.5 * missing;
    span.high += 0.5 * missing;
  }
  return span;
}

/// Light from the north-west, 45 degrees high: 1 on level ground, 0.45 to 1.2 elsewhere.
double shade(const Raster<float>& heights, int column, int row, double metres_per_pixel) {
  const auto at = [&](int c, int r) {
    return static_cast<double>(
        heights.at(std::clamp(c, 0, heights.width - 1), std::clamp(r, 0, heights.height - 1)));
  };
  const double east = (at(column + 1, row) - at(column - 1, row)) / (2.0 * metres_per_pixel);
  const double north = (at(column, row - 1) - at(column, row + 1)) / (2.0 * metres_per_pixel);
  if (std::isnan(east) || std::isnan(north)) return 1.0;
  const double light = (1.0 + (east - north) * std::sqrt(0.5)) / std::hypot(1.0, east, north);
  return std::clamp(light, 0.45, 1.2);
}

std::uint32_t packed(Rgb colour, double light) {
  const auto channel = [&](std::uint8_t value) {
    return static_cast<std::uint32_t>(std::clamp(std::lround(value * light), 0L, 255L));
  };
  return (channel(colour.r) << 16U) | (channel(colour.g) << 8U) | channel(colour.b);
}

Rgb mixed(Rgb a, Rgb b, double share_of_b) {
  const auto channel = [&](std::uint8_t from, std::uint8_t to) {
    return static_cast<std::uint8_t>(std::lround(from + (to - from) * share_of_b));
  };
  return {channel(a.r, b.r), channel(a.g, b.g), channel(a.b, b.b)};
}

/// The colours of classes are left to the things: ground goes from a dull green to nearly white.
Rgb ground_colour(double share) {
  return mixed({150, 166, 150}, {250, 247, 238}, std::clamp(share, 0.0, 1.0));
}

std::int32_t thing_at(const SitePlan& plan, int column, int row) {
  return plan.thing.at(std::clamp(column, 0, plan.thing.width - 1),
                       std::clamp(row, 0, plan.thing.height - 1));
}

/// Whether the pixel lies on the inner rim of a thing.
bool is_rim(const SitePlan& plan, int column, int row) {
  const std::int32_t own = plan.thing.at(column, row);
  return own >= 0 &&
         (thing_at(plan, column - 1, row) != own || thing_at(plan, column + 1, row) != own ||
          thing_at(plan, column, row - 1) != own || thing_at(plan, column, row + 1) != own);
}

std::uint32_t pixel_colour(const SitePlan& plan, const Span& span, int column, int row,
                           double metres_per_pixel) {
  const float height = plan.heights.at(column, row);
  if (std::isnan(height)) return packed(kUnobservedColour, 1.0);
  Rgb colour = ground_colour(span.share(static_cast<double>(height)));
  const std::int32_t thing = plan.thing.at(column, row);
  if (thing >= 0) {
    const Rgb tint = colour_of(plan.things[static_cast<std::size_t>(thing)].terrain_class);
    if (is_rim(plan, column, row)) return packed(tint, 0.6);
    colour = mixed(colour, tint, kTint);
  }
  return packed(colour, shade(plan.heights, column, row, metres_per_pixel));
}

void paint_site(Canvas& canvas, const SitePlan& plan, const Panel& panel, const Span& span) {
  Raster<std::uint32_t> pixels(panel.width, panel.height);
  for (int row = 0; row < panel.height; ++row) {
    for (int column = 0; column < panel.width; ++column) {
      pixels.at(column, row) = pixel_colour(plan, span, column, row, 1.0 / panel.scale());
    }
  }
  canvas.paint(pixels, kLeft, kTop);
}

std::vector<double> ticks(double low, double high, double step) {
  std::vector<double> result;
  const double slack = 1e-9 * step;
  for (double k = std::ceil((low - slack) / step); k * step <= high + slack; k += 1.0) {
    result.push_back(k * step);
  }
  return result;
}

void draw_grid(Canvas& canvas, const Panel& panel) {
  const double step = round_step(60.0 / panel.scale());
  const int decimals = decimals_of(step);
  for (const double x : ticks(panel.extent.x_min, panel.extent.x_max, step)) {
    const double column = std::round(panel.pixel_of({x, 0.0}).x) - 0.5;
    canvas.line(column, kTop, column, panel.bottom(), kInk, 1.0, 0.12);
    canvas.line(column, panel.bottom(), column, panel.bottom() + 4.0, kFaintInk, 1.0);
    canvas.text(column, panel.bottom() + 16.0, fixed(x, decimals), kTick);
  }
  for (const double y : ticks(panel.extent.y_min, panel.extent.y_max, step)) {
    const double row = std::round(panel.pixel_of({0.0, y}).y) - 0.5;
    canvas.line(kLeft, row, panel.right(), row, kInk, 1.0, 0.12);
    canvas.line(kLeft - 4.0, row, kLeft, row, kFaintInk, 1.0);
    canvas.text(kLeft - 7.0, row + 4.0, fixed(y, decimals), aligned(kTick, Align::kRight));
  }
  canvas.text(kLeft + 0.5 * panel.width, panel.bottom() + 32.0, "x [m]", kTick);
  canvas.text_upwards(kLeft - 44.0, kTop + 0.5 * panel.height, "y [m]", kTick);
  canvas.frame_box(panel.box(), kFaintInk);
}

void draw_scale_bar(Canvas& canvas, const Panel& panel) {
  const double metres = round_step(70.0 / panel.scale());
  const double start = panel.right() - metres * panel.scale();
  const double base = kTop - 10.0;
  canvas.text(start - 8.0, base + 4.0, fixed(metres, decimals_of(metres)) + " m",
              aligned(kSmall, Align::kRight));
  canvas.line(start, base, panel.right(), base, kInk, 2.0);
  canvas.line(start, base - 5.0, start, base + 5.0, kInk, 1.5);
  canvas.line(panel.right(), base - 5.0, panel.right(), base + 5.0, kInk, 1.5);
}

void stroke_path(Canvas& canvas, const SitePlan& plan, const Panel& panel, Rgb colour,
                 double width) {
  cairo_t* context = canvas.context();
  for (const Position2& place : plan.path) {
    const Pixel pixel = panel.pixel_of(place);
    cairo_line_to(context, pixel.x, pixel.y);
  }
  canvas.set_colour(colour);
  cairo_set_line_width(context, width);
  cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
  cairo_stroke(context);
}

/// A triangle that points where the robot looks.
void draw_robot(Canvas& canvas, const SitePlan& plan, const Panel& panel) {
  if (plan.path.empty()) return;
  const Pixel at = panel.pixel_of(plan.path.front());
  cairo_t* context = canvas.context();
  cairo_save(context);
  cairo_translate(context, at.x, at.y);
  cairo_rotate(context, -plan.yaw);
  cairo_move_to(context, 12.0, 0.0);
  cairo_line_to(context, -9.0, 8.0);
  cairo_line_to(context, -5.0, 0.0);
  cairo_line_to(context, -9.0, -8.0);
  cairo_close_path(context);
  cairo_restore(context);
  canvas.set_colour(kPathColour);
  cairo_fill_preserve(context);
  canvas.set_colour(kWhite);
  cairo_set_line_width(context, 1.5);
  cairo_stroke(context);
}

void draw_path(Canvas& canvas, const SitePlan& plan, const Panel& panel) {
  if (plan.path.size() > 1) {
    stroke_path(canvas, plan, panel, kWhite, 4.5);
    stroke_path(canvas, plan, panel, kPathColour, 2.0);
    const Pixel end = panel.pixel_of(plan.path.back());
    canvas.fill_box({end.x - 4.0, end.y - 4.0, 8.0, 8.0}, kPathColour);
    canvas.frame_box({end.x - 4.0, end.y - 4.0, 8.0, 8.0}, kWhite);
  }
  draw_robot(canvas, plan, panel);
}

/// Where a number must not go: the robot and its path.
std::vector<Box> path_boxes(const SitePlan& plan, const Panel& panel) {
  std::vector<Box> boxes;
  for (const Position2& place : plan.path) {
    const Pixel pixel = panel.pixel_of(place);
    const Box box{pixel.x - kLeft - 6.0, pixel.y - kTop - 6.0, 12.0, 12.0};
    if (boxes.empty() || !box.overlaps(boxes.back())) boxes.push_back(box);
  }
  return boxes;
}

/// Pixels that a number would hide: those of things that are not much larger than a number.
Raster<std::uint8_t> small_things(const SitePlan& plan) {
  constexpr int kLargeArea = 1600;  // pixels
  std::vector<int> area(plan.things.size());
  for (const std::int32_t thing : plan.thing.values) {
    if (thing >= 0) ++area[static_cast<std::size_t>(thing)];
  }
  Raster<std::uint8_t> busy(plan.thing.width, plan.thing.height);
  std::transform(plan.thing.values.begin(), plan.thing.values.end(), busy.values.begin(),
                 [&](std::int32_t thing) {
                   const bool small =
                       thing >= 0 && area[static_cast<std::size_t>(thing)] < kLargeArea;
                   return static_cast<std::uint8_t>(small ? 1 : 0);
                 });
  return busy;
}

void draw_numbers(Canvas& canvas, const SitePlan& plan, const Panel& panel) {
  std::vector<LabelRequest> requests;
  for (const PlanThing& thing : plan.things) {
    const Pixel pixel = panel.pixel_of(thing.place);
    const double width = std::ceil(canvas.text_width(std::to_string(thing.id), kNumber)) + 7.0;
    requests.push_back({pixel.x - kLeft, pixel.y - kTop, width, 15.0});
  }
  const Raster<std::uint8_t> busy = small_things(plan);
  const auto places = place_labels(requests, busy, path_boxes(plan, panel));
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (!places[k]) continue;
    const Box box{places[k]->left + kLeft, places[k]->top + kTop, places[k]->width, 15.0};
    const double x = box.left + 0.5 * box.width, y = box.top + 0.5 * box.height;
    const Pixel thing = panel.pixel_of(plan.things[k].place);
    if (std::hypot(x - thing.x, y - thing.y) > 8.0) {
      canvas.line(x, y, thing.x, thing.y, kWhite, 3.0, 0.8);
      canvas.line(x, y, thing.x, thing.y, kInk, 1.0);
    }
    canvas.fill_box(box, kWhite);
    canvas.frame_box(box, colour_of(plan.things[k].terrain_class));
    canvas.text(x, box.top + box.height - 4.0, std::to_string(plan.things[k].id), kNumber);
  }
}

void draw_table(Canvas& canvas, const SitePlan& plan, double left, double bottom) {
  const double columns[] = {left + 24.0, left + 36.0, left + kTableWidth - 24.0};
  double base = kTop + 12.0;
  canvas.text(columns[0], base, "id", aligned(kHead, Align::kRight));
  canvas.text(columns[1], base, "thing", kHead);
  canvas.text(columns[2], base, "height [m]", aligned(kHead, Align::kRight));
  const auto rows = static_cast<std::size_t>(std::max(1.0, (bottom - base) / kRowHeight - 1.0));
  const std::size_t shown = plan.things.size() > rows ? rows - 1 : plan.things.size();
  for (std::size_t k = 0; k < shown; ++k) {
    const PlanThing& thing = plan.things[k];
    base += kRowHeight;
    const Box swatch{columns[1], base - 9.5, 11.0, 11.0};
    canvas.fill_box(swatch, colour_of(thing.terrain_class));
    canvas.frame_box(swatch, kFaintInk);
    canvas.text(columns[0], base, std::to_string(thing.id), aligned(kSmall, Align::kRight));
    canvas.text(columns[1] + 17.0, base, thing.type, kSmall);
    canvas.text(columns[2], base, fixed(thing.height, 2), aligned(kSmall, Align::kRight));
  }
  if (shown == plan.things.size()) return;
  canvas.text(columns[1], base + kRowHeight,
              "and " + std::to_string(plan.things.size() - shown) + " more", kSmall);
}

void draw_height_key(Canvas& canvas, double left, double top, const Span& span) {
  const Box bar{left + 70.0, top, 260.0, 14.0};
  for (int column = 0; column < static_cast<int>(bar.width); ++column) {
    canvas.fill_box({bar.left + column, bar.top, 1.0, bar.height},
                    ground_colour((column + 0.5) / bar.width));
  }
  canvas.frame_box(bar, kFaintInk);
  canvas.text(left, bar.top + 11.5, "height [m]", kSmall);
  const double step = round_step(55.0 * (span.high - span.low) / bar.width);
  for (const double height : ticks(span.low, span.high, step)) {
    const double column = bar.left + span.share(height) * bar.width;
    canvas.line(column, bar.top + bar.height, column, bar.top + bar.height + 4.0, kFaintInk, 1.0);
    canvas.text(column, bar.top + bar.height + 16.0, fixed(height, decimals_of(step)), kTick);
  }
}

void draw_class_key(Canvas& canvas, const SitePlan& plan, double left, double base) {
  for (const TerrainClass kind : {TerrainClass::kObstacle, TerrainClass::kSlope,
                                  TerrainClass::kPothole, TerrainClass::kOther}) {
    const auto count = std::count_if(plan.things.begin(), plan.things.end(),
                                     [&](const PlanThing& t) { return t.terrain_class == kind; });
    const std::string text = std::string(name_of(kind)) + ": " + std::to_string(count);
    const Box swatch{left, base - 10.0, 14.0, 12.0};
    canvas.fill_box(swatch, colour_of(kind));
    canvas.frame_box(swatch, kFaintInk);
    canvas.text(left + 19.0, base, text, kSmall);
    left += 19.0 + canvas.text_width(text, kSmall) + 16.0;
  }
  canvas.line(left, base - 4.0, left + 22.0, base - 4.0, kPathColour, 2.0);
  canvas.text(left + 28.0, base, "robot", kSmall);
}

void draw_frame(Canvas& canvas, const SitePlan& plan) {
  canvas.text(24.0, 34.0, plan.title, {19.0, true, Align::kLeft, kInk, false});
  canvas.text(24.0, 56.0, plan.subtitle, {12.5, false, Align::kLeft, kInk, false});
}

}  // namespace

PanelSize plan_panel_size(const PlanExtent& extent, int max_width, int max_height) {
  const double width = extent.x_max - extent.x_min;
  const double height = extent.y_max - extent.y_min;
  const double scale = std::min(max_width / width, max_height / height);
  return {std::max(1, static_cast<int>(std::lround(width * scale))),
          std::max(1, static_cast<int>(std::lround(height * scale)))};
}

void write_site_plan(const std::string& file, const SitePlan& plan) {
  const Panel panel{plan.extent, plan.heights.width, plan.heights.height};
  const int width = std::max(kLeft + panel.width, 560) + kTableWidth;
  const int height = std::max(kTop + panel.height + kKeyHeight, kLeastHeight);
  Canvas canvas(width, height);
  const Span span = height_span(plan);
  draw_frame(canvas, plan);
  paint_site(canvas, plan, panel, span);
  draw_grid(canvas, panel);
  draw_scale_bar(canvas, panel);
  cairo_save(canvas.context());
  cairo_rectangle(canvas.context(), kLeft, kTop, panel.width, panel.height);
  cairo_clip(canvas.context());
  draw_path(canvas, plan, panel);
  draw_numbers(canvas, plan, panel);
  cairo_restore(canvas.context());
  draw_table(canvas, plan, width - kTableWidth, height - 20.0);
  draw_height_key(canvas, 24.0, panel.bottom() + 52.0, span);
  draw_class_key(canvas, plan, 24.0, panel.bottom() + 96.0);
  files::write_atomically(file, png_bytes(canvas.pixels()));
}

}  // namespace mrpt_terrain::view
