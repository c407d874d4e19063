// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/scene_objects.h"

#include <mrpt/math/TPose3D.h>
#include <mrpt/opengl/CBox.h>
#include <mrpt/opengl/CText3D.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "mrpt_terrain/view/cell_raster.h"
#include "mrpt_terrain/view/cluster_order.h"

namespace mrpt_terrain::view {
namespace {

using mrpt::img::TColor;
using mrpt::math::TPoint3Df;

constexpr double kTextYaw = 2.356194490192345;  // 135 degrees
constexpr double kTextAspect = 0.8;             // advance of a digit over the size of the font
constexpr float kSurfaceDrop = 0.02F;           // metres; else it would hide half of its points

TColor to_mrpt(Rgb colour) { return {colour.r, colour.g, colour.b}; }

/// Half way to white, so that the points stand out against the surface.
Rgb pale(Rgb colour) {
  const auto mix = [](std::uint8_t channel) {
    return static_cast<std::uint8_t>((channel + 255) / 2);
  };
  return {mix(colour.r), mix(colour.g), mix(colour.b)};
}

/// Mean height of a cell, or of those around its corners that are observed.
class Surface {
 public:
  explicit Surface(const ElevationGrid& grid) : grid_(grid) {}

  /// Corner (l, w) is the one with the smallest x and y of that cell. Corners average the cells of
  /// similar height around them, so that the ground is smooth and walls stay steps.
  [[nodiscard]] float corner(CellIndex corner, float height) const {
    const float tolerance = static_cast<float>(grid_.geometry.cell_size());
    float sum = 0.0F;
    int n = 0;
    for (const CellIndex cell :
         {CellIndex{corner.l - 1, corner.w - 1}, CellIndex{corner.l - 1, corner.w},
          CellIndex{corner.l, corner.w - 1}, corner}) {
      const Slot slot = grid_.slot_at(cell);
      if (slot == kUnobserved) continue;
      const float other = grid_.h_mean[static_cast<std::size_t>(slot)];
      if (std::abs(other - height) > tolerance) continue;
      sum += other;
      ++n;
    }
    return n == 0 ? height : sum / static_cast<float>(n);
  }

 private:
  const ElevationGrid& grid_;
};

void add_cell(const ElevationGrid& grid, std::size_t slot, TColor colour,
              std::vector<mrpt::opengl::TTriangle>& triangles) {
  const CellIndex cell = grid.geometry.index_of(grid.cell[slot]);
  const Surface surface(grid);
  const double half = 0.5 * grid.geometry.cell_size();
  const Position2 centre = grid.geometry.centre_of(cell);
  const auto corner = [&](int dl, int dw) {
    return TPoint3Df(static_cast<float>(centre.x + (2 * dl - 1) * half),
                     static_cast<float>(centre.y + (2 * dw - 1) * half),
                     surface.corner({cell.l + dl, cell.w + dw}, grid.h_mean[slot]) - kSurfaceDrop);
  };
  const TPoint3Df a = corner(0, 0);
  const TPoint3Df b = corner(1, 0);
  const TPoint3Df c = corner(1, 1);
  const TPoint3Df d = corner(0, 1);
  for (auto triangle : {mrpt::opengl::TTriangle(a, b, c), mrpt::opengl::TTriangle(a, c, d)}) {
    triangle.setColor(colour);
    triangles.push_back(triangle);
  }
}

mrpt::opengl::CBox::Ptr make_box(const ClusterDescription& thing) {
  auto box = mrpt::opengl::CBox::Create();
  box->setBoxCorners({thing.min_corner.x, thing.min_corner.y, thing.h_min},
                     {thing.max_corner.x, thing.max_corner.y, thing.h_max});
  box->setWireframe(true);
  box->setLineWidth(2.0F);
  // The lines of a wireframe have the colour of the border, whatever the object's colour is.
  box->setColor_u8(to_mrpt(colour_of(thing.terrain_class)));
  box->setBoxBorderColor(to_mrpt(colour_of(thing.terrain_class)));
  return box;
}

/// The number lies flat on top of the box, so that it is never seen mirrored from above, and reads
/// upright from the viewpoint with which SceneViewer3D starts (azimuth 45 degrees).
mrpt::opengl::CText3D::Ptr make_label(const ClusterDescription& thing, std::size_t number,
                                      double size) {
  const std::string text = std::to_string(number);
  auto label = mrpt::opengl::CText3D::Create(text, "sans", static_cast<float>(size));
  const double to_start = -0.5 * kTextAspect * size * static_cast<double>(text.size());
  label->setPose(mrpt::math::TPose3D(
      0.5 * (thing.min_corner.x + thing.max_corner.x) + to_start * std::cos(kTextYaw),
      0.5 * (thing.min_corner.y + thing.max_corner.y) + to_start * std::sin(kTextYaw),
      thing.h_max + 0.1 * size, kTextYaw, 0.0, 0.0));
  label->setColor_u8(to_mrpt(colour_of(thing.terrain_class)));
  return label;
}

}  // namespace

CellColours height_colours(const ElevationGrid& grid) {
  const HeightRange range = robust_range(grid);
  return [&grid, range](std::size_t slot) {
    const double height = grid.h_mean[slot];
    return height_colour((height - range.low) / (range.high - range.low));
  };
}

mrpt::opengl::CPointCloudColoured::Ptr make_points(const Description& description,
                                                   const PointsView& points) {
  auto cloud = mrpt::opengl::CPointCloudColoured::Create();
  cloud->setName("points");
  cloud->setPointSize(2.0F);
  cloud->reserve(points.size);
  for (std::size_t k = 0; k < points.size; ++k) {
    const TPoint3Df point(points.x[k], points.y[k], points.z[k]);
    if (!std::isfinite(point.x) || !std::isfinite(point.y) || !std::isfinite(point.z)) continue;
    const Rgb colour =
        colour_of(description.labels.terrain_class[k], description.labels.support[k]);
    cloud->insertPoint({point.x, point.y, point.z, colour.r, colour.g, colour.b, 255});
  }
  return cloud;
}

mrpt::opengl::CSetOfTriangles::Ptr make_cells(const ElevationGrid& grid,
                                              const CellColours& colours) {
  std::vector<mrpt::opengl::TTriangle> triangles;
  triangles.reserve(2 * grid.observed());
  for (std::size_t slot = 0; slot < grid.observed(); ++slot) {
    add_cell(grid, slot, to_mrpt(pale(colours(slot))), triangles);
  }
  auto cells = mrpt::opengl::CSetOfTriangles::Create();
  cells->setName("cells");
  cells->insertTriangles(triangles);
  return cells;
}

mrpt::opengl::CSetOfObjects::Ptr make_clusters(const Description& description,
                                               std::size_t max_boxes, std::size_t max_labels) {
  auto clusters = mrpt::opengl::CSetOfObjects::Create();
  clusters->setName("clusters");
  const GridGeometry& geometry = description.grid.geometry;
  const double size = 0.012 * std::max(geometry.length(), geometry.width());
  std::size_t labels = 0;
  for (const std::size_t number : largest_clusters(description, max_boxes)) {
    const ClusterDescription& thing = description.things[number];
    clusters->insert(make_box(thing));
    if (labels++ >= max_labels) continue;
    clusters->insert(make_label(thing, number, size));
  }
  return clusters;
}

}  // namespace mrpt_terrain::view
