// SPDX-License-Identifier: BSD-3-Clause
// Sweeps the parameters that the paper does not give over simulated scenes like the paper's, and
// prints Markdown tables for doc/paper-parameters.md. Needs no files and no arguments.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "lidar.h"
#include "mrpt_terrain/core/describe.h"
#include "worlds.h"

namespace mrpt_terrain::worlds {
namespace {

constexpr double kNoAngle = -1.0;
constexpr std::array<double, 3> kNoise = {0.002, 0.005, 0.010};
constexpr std::uint64_t kSeeds = 10;

/// One thing on flat ground, all of whose solids are object 0.
struct PaperScene {
  std::string name;
  Scene scene;
  TerrainClass expected = TerrainClass::kObstacle;
  double angle = kNoAngle;  ///< of ramps, radians
  std::vector<LidarScan> scans{};
};

PaperScene ramp_scene(const std::string& name, double degrees, const std::vector<Rect>& objects) {
  PaperScene result{name, {}, TerrainClass::kSlope, radians(degrees)};
  const Rect rect{1.25, 2.45, -0.5, 0.5};
  result.scene.solids.push_back(ramp_solid(rect, result.angle, 0));
  double height = 0.12;
  for (const Rect& object : objects) {
    const double below = (object.x0 - rect.x0) * std::tan(result.angle);
    result.scene.solids.push_back(box_solid(object, 0.0, below + height, 0));
    height += 0.04;
  }
  return result;
}

PaperScene box_scene(const std::string& name, const Rect& rect, double top) {
  PaperScene result{name, {}};
  result.scene.solids.push_back(box_solid(rect, 0.0, top, 0));
  return result;
}

/// Upright blocks in disorder; their envelope rises by `steepness` like that of the paper's
/// cluttered objects, which are close to a slope.
PaperScene heap_scene(const std::string& name, double steepness, std::uint64_t seed) {
  PaperScene result{name, {}};
  RandomGenerator random(seed);
  for (int k = 0; k < 40; ++k) {
    const double x = 1.3 + 0.8 * random.uniform();
    const double y = -0.4 + 0.7 * random.uniform();
    const double envelope = 0.1 + steepness * (x - 1.3);
    const double top = envelope * (0.4 + 0.9 * random.uniform());
    result.scene.solids.push_back(box_solid({x, x + 0.1, y, y + 0.1}, 0.0, top, 0));
  }
  return result;
}

std::vector<PaperScene> paper_scenes() {
  const Rect left{1.5, 1.65, 0.1, 0.3};
  const Rect right{1.9, 2.05, -0.3, -0.15};
  const Rect middle{1.7, 1.85, -0.1, 0.05};
  return {ramp_scene("A", 7.74, {}),
          ramp_scene("B", 13.86, {}),
          ramp_scene("C", 18.51, {}),
          ramp_scene("A1", 7.74, {left}),
          ramp_scene("A2", 7.74, {left, right}),
          ramp_scene("A3", 7.74, {left, right, middle}),
          box_scene("low box", {1.5, 1.9, -0.2, 0.2}, 0.15),
          box_scene("tall box", {1.5, 1.8, -0.3, 0.3}, 0.6),
          heap_scene("heap", 0.0, 1),
          heap_scene("sloping heap", 0.4, 2)};
}

/// What of a scan lies in the paper's map; the rest costs memory and changes nothing.
LidarScan in_map(const LidarScan& all) {
  LidarScan result;
  for (std::size_t i = 0; i < all.points.size(); ++i) {
    const Points& p = all.points;
    if (std::abs(p.x[i]) > 2.5F || std::abs(p.y[i]) > 2.5F) continue;
    result.points.push_back(p.x[i], p.y[i], p.z[i]);
    result.object.push_back(all.object[i]);
  }
  return result;
}

void scan_all(std::vector<PaperScene>& scenes) {
  for (PaperScene& scene : scenes) {
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      for (std::size_t k = 0; k < kNoise.size(); ++k) {
        RandomGenerator random(seed, k);
        scene.scans.push_back(in_map(scan(scene.scene, thirty_two_beams(kNoise[k]), random)));
      }
    }
  }
}

/// The cluster that holds most points of object 0, or nothing.
const ClusterDescription* thing_of(const Description& d, const LidarScan& scan) {
  std::vector<int> votes(d.things.size() + 1, 0);
  for (std::size_t i = 0; i < scan.object.size(); ++i) {
    if (scan.object[i] == 0 && d.labels.cluster[i] >= 0) {
      ++votes[static_cast<std::size_t>(d.labels.cluster[i])];
    }
  }
  const auto most = std::max_element(votes.begin(), votes.end());
  return *most == 0 ? nullptr : &d.things[static_cast<std::size_t>(most - votes.begin())];
}

struct Score {
  double correct = 0.0;  ///< share of scans with the right class
  double bias = 0.0;     ///< of the angle, degrees
  double spread = 0.0;   ///< standard deviation of the angle, degrees
  double iterations = 0.0;
  double l0 = 0.0, l1 = 0.0;  ///< greatest and least over the scans, m^2
};

Score score_of(const PaperScene& scene, DescriptionParams params) {
  params.classes.all_features = true;
  DescriptionWorkspace workspace;
  Description description;
  Score score;
  double sum = 0.0;
  double squares = 0.0;
  score.l1 = 1e9;
  const auto n = static_cast<double>(scene.scans.size());
  for (const LidarScan& scan : scene.scans) {
    describe(scan.points.view(), params, workspace, description);
    const ClusterDescription* thing = thing_of(description, scan);
    if (thing == nullptr) continue;
    score.correct += thing->terrain_class == scene.expected ? 1.0 / n : 0.0;
    score.iterations += thing->slope.iterations / n;
    score.l0 = std::max(score.l0, thing->roughness.lambda[0]);
    score.l1 = std::min(score.l1, thing->roughness.lambda[1]);
    const double error = (thing->slope.angle - scene.angle) * 180.0 / kPi;
    sum += error;
    squares += error * error;
  }
  score.bias = sum / n;
  score.spread = std::sqrt(std::max(0.0, squares / n - score.bias * score.bias));
  return score;
}

using Setter = std::function<void(DescriptionParams&, double)>;

void print_header(const std::string& first, const std::vector<PaperScene>& scenes) {
  std::string head = "\n| " + first + " |";
  std::string rule = "|---|";
  for (const PaperScene& scene : scenes) {
    head += " " + scene.name + " |";
    rule += "---|";
  }
  std::printf("%s\n%s\n", head.c_str(), rule.c_str());
}

/// One row per value: share of correct classes in per cent, with bias and spread of ramp angles.
void sweep(const std::vector<PaperScene>& scenes, const std::string& name,
           const std::vector<double>& values, const Setter& set) {
  print_header(name, scenes);
  for (const double value : values) {
    DescriptionParams params;
    set(params, value);
    std::printf("| %g |", value);
    for (const PaperScene& scene : scenes) {
      const Score score = score_of(scene, params);
      std::printf(" %.0f", 100.0 * score.correct);
      if (scene.angle != kNoAngle) std::printf(" (%+.2f, %.2f)", score.bias, score.spread);
      std::printf(" |");
    }
    std::printf("\n");
  }
}

void print_eigenvalues(const std::vector<PaperScene>& scenes) {
  print_header("default", scenes);
  std::string l0 = "| greatest lambda_0, 1e-4 m^2 |";
  std::string l1 = "| least lambda_1, 1e-4 m^2 |";
  std::string draws = "| mean RANSAC iterations |";
  for (const PaperScene& scene : scenes) {
    const Score score = score_of(scene, {});
    std::array<char, 32> text{};
    const auto cell = [&text](double value) {
      std::snprintf(text.data(), text.size(), " %.1f |", value);
      return std::string(text.data());
    };
    l0 += cell(1e4 * score.l0);
    l1 += cell(1e4 * score.l1);
    draws += cell(score.iterations);
  }
  std::printf("%s\n%s\n%s\n", l0.c_str(), l1.c_str(), draws.c_str());
}

void sweep_all() {
  std::vector<PaperScene> scenes = paper_scenes();
  scan_all(scenes);
  print_eigenvalues(scenes);
  sweep(scenes, "T_ratio", {2, 5, 10, 20, 30, 50},
        [](DescriptionParams& p, double v) { p.roughness.t_ratio = v; });
  sweep(scenes, "T_L, m^2", {0.001, 0.005, 0.01, 0.02, 0.05},
        [](DescriptionParams& p, double v) { p.roughness.t_l = v; });
  sweep(scenes, "T_S, m^2", {1e-4, 2e-4, 4e-4, 8e-4, 16e-4},
        [](DescriptionParams& p, double v) { p.roughness.t_s = v; });
  sweep(scenes, "T_q, m", {0.005, 0.01, 0.015, 0.02, 0.03},
        [](DescriptionParams& p, double v) { p.slope.inlier_distance = v; });
  sweep(scenes, "T_Inlier", {0.8, 0.9, 0.95, 0.99, 1.0},
        [](DescriptionParams& p, double v) { p.slope.inlier_share = v; });
  sweep(scenes, "MaxIterations", {10, 100, 300, 1000, 3000},
        [](DescriptionParams& p, double v) { p.slope.max_iterations = static_cast<int>(v); });
}

}  // namespace
}  // namespace mrpt_terrain::worlds

int main() {
  mrpt_terrain::worlds::sweep_all();
  return 0;
}
