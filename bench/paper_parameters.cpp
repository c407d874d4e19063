// SPDX-License-Identifier: BSD-3-Clause
// Sweeps the parameters that the paper does not give over simulated scenes like the paper's and
// prints the tables of doc/paper-parameters.md.
#include <Eigen/Core>
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

constexpr std::array<double, 3> kNoise = {0.002, 0.005, 0.010};
constexpr std::size_t kScans = 24;

/// One thing on flat ground, all of whose solids are object 0.
struct PaperScene {
  std::string name;
  Scene scene;
  TerrainClass expected = TerrainClass::kObstacle;
  double angle = 0.0;  ///< of ramps, radians
  std::vector<LidarScan> scans{};
};

PaperScene ramp_scene(const std::string& name, double degrees, const std::vector<Rect>& objects) {
  PaperScene result{name, {}, TerrainClass::kSlope, radians(degrees)};
  const Rect rect{1.25, 2.45, -0.5, 0.5};
  result.scene.solids.push_back(ramp_solid(rect, result.angle, 0));
  double above = 0.08;
  for (const Rect& object : objects) {
    const double top = (object.x0 - rect.x0) * std::tan(result.angle) + (above += 0.04);
    result.scene.solids.push_back(box_solid(object, 0.0, top, 0));
  }
  return result;
}

PaperScene box_scene(const std::string& name, const Rect& rect, double top) {
  PaperScene result{name, {}};
  result.scene.solids.push_back(box_solid(rect, 0.0, top, 0));
  return result;
}

/// Upright blocks in disorder whose envelope rises by `steepness`, like the paper's cluster 4.
PaperScene heap_scene(const std::string& name, double steepness, std::uint64_t seed) {
  PaperScene result{name, {}};
  RandomGenerator random(seed);
  for (int k = 0; k < 40; ++k) {
    const double x = 1.3 + 0.8 * random.uniform();
    const double y = -0.4 + 0.7 * random.uniform();
    const double top = (0.1 + steepness * (x - 1.3)) * (0.4 + 0.9 * random.uniform());
    result.scene.solids.push_back(box_solid({x, x + 0.1, y, y + 0.1}, 0.0, top, 0));
  }
  return result;
}

std::vector<PaperScene> paper_scenes() {
  const std::array<Rect, 3> on = {
      {{1.5, 1.65, 0.1, 0.3}, {1.9, 2.05, -0.3, -0.15}, {1.7, 1.85, -0.1, 0.05}}};
  return {ramp_scene("A", 7.74, {}),
          ramp_scene("B", 13.86, {}),
          ramp_scene("C", 18.51, {}),
          ramp_scene("A1", 7.74, {on[0]}),
          ramp_scene("A2", 7.74, {on[0], on[1]}),
          ramp_scene("A3", 7.74, {on[0], on[1], on[2]}),
          box_scene("low box", {1.5, 1.9, -0.2, 0.2}, 0.15),
          box_scene("tall box", {1.5, 1.8, -0.3, 0.3}, 0.6),
          heap_scene("heap", 0.0, 1),
          heap_scene("sloping heap", 0.4, 2)};
}

void scan_all(std::vector<PaperScene>& scenes) {
  for (PaperScene& scene : scenes) {
    for (std::size_t run = 0; run < kScans; ++run) {
      RandomGenerator random(run);
      const double noise = kNoise[run % kNoise.size()];
      scene.scans.push_back(scan(scene.scene, thirty_two_beams(noise), random));
    }
  }
}

/// The cluster that holds most points of object 0, or nothing.
const ClusterDescription* thing_of(const Description& d, const LidarScan& scan) {
  std::vector<int> votes(d.things.size() + 1, 0);
  for (std::size_t i = 0; i < scan.object.size(); ++i) {
    const std::int32_t cluster = d.labels.cluster[i];
    if (scan.object[i] == 0 && cluster >= 0) ++votes[static_cast<std::size_t>(cluster)];
  }
  const auto most = std::max_element(votes.begin(), votes.end());
  return *most == 0 ? nullptr : d.things.data() + (most - votes.begin());
}

struct Score {
  double correct = 0.0;                          ///< share of scans with the right class
  double bias = 0.0;                             ///< of the angle, degrees
  double spread = 0.0;                           ///< standard deviation of the angle, degrees
  double draws = 0.0;                            ///< mean number of RANSAC hypotheses
  Eigen::Vector4d extremes{1e9, 0.0, 1e9, 1e9};  ///< least, greatest l0; least l1; least l1 / l0
};

Score score_of(const PaperScene& scene, DescriptionParams params) {
  params.classes.all_features = true;
  DescriptionWorkspace workspace;
  Description description;
  Score score;
  double squares = 0.0;
  const auto n = static_cast<double>(scene.scans.size());
  for (const LidarScan& scan : scene.scans) {
    describe(scan.points.view(), params, workspace, description);
    const ClusterDescription* thing = thing_of(description, scan);
    if (thing == nullptr) continue;
    score.correct += thing->terrain_class == scene.expected ? 1.0 / n : 0.0;
    score.draws += thing->slope.iterations / n;
    const double error = (thing->slope.angle - scene.angle) * 180.0 / kPi;
    score.bias += error / n;
    squares += error * error / n;
    const auto& [l0, l1, l2] = thing->roughness.lambda;
    Eigen::Vector4d& e = score.extremes;
    e = {std::min(e[0], l0), std::max(e[1], l0), std::min(e[2], l1), std::min(e[3], l1 / l0)};
  }
  score.spread = std::sqrt(std::max(0.0, squares - score.bias * score.bias));
  return score;
}

void print_header(const std::string& first, const std::vector<PaperScene>& scenes) {
  std::string rule = "|---|";
  std::printf("\n| %s |", first.c_str());
  for (const PaperScene& scene : scenes) {
    std::printf(" %s |", scene.name.c_str());
    rule += "---|";
  }
  std::printf("\n%s\n", rule.c_str());
}

/// One row per value: per cent of correct classes; of ramps also bias, spread; mean hypotheses.
void sweep(const std::vector<PaperScene>& scenes, const std::string& name,
           const std::vector<double>& values, bool with_angles,
           const std::function<void(DescriptionParams&, double)>& set) {
  print_header(name, scenes);
  for (const double value : values) {
    DescriptionParams params;
    set(params, value);
    std::printf("| %g |", value);
    for (const PaperScene& scene : scenes) {
      const Score score = score_of(scene, params);
      std::printf(" %.0f", 100.0 * score.correct);
      if (with_angles && scene.expected == TerrainClass::kSlope) {
        std::printf(" (%+.2f, %.2f; %.0f)", score.bias, score.spread, score.draws);
      }
      std::printf(" |");
    }
    std::printf("\n");
  }
}

void print_eigenvalues(const std::vector<PaperScene>& scenes) {
  print_header("eigenvalues", scenes);
  const std::array<const char*, 4> names = {"least l0, 1e-4 m^2", "greatest l0, 1e-4 m^2",
                                            "least l1, 1e-4 m^2", "least l1 / l0"};
  for (std::size_t k = 0; k < names.size(); ++k) {
    std::printf("| %s |", names[k]);
    for (const PaperScene& scene : scenes) {
      const double value = score_of(scene, {}).extremes[static_cast<Eigen::Index>(k)];
      std::printf(" %.3g |", k < 3 ? 1e4 * value : value);
    }
    std::printf("\n");
  }
}

}  // namespace
}  // namespace mrpt_terrain::worlds

int main() {
  using namespace mrpt_terrain::worlds;
  using Params = mrpt_terrain::DescriptionParams;
  std::vector<PaperScene> scenes = paper_scenes();
  scan_all(scenes);
  print_eigenvalues(scenes);
  sweep(scenes, "T_ratio at T_S = 16e-4", {2, 10, 20, 30, 50}, false, [](Params& p, double v) {
    p.roughness = {v, 0.01, 16e-4, false};
  });
  sweep(scenes, "T_L, m^2", {0.001, 0.005, 0.01, 0.02, 0.05}, false,
        [](Params& p, double v) { p.roughness.t_l = v; });
  sweep(scenes, "T_S, m^2", {1e-4, 2e-4, 4e-4, 8e-4, 16e-4}, false,
        [](Params& p, double v) { p.roughness.t_s = v; });
  sweep(scenes, "T_q, m", {0.005, 0.01, 0.015, 0.02, 0.03}, true,
        [](Params& p, double v) { p.slope.inlier_distance = v; });
  sweep(scenes, "T_Inlier at T_q = 0.01", {0.8, 0.9, 0.95, 0.99, 1.0}, true,
        [](Params& p, double v) { p.slope.inlier_distance = 0.01, p.slope.inlier_share = v; });
  sweep(scenes, "MaxIterations at T_q = 0.01", {10, 100, 300, 1000, 3000}, true,
        [](Params& p, double v) {
          p.slope.inlier_distance = 0.01, p.slope.max_iterations = static_cast<int>(v);
        });
}
