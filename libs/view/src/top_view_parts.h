// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "canvas.h"
#include "mrpt_terrain/view/palette.h"
#include "mrpt_terrain/view/raster.h"
#include "mrpt_terrain/view/top_view.h"
#include "mrpt_terrain/view/top_view_layout.h"

/// \file
/// What views from above have in common: title, footer, the panel of heights, and the frame of a
/// panel with its axes, robot and caption.
namespace mrpt_terrain::view {

inline constexpr Rgb kInk{34, 34, 34};
inline constexpr Rgb kFaintInk{105, 105, 105};
inline constexpr Rgb kWhite{255, 255, 255};

inline const TextStyle kSmall{11.5, false, Align::kLeft, kInk, false};
inline const TextStyle kTick{11.0, false, Align::kCentre, kFaintInk, false};

[[nodiscard]] inline std::uint32_t packed(Rgb colour) {
  return (std::uint32_t{colour.r} << 16U) | (std::uint32_t{colour.g} << 8U) | colour.b;
}

void draw_title(Canvas& canvas, const TopViewLayout& layout, const Description& description,
                const TopViewOptions& options);
void draw_footer(Canvas& canvas, const TopViewLayout& layout, const DescriptionParams& params);
/// The left panel with caption and colour scale.
void draw_heights(Canvas& canvas, const TopViewLayout& layout, const Description& description,
                  ViewAxes axes);

/// Whether the options tell why cells of a grid were not observed.
[[nodiscard]] bool tells_unseen(const ElevationGrid& grid, const TopViewOptions& options);
/// Colours of the reasons over the pixels that show `kUnobservedColour`, if they are told.
void paint_unseen(const ElevationGrid& grid, const TopViewOptions& options,
                  Raster<std::uint32_t>& pixels);
/// A row of the legend: cells that were not observed by reason, or all of them.
void draw_unseen_legend(Canvas& canvas, double left, double base, double width,
                        const ElevationGrid& grid, const TopViewOptions& options);

/// The edge of a panel, and the robot as a dot.
void draw_frame(Canvas& canvas, const MapPanel& panel);

/// Lines of the grid over what was painted, and the axes.
void draw_grid(Canvas& canvas, const MapPanel& panel, ViewAxes axes);
/// Until cairo_restore, nothing is drawn outside the panel.
void clip_to(Canvas& canvas, const MapPanel& panel);
/// A triangle that points along x, and the axes.
void draw_robot(Canvas& canvas, const MapPanel& panel);
/// Pixels of the panel that the robot and its axes take.
[[nodiscard]] Box robot_box(const MapPanel& panel);
/// Caption and scale bar above a column from `left` to `right`.
void draw_caption(Canvas& canvas, const MapPanel& panel, int left, int right,
                  const std::string& caption);
void draw_legend_entry(Canvas& canvas, double left, double base, Rgb colour,
                       const std::string& text);

}  // namespace mrpt_terrain::view
