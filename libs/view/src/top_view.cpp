// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/top_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "mrpt_terrain/files/atomic_file.h"
#include "mrpt_terrain/view/cell_raster.h"
#include "mrpt_terrain/view/cluster_order.h"
#include "mrpt_terrain/view/label_placement.h"
#include "mrpt_terrain/view/palette.h"
#include "mrpt_terrain/view/png_file.h"
#include "mrpt_terrain/view/scan_record.h"
#include "mrpt_terrain/view/text.h"
#include "top_view_parts.h"

namespace mrpt_terrain::view {
namespace {

const TextStyle kNumber{11.0, true, Align::kCentre, kInk, false};

void paint_kinds(Canvas& canvas, const MapPanel& panel, const Raster<CellKind>& kinds,
                 const ElevationGrid& grid, const TopViewOptions& options) {
  Raster<std::uint32_t> pixels(panel.width, panel.height);
  std::transform(kinds.values.begin(), kinds.values.end(), pixels.values.begin(),
                 [](CellKind kind) { return packed(colour_of(kind)); });
  paint_unseen(grid, options, pixels);
  canvas.paint(pixels, panel.left, panel.top);
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

NumberLabel make_label(Canvas& canvas, const std::string& text, Rgb colour, PixelPosition place) {
  NumberLabel label{text, colour, {place.x, place.y, 0.0, 15.0}};
  label.request.width = std::ceil(canvas.text_width(text, kNumber)) + 7.0;
  return label;
}

/// Clusters that are holes: those have labels of their own.
std::vector<bool> clusters_of_holes(const Description& description) {
  std::vector<bool> result(description.things.size(), false);
  for (const HoleDescription& hole : description.holes) {
    const std::int32_t cluster = cluster_of(description, hole);
    if (cluster != kNoCluster) result[static_cast<std::size_t>(cluster)] = true;
  }
  return result;
}

/// Holes first, because they are small and matter; then clusters, the largest first.
std::vector<NumberLabel> make_labels(Canvas& canvas, const MapPanel& panel,
                                     const Description& description, std::size_t at_most) {
  std::vector<NumberLabel> labels;
  for (std::size_t k = 0; k < std::min(description.holes.size(), at_most); ++k) {
    const HoleDescription& hole = description.holes[k];
    const std::string what =
        hole.depth > 0.0 ? fixed(100.0 * hole.depth, 0) + " cm" : std::string(name_of(hole.kind));
    const std::string text = "h" + std::to_string(k) + " " + what;
    labels.push_back(make_label(canvas, text, kPotholeColour, panel.pixel_of(hole.centre)));
  }
  const std::vector<bool> holes = clusters_of_holes(description);
  for (const std::size_t cluster : largest_clusters(description, at_most)) {
    if (holes[cluster]) continue;
    labels.push_back(make_label(canvas, std::to_string(cluster),
                                colour_of(description.things[cluster].terrain_class),
                                panel.pixel_of(anchor_of(description, cluster))));
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

void draw_legend(Canvas& canvas, const TopViewLayout& layout, const Description& description,
                 const TopViewOptions& options) {
  const DescriptionCounts counts = count(description);
  const auto clusters = [&](TerrainClass kind) {
    return std::string(name_of(kind)) + ": " +
           grouped(counts.clusters[static_cast<std::size_t>(kind)]);
  };
  const double first = layout.key_top + 12.0;
  const double second = first + 22.0;
  const double left = layout.right_column;
  const double width = layout.column_width;
  canvas.text(left, first, "clusters", kSmall);
  canvas.text(left, second, "cells", kSmall);
  const double indent = left + 64.0;
  const double quarter = (width - 64.0) / 4.0;
  draw_legend_entry(canvas, indent, first, colour_of(CellKind::kObstacle),
                    clusters(TerrainClass::kObstacle));
  draw_legend_entry(canvas, indent + quarter, first, colour_of(CellKind::kSlope),
                    clusters(TerrainClass::kSlope));
  draw_legend_entry(canvas, indent + 2.0 * quarter, first, colour_of(CellKind::kPothole),
                    clusters(TerrainClass::kPothole));
  draw_legend_entry(canvas, indent + 3.0 * quarter, first, colour_of(CellKind::kOther),
                    clusters(TerrainClass::kOther));
  draw_legend_entry(canvas, indent, second, colour_of(CellKind::kGround),
                    "ground: " + grouped(counts.ground_cells));
  draw_legend_entry(canvas, indent + quarter + 10.0, second, colour_of(CellKind::kDropped),
                    "in " + grouped(counts.dropped_groups) +
                        (counts.dropped_groups == 1 ? " group" : " groups") + " too small");
  const double third = second + 22.0;
  canvas.text(left, third, "not seen", kSmall);
  draw_unseen_legend(canvas, indent, third, width - 64.0, description.grid, options);
}

void draw_classes(Canvas& canvas, const TopViewLayout& layout, const Description& description,
                  const TopViewOptions& options) {
  const MapPanel& panel = layout.classes;
  const auto kinds = kind_raster(description, panel.width, panel.height);
  paint_kinds(canvas, panel, kinds, description.grid, options);
  draw_grid(canvas, panel, options.axes);
  clip_to(canvas, panel);
  draw_robot(canvas, panel);
  draw_numbers(canvas, panel, description, kinds, options.max_labels);
  cairo_restore(canvas.context());
  draw_caption(canvas, panel, layout.right_column, layout.right_column + layout.column_width,
               description.holes.empty() ? "Classes of clusters"
                                         : "Classes of clusters; holes (h) with their depth");
  draw_legend(canvas, layout, description, options);
}

}  // namespace

void write_top_view(const std::string& file, const Description& description,
                    const TopViewOptions& options) {
  const TopViewLayout layout =
      top_view_layout(description.grid.geometry, options.max_width, options.max_height);
  Canvas canvas(layout.width, layout.height);
  draw_title(canvas, layout, description, options);
  draw_heights(canvas, layout, description, options.axes);
  draw_classes(canvas, layout, description, options);
  draw_footer(canvas, layout, options.params);
  files::write_atomically(file, png_bytes(canvas.pixels()));
}

}  // namespace mrpt_terrain::view
