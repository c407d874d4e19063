// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "mrpt_terrain/sim/scene.h"

namespace mrpt_terrain::sim {

/// The ground without anything cut out of it: heights at the nodes of a rectangular lattice, linear
/// within the two triangles of each of its cells. Metres, map frame.
class GroundSurface {
 public:
  /// Throws SceneError where a height map cannot be read.
  /// \param source beginning of messages
  explicit GroundSurface(const Ground& ground, const std::string& source = "ground");

  /// Height at (x, y); outside the extent that of the nearest edge continued.
  [[nodiscard]] double height(double x, double y) const;
  /// Unit normal of the triangle at (x, y), upwards.
  [[nodiscard]] Eigen::Vector3d normal(double x, double y) const;
  [[nodiscard]] bool contains(double x, double y) const;

  [[nodiscard]] const Eigen::Vector2d& min_corner() const { return min_corner_; }
  [[nodiscard]] const Eigen::Vector2d& max_corner() const { return max_corner_; }
  /// Number of nodes along x and y, at least 2 each.
  [[nodiscard]] std::size_t nodes_x() const { return nodes_x_; }
  [[nodiscard]] std::size_t nodes_y() const { return nodes_y_; }
  [[nodiscard]] Eigen::Vector3d node(std::size_t i, std::size_t k) const;

 private:
  struct Place {  ///< lattice cell of a position, and where in it: fractions of its sides
    std::size_t i, k;
    double u, v;
  };
  [[nodiscard]] Place place_of(double x, double y) const;
  [[nodiscard]] double& at(std::size_t i, std::size_t k) { return heights_[k * nodes_x_ + i]; }
  [[nodiscard]] double at(std::size_t i, std::size_t k) const { return heights_[k * nodes_x_ + i]; }
  void set_lattice(const Ground& ground, double spacing);
  void add_plane(const Ground& ground);
  void add_fractal(const Ground& ground);
  void read_height_map(const Ground& ground, const std::string& source);
  [[nodiscard]] double steepest() const;

  Eigen::Vector2d min_corner_, max_corner_, step_;
  std::size_t nodes_x_ = 0, nodes_y_ = 0;
  std::vector<double> heights_;  ///< row by row, x runs fastest
};

}  // namespace mrpt_terrain::sim
