// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cairo.h>

#include <cstdint>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>

#include "mrpt_terrain/view/label_placement.h"
#include "mrpt_terrain/view/palette.h"
#include "mrpt_terrain/view/raster.h"

namespace mrpt_terrain::view {

enum class Align { kLeft, kCentre, kRight };

/// How a text is drawn.
struct TextStyle {
  double size = 12.0;  ///< pixels
  bool bold = false;
  Align align = Align::kLeft;
  Rgb colour{34, 34, 34};
  bool halo = false;  ///< white rim, for text over cells
};

/// A picture to draw on; pixels from the upper left corner.
class Canvas {
 public:
  Canvas(int width, int height)
      : surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height)),
        context_(cairo_create(surface_.get())) {
    check(cairo_surface_status(surface_.get()));
    set_colour({255, 255, 255});
    cairo_paint(context());
  }

  [[nodiscard]] cairo_t* context() const { return context_.get(); }

  void set_colour(Rgb colour, double opacity = 1.0) {
    cairo_set_source_rgba(context(), colour.r / 255.0, colour.g / 255.0, colour.b / 255.0, opacity);
  }

  void fill_box(const Box& box, Rgb colour, double opacity = 1.0) {
    set_colour(colour, opacity);
    cairo_rectangle(context(), box.left, box.top, box.width, box.height);
    cairo_fill(context());
  }

  /// One pixel wide, on whole pixels.
  void frame_box(const Box& box, Rgb colour) {
    set_colour(colour);
    cairo_set_line_width(context(), 1.0);
    cairo_rectangle(context(), box.left + 0.5, box.top + 0.5, box.width - 1.0, box.height - 1.0);
    cairo_stroke(context());
  }

  void line(double x0, double y0, double x1, double y1, Rgb colour, double width,
            double opacity = 1.0) {
    set_colour(colour, opacity);
    cairo_set_line_width(context(), width);
    cairo_move_to(context(), x0, y0);
    cairo_line_to(context(), x1, y1);
    cairo_stroke(context());
  }

  [[nodiscard]] double text_width(const std::string& text, const TextStyle& style) {
    select_font(style);
    cairo_text_extents_t extents;
    cairo_text_extents(context(), text.c_str(), &extents);
    return extents.x_advance;
  }

  /// \param y of the base line
  void text(double x, double y, const std::string& text, const TextStyle& style) {
    const double width = text_width(text, style);
    if (style.align == Align::kCentre) x -= 0.5 * width;
    if (style.align == Align::kRight) x -= width;
    cairo_move_to(context(), x, y);
    if (style.halo) {
      cairo_text_path(context(), text.c_str());
      set_colour({255, 255, 255}, 0.85);
      cairo_set_line_width(context(), 3.0);
      cairo_set_line_join(context(), CAIRO_LINE_JOIN_ROUND);
      cairo_stroke(context());
      cairo_move_to(context(), x, y);
    }
    set_colour(style.colour);
    cairo_show_text(context(), text.c_str());
    cairo_new_path(context());
  }

  /// Upwards, centred about (x, y).
  void text_upwards(double x, double y, const std::string& text, TextStyle style) {
    style.align = Align::kCentre;
    cairo_save(context());
    cairo_translate(context(), x, y);
    cairo_rotate(context(), -0.5 * 3.14159265358979323846);
    this->text(0.0, 0.0, text, style);
    cairo_restore(context());
  }

  /// Copies pixels 0xRRGGBB to a place.
  void paint(const Raster<std::uint32_t>& pixels, int left, int top) {
    cairo_surface_flush(surface_.get());
    unsigned char* data = cairo_image_surface_get_data(surface_.get());
    const int stride = cairo_image_surface_get_stride(surface_.get());
    for (int row = 0; row < pixels.height; ++row) {
      std::memcpy(data + static_cast<std::ptrdiff_t>(top + row) * stride + left * 4,
                  &pixels.at(0, row), static_cast<std::size_t>(pixels.width) * 4);
    }
    cairo_surface_mark_dirty(surface_.get());
  }

  /// All pixels, 0x00RRGGBB. Throws std::runtime_error when any drawing before went wrong.
  [[nodiscard]] Raster<std::uint32_t> pixels() {
    check(cairo_status(context()));
    cairo_surface_flush(surface_.get());
    const unsigned char* data = cairo_image_surface_get_data(surface_.get());
    const int stride = cairo_image_surface_get_stride(surface_.get());
    Raster<std::uint32_t> result(cairo_image_surface_get_width(surface_.get()),
                                 cairo_image_surface_get_height(surface_.get()));
    for (int row = 0; row < result.height; ++row) {
      std::memcpy(&result.at(0, row), data + static_cast<std::ptrdiff_t>(row) * stride,
                  static_cast<std::size_t>(result.width) * 4);
    }
    return result;
  }

 private:
  struct Deleter {
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
    void operator()(cairo_t* context) const { cairo_destroy(context); }
  };

  static void check(cairo_status_t status) {
    if (status != CAIRO_STATUS_SUCCESS) throw std::runtime_error(cairo_status_to_string(status));
  }

  void select_font(const TextStyle& style) {
    cairo_select_font_face(context(), "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                           style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(context(), style.size);
  }

  std::unique_ptr<cairo_surface_t, Deleter> surface_;
  std::unique_ptr<cairo_t, Deleter> context_;
};

}  // namespace mrpt_terrain::view
