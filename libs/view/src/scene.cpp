// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/view/scene.h"

#include <mrpt/opengl/CGridPlaneXY.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/opengl/stock_objects.h>

#include <algorithm>
#include <stdexcept>

#include "mrpt_terrain/files/atomic_file.h"
#include "mrpt_terrain/view/scene_objects.h"
#include "mrpt_terrain/view/text.h"

namespace mrpt_terrain::view {
namespace {

using mrpt::img::TColor;

mrpt::opengl::CGridPlaneXY::Ptr make_grid(const GridGeometry& geometry) {
  const auto x = static_cast<float>(geometry.half_length());
  const auto y = static_cast<float>(geometry.half_width());
  const auto step = static_cast<float>(round_step(std::max(x, y) / 10.0));
  auto grid = mrpt::opengl::CGridPlaneXY::Create(-x, x, -y, y, 0.0F, step);
  grid->setName("grid");
  grid->setColor_u8(TColor(150, 150, 150));
  return grid;
}

mrpt::opengl::CSetOfObjects::Ptr make_robot(const GridGeometry& geometry) {
  const double extent = std::max(geometry.length(), geometry.width());
  const auto size = static_cast<float>(std::clamp(0.04 * extent, 0.2, 2.0));
  auto robot = mrpt::opengl::stock_objects::CornerXYZSimple(size, 4.0F);
  robot->setName("robot");
  return robot;
}

void place_camera(mrpt::opengl::COpenGLScene& scene, const GridGeometry& geometry) {
  auto& camera = scene.getViewport()->getCamera();
  camera.setAzimuthDegrees(-180.0F);
  camera.setElevationDegrees(40.0F);
  camera.setPointingAt(0.1F * static_cast<float>(geometry.length()), 0.0F, 0.0F);
  camera.setZoomDistance(static_cast<float>(0.9 * std::max(geometry.length(), geometry.width())));
}

}  // namespace

mrpt::opengl::COpenGLScene::Ptr make_scene(const Description& description, const PointsView& points,
                                           const SceneOptions& options) {
  const GridGeometry& geometry = description.grid.geometry;
  auto scene = mrpt::opengl::COpenGLScene::Create();
  scene->getViewport()->setCustomBackgroundColor({0.97F, 0.97F, 0.97F});
  place_camera(*scene, geometry);
  scene->insert(make_grid(geometry));
  scene->insert(make_robot(geometry));
  if (options.cells) {
    scene->insert(make_cells(description.grid, height_colours(description.grid)));
  }
  scene->insert(make_points(description, points));
  scene->insert(make_clusters(description, options.max_boxes, options.max_labels));
  return scene;
}

void write_scene(const std::string& file, const Description& description, const PointsView& points,
                 const SceneOptions& options) {
  files::write_atomically(file, [&](const std::string& part_file) {
    const auto scene = make_scene(description, points, options);
    if (!scene->saveToFile(part_file)) throw std::runtime_error("the scene could not be stored");
  });
}

}  // namespace mrpt_terrain::view
