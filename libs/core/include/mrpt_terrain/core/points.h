// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace mrpt_terrain {

/// Borrowed point cloud: three parallel arrays of `size` coordinates in metres, one frame for all.
/// It wraps the buffers of `mrpt::maps::CPointsMap` (or `Points` below) without a copy; whoever
/// lends the buffers keeps them alive and unchanged while the view is in use.
struct PointsView {
  const float* x = nullptr;
  const float* y = nullptr;
  const float* z = nullptr;
  std::size_t size = 0;
};

/// Owned point cloud, structure of arrays; the three arrays always have the same length.
struct Points {
  std::vector<float> x, y, z;

  [[nodiscard]] std::size_t size() const { return x.size(); }
  [[nodiscard]] PointsView view() const { return {x.data(), y.data(), z.data(), x.size()}; }

  /// Removes all points and keeps the memory.
  void clear() { resize(0); }
  void resize(std::size_t n) {
    x.resize(n);
    y.resize(n);
    z.resize(n);
  }
  void reserve(std::size_t n) {
    x.reserve(n);
    y.reserve(n);
    z.reserve(n);
  }
  void push_back(float px, float py, float pz) {
    x.push_back(px);
    y.push_back(py);
    z.push_back(pz);
  }
};

}  // namespace mrpt_terrain
