// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <octomap/OcTree.h>
#include <octomap/Pointcloud.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "mrpt_terrain/core/random.h"
#include "mrpt_terrain/octree/insert_scan.h"
#include "test_files.h"

/// \file
/// Scans for an octree, what OctoMap makes of them, and the comparison of trees.
namespace mrpt_terrain::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

/// OctoMap warns of rays that it drops and reports what it writes on standard error; not while one
/// of these lives.
class QuietOctomap {
 public:
  QuietOctomap() : kept_(dup(STDERR_FILENO)) {
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDERR_FILENO);
    close(nowhere);
  }
  ~QuietOctomap() {
    dup2(kept_, STDERR_FILENO);
    close(kept_);
  }
  QuietOctomap(const QuietOctomap&) = delete;
  QuietOctomap& operator=(const QuietOctomap&) = delete;

 private:
  int kept_;
};

/// A scan that owns its points, metres, frame of the tree.
struct OctreeScan {
  std::vector<float> x, y, z;
  std::vector<std::array<float, 3>> origins = {{0.0F, 0.0F, 0.0F}};
  std::vector<std::uint32_t> origin_of;  ///< empty: all the first

  void push_back(float px, float py, float pz) {
    x.push_back(px);
    y.push_back(py);
    z.push_back(pz);
  }
  [[nodiscard]] octree::RayEnds ends() const { return {x.data(), y.data(), z.data(), x.size()}; }
  [[nodiscard]] octree::RayOrigins starts() const {
    return {origins.data(), origins.size(), origin_of.empty() ? nullptr : origin_of.data()};
  }
  [[nodiscard]] octomap::point3d origin(std::size_t k) const {
    const auto& place = origins[origin_of.empty() ? 0 : origin_of[k]];
    return {place[0], place[1], place[2]};
  }
};

/// The scan's points for OctoMap, without those that `insert_scan` drops: such that are not finite,
/// and with `discretize` also those outside the range of keys.
inline octomap::Pointcloud cloud_of(const OctreeScan& scan, const octree::InsertionOptions& options,
                                    const octomap::OcTree& tree) {
  octomap::Pointcloud cloud;
  for (std::size_t k = 0; k < scan.x.size(); ++k) {
    const octomap::point3d point(scan.x[k], scan.y[k], scan.z[k]);
    octomap::OcTreeKey key;
    if (!std::isfinite(scan.x[k]) || !std::isfinite(scan.y[k]) || !std::isfinite(scan.z[k])) {
      continue;
    }
    if (options.discretize && !tree.coordToKeyChecked(point, key)) continue;
    cloud.push_back(point);
  }
  return cloud;
}

/// OctoMap's insertion of a scan with one origin.
inline void insert_by_octomap(const OctreeScan& scan, const octree::InsertionOptions& options,
                              octomap::OcTree& tree) {
  const QuietOctomap quiet;
  tree.insertPointCloud(cloud_of(scan, options, tree), scan.origin(0), options.max_range, false,
                        options.discretize);
}

/// Everything that OctoMap stores of a tree.
inline std::string bytes_of(const octomap::OcTree& tree) {
  const QuietOctomap quiet;
  std::ostringstream data, binary;
  tree.writeData(data);
  tree.writeBinaryConst(binary);
  return data.str() + binary.str();
}

/// Whether trees are equal by their operator, in both formats of files and in their own counts.
inline testing::AssertionResult same_tree(const octomap::OcTree& a, const octomap::OcTree& b) {
  if (!(a == b)) {
    return testing::AssertionFailure()
           << "trees of " << a.size() << " and " << b.size() << " nodes";
  }
  if (bytes_of(a) != bytes_of(b)) return testing::AssertionFailure() << "bytes differ";
  if (a.size() != a.calcNumNodes()) return testing::AssertionFailure() << "wrong number of nodes";
  return testing::AssertionSuccess();
}

/// Scans of a sequence of KITTI in the frame of the map; none if it is missing.
inline std::vector<OctreeScan> kitti_scans(const std::string& sequence, std::size_t count,
                                           std::size_t every = 1) {
  const std::filesystem::path folder = data_folder() / sequence;
  std::ifstream poses(folder / "poses.tum");
  std::vector<OctreeScan> scans;
  std::size_t number = 0;
  for (std::string line; scans.size() < count && std::getline(poses, line);) {
    if (line.empty() || line[0] == '#') continue;
    if (number++ % every != 0) continue;
    std::istringstream fields(line);
    double stamp, tx, ty, tz, x, y, z, w;
    fields >> stamp >> tx >> ty >> tz >> x >> y >> z >> w;
    const double r[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - z * w),     2 * (x * z + y * w),
                         2 * (x * y + z * w),     1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
                         2 * (x * z - y * w),     2 * (y * z + x * w),     1 - 2 * (x * x + y * y)};
    std::string name = std::to_string(number - 1);
    name = std::string(6 - name.size(), '0') + name + ".bin";
    std::ifstream file(folder / "velodyne" / name, std::ios::binary);
    std::array<float, 4> p{};
    OctreeScan scan;
    scan.origins = {{static_cast<float>(tx), static_cast<float>(ty), static_cast<float>(tz)}};
    while (file.read(reinterpret_cast<char*>(p.data()), sizeof(p))) {
      const double px = p[0], py = p[1], pz = p[2];
      scan.push_back(static_cast<float>(r[0] * px + r[1] * py + r[2] * pz + tx),
                     static_cast<float>(r[3] * px + r[4] * py + r[5] * pz + ty),
                     static_cast<float>(r[6] * px + r[7] * py + r[8] * pz + tz));
    }
    if (scan.x.empty()) break;
    scans.push_back(std::move(scan));
  }
  return scans;
}

inline float pick(RandomGenerator& random, std::initializer_list<float> values) {
  return *(values.begin() + random.below(static_cast<std::uint32_t>(values.size())));
}

/// Random tree without nodes: resolution from 2 cm to 2 m, probabilities and clamps so that cells
/// saturate after one to many scans.
inline octomap::OcTree random_tree(RandomGenerator& random) {
  octomap::OcTree tree(0.02 * std::pow(100.0, random.uniform()));
  // Ties need borders that a float can hold.
  if (random.below(2) == 0) tree.setResolution(pick(random, {0.1F, 0.125F, 0.25F, 0.5F, 1.0F}));
  if (random.below(4) == 0) return tree;
  tree.setProbHit(0.5 + 0.49 * random.uniform());
  tree.setProbMiss(0.5 - 0.49 * random.uniform());
  tree.setClampingThresMin(0.5 - 0.49 * random.uniform());
  tree.setClampingThresMax(0.5 + 0.49 * random.uniform());
  if (random.below(8) == 0) tree.setProbHit(0.5);   // log-odds of zero
  if (random.below(8) == 0) tree.setProbMiss(0.5);  // the same
  if (random.below(8) == 0) tree.setClampingThresMin(0.5 + 0.2 * random.uniform());
  tree.setOccupancyThres(0.3 + 0.4 * random.uniform());
  return tree;
}

/// A coordinate up to `reach` cells from zero: anywhere, or on a border or centre of a cell, so
/// that rays cross edges and corners.
inline float random_coordinate(RandomGenerator& random, double resolution, int reach, bool snap) {
  const double cells = reach * (2.0 * random.uniform() - 1.0);
  return static_cast<float>(resolution * (snap ? std::round(2.0 * cells) / 2.0 : cells));
}

/// Ray ends of every sort about an origin near `centre`: free ones, on borders of cells, along axes
/// and diagonals, at the origin, far out of range, not numbers.
inline OctreeScan random_scan(RandomGenerator& random, double resolution, std::uint32_t origins) {
  OctreeScan scan;
  scan.origins.clear();
  const bool snap = random.below(2) == 0;
  const int reach = random.below(4) == 0 ? 60 : 12;
  for (std::uint32_t k = 0; k < origins; ++k) {
    scan.origins.push_back({random_coordinate(random, resolution, 4, snap),
                            random_coordinate(random, resolution, 4, snap),
                            random_coordinate(random, resolution, 4, snap)});
  }
  const std::uint32_t points = random.below(60);
  for (std::uint32_t k = 0; k < points; ++k) {
    const std::uint32_t number = random.below(origins);
    std::array<float, 3> end = scan.origins[number];
    const std::uint32_t sort = random.below(10);
    const std::uint32_t axis = random.below(3);
    const float step = random_coordinate(random, resolution, reach, snap);
    if (sort == 0) {
      end[axis] += step;
    } else if (sort == 1) {
      for (float& value : end) value += random.below(2) == 0 ? step : -step;
    } else if (sort == 2) {
      end[axis] += step;
      end[(axis + 1) % 3] += step;
    } else if (sort == 3) {
      end[axis] = random.below(2) == 0 ? end[axis] : end[axis] + pick(random, {0.0F, 1e-30F});
    } else if (sort == 4 && random.below(4) == 0) {
      const auto infinity = std::numeric_limits<float>::infinity();
      end[axis] = pick(random, {NAN, infinity, -infinity, 1e30F, -1e9F,
                                static_cast<float>(33000.0 * resolution)});
    } else {
      for (float& value : end) value = random_coordinate(random, resolution, reach, snap);
    }
    scan.push_back(end[0], end[1], end[2]);
    scan.origin_of.push_back(number);
  }
  if (origins == 1) scan.origin_of.clear();
  return scan;
}

inline octree::InsertionOptions random_options(RandomGenerator& random, double resolution) {
  octree::InsertionOptions options;
  options.discretize = random.below(2) == 0;
  if (random.below(2) == 0) options.max_range = 20.0 * resolution * random.uniform();
  if (random.below(32) == 0) options.max_range = 0.0;
  if (random.below(8) == 0) options.max_range = resolution * random.below(20);
  return options;
}

}  // namespace mrpt_terrain::test
