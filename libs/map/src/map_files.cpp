// SPDX-License-Identifier: BSD-3-Clause
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/stock_objects.h>
#include <octomap/OcTree.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "map_state.h"
#include "mrpt_terrain/files/atomic_file.h"
#include "mrpt_terrain/view/cluster_order.h"
#include "mrpt_terrain/view/cost_view.h"
#include "mrpt_terrain/view/text.h"
#include "mrpt_terrain/view/top_view.h"

namespace mrpt_terrain {
namespace {

using view::shortest;

constexpr double kDegrees = 180.0 / 3.14159265358979323846;

void save_scene(const CTerrainMap& map, const std::string& file) {
  files::write_atomically(file, [&](const std::string& part_file) {
    mrpt::opengl::COpenGLScene scene;
    scene.getViewport()->setCustomBackgroundColor({0.97F, 0.97F, 0.97F});
    auto objects = mrpt::opengl::CSetOfObjects::Create();
    draw(map, map.params().render, *objects);
    auto robot = mrpt::opengl::stock_objects::CornerXYZSimple(1.0F, 4.0F);
    robot->setName("robot");
    const TerrainSnapshotPtr now = map.snapshot();
    robot->setPose(pose_of(now->T_map_robot));
    scene.insert(objects);
    scene.insert(robot);
    const Eigen::Vector3f at = now->T_map_window.translation().cast<float>();
    auto& camera = scene.getViewport()->getCamera();
    camera.setPointingAt(at.x(), at.y(), at.z());
    camera.setAzimuthDegrees(-135.0F);
    camera.setElevationDegrees(40.0F);
    camera.setZoomDistance(static_cast<float>(0.9 * now->description.grid.geometry.length() + 1.0));
    if (!scene.saveToFile(part_file)) throw std::runtime_error("the scene could not be stored");
  });
}

/// What octomap's `write` and `writeBinaryConst` put before the nodes; those talk on standard
/// error.
std::string octree_header(const octomap::OcTree& tree, const std::string& title) {
  std::ostringstream out;
  out << title
      << "\n# (feel free to add / change comments, but leave the first line as it is!)\n#\nid "
      << tree.getTreeType() << "\nsize " << tree.size() << "\nres " << tree.getResolution()
      << "\ndata\n";
  return out.str();
}

void save_octree(const octomap::OcTree& tree, const std::string& prefix) {
  files::write_atomically(
      prefix + ".ot", octree_header(tree, "# Octomap OcTree file") + OctreeHalf::bytes_of(tree));
  std::ostringstream binary;
  tree.writeBinaryData(binary);
  files::write_atomically(prefix + ".bt",
                          octree_header(tree, "# Octomap OcTree binary file") + binary.str());
}

/// Costs in percent over an axis-parallel rectangle of the map, the upper left cell first.
struct CostImage {
  int width = 0;
  int height = 0;
  Position2 corner;  ///< lower left, metres
  double cell_size = 0.0;
  std::vector<unsigned char> pixels;
};

unsigned char per_cent(double share) {
  return static_cast<unsigned char>(std::lround(100.0 * std::min(share, 1.0)));
}

/// \param part the part of the costs; none: the costs
CostImage cost_image(const TerrainSnapshot& snapshot, std::optional<CostPart> part = {}) {
  constexpr unsigned char kUnknown = 255;
  const GridGeometry& geometry = snapshot.description.grid.geometry;
  CostImage image;
  image.cell_size = geometry.cell_size();
  if (snapshot.revision == 0) return image;
  const double reach = std::hypot(geometry.half_length(), geometry.half_width());
  image.width = image.height = static_cast<int>(std::ceil(2.0 * reach / image.cell_size));
  const Eigen::Vector3d centre = snapshot.T_map_window.translation();
  image.corner = {centre.x() - 0.5 * image.width * image.cell_size,
                  centre.y() - 0.5 * image.height * image.cell_size};
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      const double x = image.corner.x + (column + 0.5) * image.cell_size;
      const double y = image.corner.y + (image.height - row - 0.5) * image.cell_size;
      const Cost cost = snapshot.cost_at(x, y);
      // The cost of not knowing is known where nothing else is.
      const bool known =
          is_known(cost) || (part == CostPart::kUnknown && cost.status == CostStatus::kUnknown);
      image.pixels.push_back(known ? per_cent(part ? cost.parts.of(*part) : cost.cost) : kUnknown);
    }
  }
  return image;
}

/// \param name of the layer
void save_cost_map(const CostImage& image, const std::string& prefix, const std::string& name) {
  std::string pgm = "P5\n# per cent of lethal; 255: unknown\n" + std::to_string(image.width) + " " +
                    std::to_string(image.height) + "\n255\n";
  pgm.append(image.pixels.begin(), image.pixels.end());
  files::write_atomically(prefix + name + ".pgm", pgm);
  // In mode "raw" map_server takes 0 to 100 as they are, and everything else for unknown.
  files::write_atomically(
      prefix + name + ".yaml",
      "image: " + view::base_name(prefix) + name + ".pgm\nmode: raw\nresolution: " +
          shortest(image.cell_size) + "\norigin: [" + shortest(image.corner.x) + ", " +
          shortest(image.corner.y) + ", 0]\nnegate: 0\noccupied_thresh: 0.99\nfree_thresh: 0.01\n");
}

/// One map per part of the costs that is known, where there are more than those of the grid.
void save_layers(const TerrainSnapshot& snapshot, const std::string& prefix) {
  if (snapshot.revision == 0 || !snapshot.costs().has(CostPart::kObstacle)) return;
  for (const auto& entry : enum_names(CostPart{})) {
    save_cost_map(cost_image(snapshot, entry.value), prefix, std::string("_cost_") + entry.name);
  }
}

void save_holes(const TerrainSnapshot& snapshot, const std::string& file) {
  std::string csv = "hole,kind,cluster,x,y,z,length,width,depth,points,rings,confidence\n";
  const Description& description = snapshot.description;
  for (std::size_t k = 0; k < description.holes.size(); ++k) {
    const HoleDescription& hole = description.holes[k];
    const std::int32_t cluster = view::cluster_of(description, hole);
    const double z =
        hole.slot < 0
            ? 0.0
            : static_cast<double>(description.grid.h_mean[static_cast<std::size_t>(hole.slot)]);
    const Eigen::Vector3d at =
        snapshot.T_map_window * Eigen::Vector3d(hole.centre.x, hole.centre.y, z);
    csv += std::to_string(k) + "," + std::string(name_of(hole.kind)) + ",";
    csv += cluster == kNoCluster ? "" : std::to_string(cluster);
    for (const double value :
         {at.x(), at.y(), at.z(), hole.length, hole.width, hole.depth,
          static_cast<double>(hole.points), static_cast<double>(hole.rings), hole.confidence}) {
      csv += "," + shortest(value);
    }
    csv += "\n";
  }
  files::write_atomically(file, csv);
}

std::string line_of(const ClusterView& cluster, std::size_t number) {
  const ClusterDescription& thing = cluster.description;
  const bool has_slope = thing.slope.status == FeatureStatus::kOk;
  const bool has_roughness = thing.roughness.status == FeatureStatus::kOk;
  std::string line = std::to_string(number) + "," + std::to_string(cluster.identity) + "," +
                     name_of(thing.terrain_class);
  for (const double value :
       {cluster.confidence, cluster.centre.x(), cluster.centre.y(), cluster.centre.z(),
        cluster.box.min.x, cluster.box.min.y, cluster.box.max.x, cluster.box.max.y,
        static_cast<double>(thing.cells), static_cast<double>(thing.points),
        static_cast<double>(thing.height.h_f)}) {
    line += "," + shortest(value);
  }
  line += "," + (has_roughness ? std::to_string(thing.roughness.rough ? 1 : 0) : std::string());
  line += "," + (has_slope ? shortest(thing.slope.angle * kDegrees) : std::string());
  return line + "\n";
}

void save_clusters(const TerrainSnapshot& snapshot, const std::string& file) {
  std::string csv =
      "cluster,identity,class,confidence,x,y,z,min_x,min_y,max_x,max_y,cells,points,height_index,"
      "rough,slope_deg\n";
  for (std::size_t k = 0; k < snapshot.clusters.size(); ++k) {
    csv += line_of(snapshot.clusters[k], k);
  }
  files::write_atomically(file, csv);
}

}  // namespace

void save_files(const CTerrainMap& map, const std::string& prefix) {
  const TerrainSnapshotPtr now = map.snapshot();
  save_scene(map, prefix + ".3Dscene");
  if (const auto tree = map.octree()) save_octree(*tree, prefix);
  save_clusters(*now, prefix + "_clusters.csv");
  if (now->costs().has(CostPart::kObstacle)) save_holes(*now, prefix + "_holes.csv");
  save_cost_map(cost_image(*now), prefix, "_cost");
  save_layers(*now, prefix);
  if (now->revision == 0) return;  // there is nothing to draw
  view::TopViewOptions options;
  options.source = prefix;
  options.scan_index = now->revision - 1;
  options.stamp = now->stamp;
  options.params = map.params().description;
  if (map.params().creation.fusion == Fusion::kRolling) options.axes = view::ViewAxes::kMap;
  if (!now->costs().unseen.empty()) options.unseen = &now->costs().unseen;
  view::write_top_view(prefix + "_classes.png", now->description, options);
  view::write_cost_view(prefix + "_cost.png", now->description, now->costs(), now->robot, options);
  if (now->costs().has(CostPart::kObstacle)) {
    view::write_cost_layers(prefix + "_cost_layers.png", now->description, now->costs(), now->robot,
                            options);
  }
}

}  // namespace mrpt_terrain
