// SPDX-License-Identifier: BSD-3-Clause
// Whether the likelihood is greatest near the true pose, in the simulator's worlds. The long form,
// which scripts/likelihood.sh runs, takes more worlds of each family.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "mrpt_terrain/map/terrain_map.h"
#include "sim_drive.h"
#include "terrain_maps.h"

namespace mrpt_terrain {
namespace {

using mrpt::poses::CPose3D;
using worlds::SimDrive;

const std::string kFamilies = MRPT_TERRAIN_SOURCE_DIR "/params/families";
constexpr double kDegree = M_PI / 180.0;
constexpr double kReach = 20.0;  ///< metres from the robot to the edge of the maps
constexpr double kWay = 4.0;     ///< metres that are mapped before a scan is judged
constexpr double kEvery = 0.5;   ///< metres between mapped scans

/// Number from the environment; 0 where it is not set.
int number_of(const char* variable) {
  const char* text = std::getenv(variable);
  return text == nullptr ? 0 : std::atoi(text);
}

// --- What fixes a pose --------------------------------------------------------------------------

/// A fan of rays from a place, one per degree and three about every ring of a sensor.
sim::Rays rays_of(const SimDrive& drive, const Eigen::Isometry3d& T_map_sensor, double turn,
                  double lift) {
  const std::vector<double>& elevations = drive.sensor.model.elevation;
  sim::Rays rays;
  rays.resize(360 * elevations.size());
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const double azimuth = static_cast<double>(k / elevations.size()) * kDegree + turn;
    const double elevation = elevations[k % elevations.size()] + lift;
    const Eigen::Vector3d d =
        T_map_sensor.linear() * Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                                                std::cos(elevation) * std::sin(azimuth),
                                                std::sin(elevation));
    const auto& origin = T_map_sensor.translation();
    rays.origin_x[k] = origin.x(), rays.origin_y[k] = origin.y(), rays.origin_z[k] = origin.z();
    rays.direction_x[k] = d.x(), rays.direction_y[k] = d.y(), rays.direction_z[k] = d.z();
  }
  return rays;
}

struct Fan {
  sim::Rays rays;
  sim::Hits hits;

  [[nodiscard]] Eigen::Vector3d direction(std::size_t k) const {
    return {rays.direction_x[k], rays.direction_y[k], rays.direction_z[k]};
  }
  [[nodiscard]] Eigen::Vector3d end(std::size_t k) const {
    return Eigen::Vector3d(rays.origin_x[k], rays.origin_y[k], rays.origin_z[k]) +
           hits.range[k] * direction(k);
  }
};

/// How well the true surfaces around a sensor fix x, y and heading, whatever is made of them: the
/// least eigenvalue of the mean of J^T J over its rays, where J says how the distance of a return
/// from its own surface changes with x, with y and with the heading (per 5 m of arm). 0.01 is one
/// return in a hundred that squarely faces the weakest direction. Returns of vegetation fix
/// nothing.
/// \param map if given: only returns from where it knows something fix anything
double structure_of(const SimDrive& drive, double time, const CTerrainMap* map = nullptr) {
  const Eigen::Isometry3d T_map_robot = drive.motion.at(time);
  const auto fan = [&](double turn, double lift) {
    Fan result{rays_of(drive, T_map_robot * drive.sensor.T_robot_sensor, turn, lift), {}};
    drive.caster->cast(result.rays, kReach, result.hits);
    return result;
  };
  const Fan middle = fan(0.0, 0.0), turned = fan(0.1 * kDegree, 0.0),
            lifted = fan(0.0, 0.1 * kDegree);
  sim::Hits seen = middle.hits;
  drive.caster->scatter(middle.rays, kReach, drive.seed, 0, seen);
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  int returns = 0;
  for (std::size_t k = 0; k < middle.rays.size(); ++k) {
    const std::int32_t solid = middle.hits.solid[k];
    if (seen.solid[k] == sim::kNoSolid) continue;
    ++returns;
    if (seen.solid[k] != solid) continue;
    const Eigen::Vector3d end = middle.end(k);
    if (map != nullptr && map->cell_at(end.x(), end.y()).status != PlaceStatus::kKnown) continue;
    if (turned.hits.solid[k] != solid || lifted.hits.solid[k] != solid) continue;
    const Eigen::Vector3d normal =
        (turned.end(k) - middle.end(k)).cross(lifted.end(k) - middle.end(k)).normalized();
    // Where the three rays meet the same plane, the simulator says so.
    const double cosine = std::abs(normal.dot(middle.direction(k)));
    if (std::abs(cosine - static_cast<double>(middle.hits.cos_incidence[k])) > 0.05) continue;
    const Eigen::Vector3d arm = middle.end(k) - T_map_robot.translation();
    const Eigen::Vector3d j(normal.x(), normal.y(),
                            (arm.x() * normal.y() - arm.y() * normal.x()) / 5.0);
    information += j * j.transpose();
  }
  if (returns == 0) return 0.0;
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(information / returns).eigenvalues()[0];
}

constexpr double kEnoughStructure = 0.01;

// --- Mapping and searching ----------------------------------------------------------------------

MapParams map_params(Fusion fusion) {
  MapParams params;
  params.creation.fusion = fusion;
  params.creation.octree_resolution = 0.2;
  GridParams& grid = params.description.grid;
  grid.length = grid.width = params.fusion.length = params.fusion.width = 2.0 * kReach;
  grid.cell_size = 0.2;
  grid.max_height = params.fusion.max_height = 3.0;
  return params;
}

CPose3D pose_of(const Eigen::Isometry3d& T) {
  mrpt::math::CMatrixDouble44 matrix;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) matrix(i, j) = T.matrix()(i, j);
  }
  return CPose3D(matrix);
}

/// A pose beside the true one: moved in the horizontal plane, turned about the vertical.
struct Offset {
  double x = 0.0, y = 0.0, turn = 0.0;
  [[nodiscard]] CPose3D from(const Eigen::Isometry3d& T) const {
    Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
    moved.translation() = T.translation() + Eigen::Vector3d(x, y, 0.0);
    moved.linear() = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) * T.linear();
    return pose_of(moved);
  }
};

/// Where within 0.5 m and 10 degrees of the truth the likelihood is greatest: on a grid that does
/// not hold the truth, then on finer ones about the best.
Offset search(const CTerrainMap& map, const mrpt::obs::CObservation& observation,
              const Eigen::Isometry3d& truth, std::uint64_t seed) {
  RandomGenerator random(seed, 77);
  const auto shift = [&random](double step) { return step * (random.uniform() - 0.5); };
  double step = 0.1, turn = 2.0 * kDegree;
  Offset best{shift(step), shift(step), shift(turn)};
  double greatest = -1e300;
  int n = 5;
  for (int level = 0; level < 3; ++level) {
    const Offset middle = best;
    for (int i = -n; i <= n; ++i) {
      for (int j = -n; j <= n; ++j) {
        for (int k = -n; k <= n; ++k) {
          const Offset here{middle.x + i * step, middle.y + j * step, middle.turn + k * turn};
          const double likelihood = map.computeObservationLikelihood(observation, here.from(truth));
          if (likelihood <= greatest) continue;
          greatest = likelihood;
          best = here;
        }
      }
    }
    step /= 3.0;
    turn /= 3.0;
    n = 2;
  }
  return best;
}

struct Outcome {
  double structure = 0.0, in_common = 0.0;  ///< that of all returns, and where the last scan was
  Offset scan, rolling;
};

bool is_good(const Offset& offset) {
  return std::hypot(offset.x, offset.y) <= 0.1 && std::abs(offset.turn) <= kDegree;
}

/// Maps the first metres of a drive, and judges a scan from a little farther on.
Outcome judge(const std::string& family, std::uint64_t seed) {
  const SimDrive drive = worlds::drive_in(family, seed);
  CTerrainMap rolling(map_params(Fusion::kRolling)), single(map_params(Fusion::kScan));
  std::uint64_t stream = 0;
  double way = 0.0, next = 0.0, time = 0.0;
  for (; way < kWay && time < drive.motion.end() - 1.0; time += 0.1) {
    const Eigen::Isometry3d T = drive.motion.at(time);
    if (way >= next) {
      next += kEvery;
      const io::Scan scan = worlds::scan_at(drive, time, stream++);
      rolling.insert_scan(scan, pose_of(T));
      single.insert_scan(scan, pose_of(T));
    }
    way += (drive.motion.at(time + 0.1).translation() - T.translation()).norm();
  }
  const io::Scan scan = worlds::scan_at(drive, time, stream++);
  const auto observation = testing::observation_of(scan.points);
  const Eigen::Isometry3d truth = drive.motion.at(time);
  Outcome outcome;
  outcome.structure = structure_of(drive, time);
  outcome.in_common = structure_of(drive, time, &single);
  outcome.rolling = search(rolling, observation, truth, seed);
  outcome.scan = search(single, observation, truth, seed);
  return outcome;
}

struct Tally {
  int judged = 0, rolling = 0, scan = 0;
  void add(const Outcome& outcome) {
    ++judged;
    rolling += is_good(outcome.rolling) ? 1 : 0;
    scan += is_good(outcome.scan) ? 1 : 0;
  }
};

void print(const char* what, const Tally& tally) {
  std::printf("%-12s %3d scans, near the truth: %3d rolling, %3d single\n", what, tally.judged,
              tally.rolling, tally.scan);
}

TEST(LikelihoodWorlds, IsGreatestNearTheTruthWhereTheWorldFixesThePose) {
  const int seeds = number_of("TERRAIN_LIKELIHOOD_SEEDS");
  const int first = number_of("TERRAIN_LIKELIHOOD_FIRST");
  Tally all;
  const char* only = std::getenv("TERRAIN_LIKELIHOOD_FAMILY");
  const std::vector<std::string> families = seeds == 0
                                                ? std::vector<std::string>{"clutter", "mixed"}
                                            : only != nullptr ? std::vector<std::string>{only}
                                                              : sim::family_names(kFamilies);
  for (const std::string& family : families) {
    Tally enough, little;
    for (int k = first; k < first + std::max(1, seeds); ++k) {
      const auto seed = static_cast<std::uint64_t>(k);
      ASSERT_TRUE(sim::kDevelopmentSeeds.contains(seed));
      const Outcome outcome = judge(family, seed);
      (outcome.structure >= kEnoughStructure ? enough : little).add(outcome);
      std::printf(
          "%s %d: structure %.4f (%.4f), rolling (%.3f, %.3f) m %.2f deg, single (%.3f, %.3f) m "
          "%.2f deg\n",
          family.c_str(), k, outcome.structure, outcome.in_common, outcome.rolling.x,
          outcome.rolling.y, outcome.rolling.turn / kDegree, outcome.scan.x, outcome.scan.y,
          outcome.scan.turn / kDegree);
    }
    print(family.c_str(), enough);
    if (little.judged != 0) print("  too little", little);
    std::fflush(stdout);
    all.judged += enough.judged;
    all.rolling += enough.rolling;
    all.scan += enough.scan;
  }
  print("all", all);
  EXPECT_GE(all.rolling, 0.95 * all.judged);
  // A single scan leaves holes and shadows that the map of several does not have.
  EXPECT_GE(all.scan, 0.85 * all.judged);
}

}  // namespace
}  // namespace mrpt_terrain
