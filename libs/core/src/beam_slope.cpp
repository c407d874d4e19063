// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/beam_slope.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "mrpt_terrain/core/random.h"
#include "plane_inliers.h"
#include "wide_registers.h"

namespace mrpt_terrain {
namespace {

constexpr double kPi = 3.14159265358979323846;
// Points that the first plane is sought in and refined with.
constexpr std::size_t kSampleSize = 512;
constexpr std::size_t kConsensusSize = 256;
constexpr int kMostReach = 3;
constexpr std::size_t kCostBlock = 32;
constexpr std::size_t kGroundSample = 512;
constexpr std::size_t kLeastPoints = 8;
constexpr std::size_t kLeastGroundCells = 16;
// The mean of a cell of ground counts as no more points than this: errors of rings and the
// unevenness of the ground do not average out.
constexpr float kMostCount = 16.0F;
constexpr int kFirstSteps = 3;
// The surface is marked and fitted twice, because the first plane knows only part of it; the first
// time a part of the points will do.
constexpr int kRounds = 2;
constexpr int kSteps[kRounds] = {3, 2};
constexpr std::size_t kStrides[kRounds] = {4, 1};
// A cell agrees with the plane if its mean lies within so many of its standard deviations.
constexpr double kMeanLimit = 3.0;
// Its scatter may exceed the expected variance by so many standard deviations of a variance.
constexpr double kScatterLimit = 4.0;
// A ground cell is told from the surface if the two lie so many standard deviations apart.
constexpr double kApart = 6.0;
// The sensor has to be so many standard deviations of the range noise above the ground.
constexpr double kAbove = 3.0;

// Bits of the mark of a cell; the frame of the grid never has any.
constexpr std::uint8_t kSurface = 1;   // belongs to the surface: 1, so that it serves as a weight
constexpr std::uint8_t kSeen = 2;      // has been judged
constexpr std::uint8_t kNear = 4;      // noise may have put points of the surface here
constexpr std::uint8_t kGathered = 8;  // its points are among the candidates

/// The plane as it is found out step by step, and what is needed to judge cells by it.
struct Surface {
  Eigen::Vector3d centre;  ///< of the cluster: origin of both planes
  Eigen::Vector3d origin;  ///< Estimator::sensor
  BeamPlane plane;
  double range_sigma = 0.0;
  BeamPlane ground;  ///< about the same centre; z = 0 where no ground was seen
};

struct Estimator {
  const BeamSlopeInput& input;
  std::size_t cluster;
  const BeamSlopeParams& params;
  BeamSlopeWorkspace& workspace;
  CellBox box;     ///< where ground is looked for
  CellBox growth;  ///< where the surface may reach
  CellBox near;    ///< where points of the surface may lie

  [[nodiscard]] IndexRange slots() const { return input.clusters.slots.row(cluster); }
  /// Where the first beam of the scan started: near enough for whole cells.
  [[nodiscard]] Eigen::Vector3d sensor() const {
    const std::array<float, 3>& first = input.origins.of(0);
    return {first[0], first[1], first[2]};
  }
};

bool contains(const CellBox& box, CellIndex cell) {
  return cell.l >= box.low.l && cell.l <= box.high.l && cell.w >= box.low.w && cell.w <= box.high.w;
}

BeamPlane upright(const BeamPlane& plane) {
  return plane.normal.z() < 0.0 ? BeamPlane{-plane.normal, -plane.offset} : plane;
}

template <class Visit>
void for_cells(const GridGeometry& geometry, const CellBox& box, Visit&& visit) {
  for (int l = box.low.l; l <= box.high.l; ++l) {
    auto id = static_cast<std::size_t>(value_of(geometry.id_of({l, box.low.w})));
    for (int w = box.low.w; w <= box.high.w; ++w) visit(CellIndex{l, w}, id++);
  }
}

Eigen::Vector3f point_at(const PointsView& points, std::size_t i) {
  return {points.x[i], points.y[i], points.z[i]};
}

std::size_t number_of_points(const Estimator& self) {
  double n = 0.0;
  for (const std::int32_t slot : self.slots()) {
    n += self.input.sums[static_cast<std::size_t>(slot)].n;
  }
  return static_cast<std::size_t>(n);
}

Eigen::Vector3d centre_of(const Estimator& self) {
  MomentSums sums;
  for (const std::int32_t slot : self.slots()) {
    sums.add(self.input.sums[static_cast<std::size_t>(slot)]);
  }
  return moments_from(sums).mean();
}

// A step that leads to every place of a ring of n before it comes back.
std::size_t spreading_step(std::size_t n) {
  if (n < 2) return 1;
  auto step = static_cast<std::size_t>(0.618 * static_cast<double>(n));
  while (std::gcd(step, n) != 1) ++step;
  return step;
}

// Every n-th point of the cluster, so mixed that the first few are spread over all of it.
void draw_sample(const Estimator& self, std::size_t points, const Eigen::Vector3d& centre,
                 BeamPoints& sample) {
  const std::size_t stride = (points + kSampleSize - 1) / kSampleSize;
  sample.resize((points + stride - 1) / stride);
  const std::size_t step = spreading_step(sample.size);
  const Eigen::Vector3f origin = centre.cast<float>();
  std::size_t place = 0;
  std::size_t skip = 0;
  for (const std::int32_t slot : self.slots()) {
    const IndexRange row = self.input.points_of_slot.row(static_cast<std::size_t>(slot));
    for (; skip < row.size(); skip += stride) {
      const auto i = static_cast<std::size_t>(row.first[skip]);
      sample.set(place, point_at(self.input.points, i), self.input.origins.of(i), origin);
      place += step;
      if (place >= sample.size) place -= sample.size;
    }
    skip -= row.size();
  }
  sample.normalise_beams();
}

// Cost of a plane by MSAC (Torr and Zisserman 2000): squared distances, cut off. Gives up as soon
// as it reaches `to_beat`. Looks at whole blocks only.
MRPT_TERRAIN_WIDE_REGISTERS
float truncated_cost(const BeamPoints& cloud, std::size_t n, const Plane& plane, float cutoff,
                     float to_beat) {
  const float limit = cutoff * cutoff;
  float cost = 0.0F;
  for (std::size_t begin = 0; begin + kCostBlock <= n && cost < to_beat; begin += kCostBlock) {
    float lanes[kCostBlock];
    for (std::size_t k = 0; k < kCostBlock; ++k) {
      const std::size_t i = begin + k;
      const float e = plane.a * cloud.x[i] + plane.b * cloud.y[i] + plane.c * cloud.z[i] + plane.d;
      lanes[k] = e * e < limit ? e * e : limit;
    }
    for (std::size_t half = kCostBlock / 2; half > 0; half /= 2) {
      for (std::size_t k = 0; k < half; ++k) lanes[k] += lanes[k + half];
    }
    cost += lanes[0];
  }
  return cost;
}

Plane single_precision(const BeamPlane& plane) {
  const Eigen::Vector3f normal = plane.normal.cast<float>();
  return {normal.x(), normal.y(), normal.z(), static_cast<float>(plane.offset)};
}

// The best of random planes, and of a guess if there is one.
std::optional<BeamPlane> consensus_plane(const BeamPoints& sample, const BeamSlopeParams& params,
                                         const std::optional<BeamPlane>& guess,
                                         RandomGenerator& random) {
  const std::size_t n = std::min(sample.size, kConsensusSize);
  const PointsView cloud{sample.x.data(), sample.y.data(), sample.z.data(), n};
  const auto cutoff = static_cast<float>(params.seed_distance);
  float best_cost = std::numeric_limits<float>::max();
  std::optional<BeamPlane> best = guess;
  if (guess) best_cost = truncated_cost(sample, n, single_precision(*guess), cutoff, best_cost);
  for (int k = 0; k < params.hypotheses; ++k) {
    const std::optional<Plane> plane = random_plane(cloud, random);
    if (!plane) continue;
    const float cost = truncated_cost(sample, n, *plane, cutoff, best_cost);
    if (!(cost < best_cost)) continue;
    best_cost = cost;
    best = beam_plane_of(*plane);
  }
  return best;
}

// Sample consensus, then the likely plane.
BeamPlaneFit fit_from_scratch(const BeamPoints& sample, const BeamSlopeParams& params,
                              const std::optional<BeamPlane>& guess, RandomGenerator& random,
                              std::vector<float>& scratch) {
  const std::optional<BeamPlane> seed = consensus_plane(sample, params, guess, random);
  if (!seed) return {};
  const double sigma = median_range_sigma(sample, *seed, 2, scratch);
  return fit_beam_plane(sample, *seed, sigma, params.least_sigma, kFirstSteps);
}

// Slots of ground cells around, those near the surface left out.
void find_ground_cells(const Estimator& self, std::vector<std::int32_t>& found) {
  const ElevationGrid& grid = self.input.grid;
  found.clear();
  for_cells(grid.geometry, self.box, [&](CellIndex, std::size_t id) {
    const Slot slot = grid.slot_of[id];
    if (slot == kUnobserved || (self.workspace.marks[id] & kNear) != 0) return;
    const auto index = static_cast<std::size_t>(slot);
    if (self.input.ground.is_ground(index) && self.input.sums[index].n > 0.0) found.push_back(slot);
  });
}

// Mean points of ground cells, as many as are needed.
void sample_ground(const Estimator& self, const Eigen::Vector3d& centre) {
  std::vector<std::int32_t>& found = self.workspace.open;
  find_ground_cells(self, found);
  BeamPoints& cells = self.workspace.ground;
  const std::size_t stride = found.size() / kGroundSample + 1;
  cells.resize((found.size() + stride - 1) / stride);
  const std::size_t step = spreading_step(cells.size);
  std::size_t place = 0;
  for (std::size_t k = 0; k < found.size(); k += stride) {
    const MomentSums& sums = self.input.sums[static_cast<std::size_t>(found[k])];
    const Eigen::Vector3d mean = Eigen::Vector3d(sums.x, sums.y, sums.z) / sums.n;
    cells.set(place, mean.cast<float>(), self.input.origins.of(0), centre.cast<float>());
    cells.count[place] = std::min(static_cast<float>(sums.n), kMostCount);
    place = (place + step) % cells.size;
  }
  cells.normalise_beams();
}

// Plane through the ground cells around, normal upwards; starts from the last one if there is one.
// Else z = 0 stands for election as well: where a single ring is all that is seen of the ground,
// hardly three of its points make a plane that is better.
BeamPlaneFit fit_ground(const Estimator& self, const Eigen::Vector3d& centre,
                        const BeamPlaneFit& last, RandomGenerator& random) {
  sample_ground(self, centre);
  const BeamPoints& cells = self.workspace.ground;
  if (cells.size < kLeastGroundCells) return {};
  const BeamPlane level{Eigen::Vector3d::UnitZ(), centre.z()};
  BeamPlaneFit fit =
      last.ok ? fit_beam_plane(cells, last.plane, last.range_sigma, self.params.least_sigma, 2)
              : fit_from_scratch(cells, self.params, level, random, self.workspace.residuals);
  fit.plane = upright(fit.plane);
  // A short piece of a ring lies in a plane through the sensor, too, but the ground is below it.
  const Eigen::Vector3d& normal = fit.plane.normal;
  const double height = normal.dot(self.sensor() - centre) + fit.plane.offset;
  if (!(height > kAbove * fit.range_sigma)) fit.ok = false;
  return fit;
}

// On steep planes noise moves points across the borders of cells, which so sort them by their
// error: the mean of a cell may then be off by what the noise itself amounts to.
double sorting_error(const Surface& surface, double variance) {
  const double horizontal = surface.plane.normal.head<2>().squaredNorm();
  return horizontal * horizontal * kMeanLimit * std::sqrt(variance);
}

// Whether the points of a cell agree with the plane; those called ground have to stand out of it
// where their mean beam meets the plane.
bool agrees(const Estimator& self, const Surface& surface, Slot slot) {
  const auto index = static_cast<std::size_t>(slot);
  const MomentSums& sums = self.input.sums[index];
  if (sums.n == 0.0) return false;
  const double share = 1.0 / sums.n;
  const Eigen::Vector3d mean = Eigen::Vector3d(sums.x, sums.y, sums.z) * share;
  const Eigen::Vector3d& n = surface.plane.normal;
  const Eigen::Vector3d about = mean - surface.centre;
  const Eigen::Vector3d beam = mean - surface.origin;
  const double along = n.dot(beam);
  const double across = kAcrossBeam * kAcrossBeam * beam.squaredNorm();
  const double variance =
      surface.range_sigma * surface.range_sigma * (along * along + across) / beam.squaredNorm();
  const double e = n.dot(about) + surface.plane.offset;
  const double mean_sigma = std::sqrt(variance * share);
  const double tolerance = kMeanLimit * mean_sigma + sorting_error(surface, variance);
  if (std::abs(e) > tolerance) return false;
  const double square = n.x() * (n.x() * sums.xx + 2.0 * (n.y() * sums.xy + n.z() * sums.xz)) +
                        n.y() * (n.y() * sums.yy + 2.0 * n.z() * sums.yz) + n.z() * n.z() * sums.zz;
  const double level = n.dot(mean);
  const double scatter = square * share - level * level;
  if (scatter > variance * (1.0 + kScatterLimit * std::sqrt(2.0 * share))) return false;
  if (!self.input.ground.is_ground(index)) return true;
  const Eigen::Vector3d met = about - beam * (along * e / (along * along + across));
  const double height = std::abs(surface.ground.normal.dot(met) + surface.ground.offset);
  return height > self.params.least_height + kApart * mean_sigma;
}

// Marks the cells of the cluster that agree with the plane; their points are counted and the
// cells are where the flood starts.
double mark_cluster(const Estimator& self, const Surface& surface) {
  const ElevationGrid& grid = self.input.grid;
  self.workspace.open.clear();
  double points = 0.0;
  for (const std::int32_t slot : self.slots()) {
    const auto index = static_cast<std::size_t>(slot);
    const std::int32_t id = value_of(grid.cell[index]);
    const bool good = agrees(self, surface, slot);
    self.workspace.marks[static_cast<std::size_t>(id)] |= good ? kSurface | kSeen : kSeen;
    if (!good) continue;
    points += self.input.sums[index].n;
    self.workspace.open.push_back(id);
  }
  return points;
}

// Floods from the marked cells into cells of no cluster that agree with the plane.
void grow_surface(const Estimator& self, const Surface& surface) {
  const ElevationGrid& grid = self.input.grid;
  std::vector<std::uint8_t>& marks = self.workspace.marks;
  std::vector<std::int32_t>& open = self.workspace.open;
  const auto is_free = [&](Slot slot) {
    return slot != kUnobserved &&
           self.input.clusters.cluster_of[static_cast<std::size_t>(slot)] == kNoCluster;
  };
  const std::int32_t stride = grid.geometry.stride();
  while (!open.empty()) {
    const std::int32_t id = open.back();
    open.pop_back();
    for (const std::int32_t next : {id - stride, id - 1, id + 1, id + stride}) {
      const auto place = static_cast<std::size_t>(next);
      if ((marks[place] & kSeen) != 0) continue;
      if (!contains(self.growth, grid.geometry.index_of(CellId{next}))) continue;
      const Slot slot = grid.slot_of[place];
      marks[place] |= kSeen;
      if (!is_free(slot) || !agrees(self, surface, slot)) continue;
      marks[place] |= kSurface;
      open.push_back(next);
    }
  }
}

// Marks cells within `reach` of the surface.
void mark_near(const Estimator& self, int reach) {
  const GridGeometry& geometry = self.input.grid.geometry;
  std::vector<std::uint8_t>& marks = self.workspace.marks;
  const std::int32_t stride = geometry.stride();
  for_cells(geometry, self.growth, [&](CellIndex cell, std::size_t id) {
    if ((marks[id] & kSurface) == 0) return;
    marks[id] |= kNear;
    const auto step = static_cast<std::size_t>(stride);
    const int all = marks[id - step] & marks[id - 1] & marks[id + 1] & marks[id + step];
    if ((all & kSurface) != 0) return;  // its neighbours speak for it
    for (int l = std::max(0, cell.l - reach); l <= std::min(geometry.cells_l() - 1, cell.l + reach);
         ++l) {
      for (int w = std::max(0, cell.w - reach);
           w <= std::min(geometry.cells_w() - 1, cell.w + reach); ++w) {
        marks[static_cast<std::size_t>(value_of(geometry.id_of({l, w})))] |= kNear;
      }
    }
  });
}

// Adds the points of cells near the surface to the candidates, each cell once.
void gather_candidates(const Estimator& self, const Surface& surface) {
  const ElevationGrid& grid = self.input.grid;
  BeamPoints& candidates = self.workspace.surface;
  const Eigen::Vector3f centre = surface.centre.cast<float>();
  const std::size_t before = candidates.size;
  std::size_t n = before;
  for_cells(grid.geometry, self.near, [&](CellIndex, std::size_t id) {
    std::uint8_t& mark = self.workspace.marks[id];
    const Slot slot = grid.slot_of[id];
    if ((mark & (kNear | kGathered)) != kNear || slot == kUnobserved) return;
    mark |= kGathered;
    const IndexRange row = self.input.points_of_slot.row(static_cast<std::size_t>(slot));
    if (n + row.size() > candidates.size) candidates.resize(2 * (n + row.size()));
    for (const std::int32_t item : row) {
      const auto i = static_cast<std::size_t>(item);
      candidates.set(n++, point_at(self.input.points, i), self.input.origins.of(i), centre);
    }
  });
  candidates.resize(n);
  candidates.normalise_beams(before);
}

// Lets the candidates count whose beam meets the plane in a cell of the surface and above the
// ground. Decides only about the blocks that the fit will look at.
void select_points(const Estimator& self, const Surface& surface, std::size_t stride) {
  BeamPoints& candidates = self.workspace.surface;
  std::vector<std::int32_t>& cells = self.workspace.cells;
  find_meeting_cells(candidates, surface.plane, surface.ground, self.params.least_height,
                     self.input.grid.geometry, surface.centre, stride, cells);
  constexpr std::size_t kBlock = BeamPoints::kPadding;
  for (std::size_t begin = 0; begin < candidates.size; begin += stride * kBlock) {
    const std::size_t end = std::min(begin + kBlock, candidates.size);
    for (std::size_t k = begin; k < end; ++k) {
      const std::uint8_t mark = self.workspace.marks[static_cast<std::size_t>(cells[k])];
      candidates.count[k] = static_cast<float>(mark & kSurface);
    }
  }
}

// How far noise along the beam can shift a point, in cells.
int reach_of_noise(const Estimator& self, double range_sigma) {
  const double cells = kMeanLimit * range_sigma / self.input.grid.geometry.cell_size();
  return std::clamp(static_cast<int>(std::ceil(cells)), 1, kMostReach);
}

// Removes bits of all marks.
void clear_marks(const Estimator& self, int bits) {
  for_cells(self.input.grid.geometry, self.near, [&](CellIndex, std::size_t id) {
    self.workspace.marks[id] &= static_cast<std::uint8_t>(~bits);
  });
}

// Standard deviation of the angle between a plane and a fixed direction; `to` is unit.
double angle_sigma(const BeamPlaneFit& fit, const Eigen::Vector3d& to) {
  Eigen::Vector3d turn = to - fit.plane.normal * fit.plane.normal.dot(to);
  turn = turn.norm() > 1e-9 ? turn.normalized() : fit.plane.normal.unitOrthogonal();
  return std::sqrt(std::max(0.0, turn.dot(fit.normal_covariance * turn)));
}

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
}

void report_plane(const BeamPlaneFit& fit, const Eigen::Vector3d& centre, Slope& slope) {
  slope.normal = fit.plane.normal;
  slope.offset = fit.plane.offset - fit.plane.normal.dot(centre);
  slope.angle = angle_between(fit.plane.normal, Eigen::Vector3d::UnitZ());
  slope.direction = direction_of(fit.plane.normal);
  slope.angle_sigma = angle_sigma(fit, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d aside(-fit.plane.normal.y(), fit.plane.normal.x(), 0.0);
  const double horizontal = aside.squaredNorm();
  slope.direction_sigma = kPi;
  if (horizontal > 0.0) {
    const double variance = aside.dot(fit.normal_covariance * aside) / (horizontal * horizontal);
    slope.direction_sigma = std::min(kPi, std::sqrt(std::max(0.0, variance)));
  }
  slope.range_sigma = fit.range_sigma;
  slope.inliers = fit.inliers;
}

void report_ground(const BeamPlaneFit& fit, const BeamPlaneFit& ground,
                   const Eigen::Vector3d& centre, double max_sigma, SlopeToGround& result) {
  result.status = FeatureStatus::kTooFewPoints;
  if (!ground.ok) return;
  result.angle = angle_between(fit.plane.normal, ground.plane.normal);
  result.angle_sigma =
      std::hypot(angle_sigma(fit, ground.plane.normal), angle_sigma(ground, fit.plane.normal));
  result.status = result.angle_sigma <= max_sigma ? FeatureStatus::kOk : FeatureStatus::kUncertain;
  result.ground_normal = ground.plane.normal;
  result.ground_offset = ground.plane.offset - ground.plane.normal.dot(centre);
}

// The stages between the sample and the report; false where no plane could be fitted.
bool fit_surface(const Estimator& self, RandomGenerator& random, BeamPlaneFit& fit,
                 BeamPlaneFit& ground, Surface& surface, double& explained) {
  BeamSlopeWorkspace& workspace = self.workspace;
  fit = fit_from_scratch(workspace.sample, self.params, {}, random, workspace.residuals);
  if (!fit.ok) return false;
  ground = fit_ground(self, surface.centre, {}, random);
  for (int round = 0; round < kRounds && fit.ok; ++round) {
    surface.plane = fit.plane;
    surface.range_sigma = fit.range_sigma;
    if (ground.ok) surface.ground = ground.plane;
    clear_marks(self, kSurface | kSeen | kNear);
    explained = mark_cluster(self, surface);
    grow_surface(self, surface);
    mark_near(self, reach_of_noise(self, fit.range_sigma));
    gather_candidates(self, surface);
    select_points(self, surface, kStrides[round]);
    if (round == 0) ground = fit_ground(self, surface.centre, ground, random);
    fit = fit_beam_plane(workspace.surface, fit.plane, fit.range_sigma, self.params.least_sigma,
                         kSteps[round], kStrides[round]);
  }
  fit.plane = upright(fit.plane);
  return fit.ok;
}

}  // namespace

double beam_slope_reach(const ElevationGrid& grid, const BeamSlopeParams& params) {
  return params.growth + kMostReach * grid.geometry.cell_size();
}

CellBox cells_around(const ElevationGrid& grid, IndexRange slots, double margin) {
  const GridGeometry& geometry = grid.geometry;
  CellBox box{geometry.index_of(grid.cell[static_cast<std::size_t>(*slots.begin())]), {}};
  box.high = box.low;
  for (const std::int32_t slot : slots) {
    const CellIndex cell = geometry.index_of(grid.cell[static_cast<std::size_t>(slot)]);
    box.low = {std::min(box.low.l, cell.l), std::min(box.low.w, cell.w)};
    box.high = {std::max(box.high.l, cell.l), std::max(box.high.w, cell.w)};
  }
  const int cells = static_cast<int>(std::ceil(margin / geometry.cell_size()));
  box.low = {std::max(0, box.low.l - cells), std::max(0, box.low.w - cells)};
  box.high = {std::min(geometry.cells_l() - 1, box.high.l + cells),
              std::min(geometry.cells_w() - 1, box.high.w + cells)};
  return box;
}

Slope estimate_beam_slope(const BeamSlopeInput& input, std::size_t cluster,
                          const BeamSlopeParams& params, std::uint64_t seed,
                          BeamSlopeWorkspace& workspace) {
  const IndexRange slots = input.clusters.slots.row(cluster);
  const Estimator self{input,
                       cluster,
                       params,
                       workspace,
                       cells_around(input.grid, slots, params.ground_margin),
                       cells_around(input.grid, slots, params.growth),
                       cells_around(input.grid, slots, beam_slope_reach(input.grid, params))};
  Slope slope;
  const std::size_t points = number_of_points(self);
  slope.points = static_cast<std::int32_t>(points);
  if (!input.origins.known()) {
    slope.status = FeatureStatus::kNoOrigin;
    return slope;
  }
  if (points < kLeastPoints) {
    slope.status = FeatureStatus::kTooFewPoints;
    return slope;
  }
  workspace.marks.resize(static_cast<std::size_t>(input.grid.geometry.array_size()), 0);
  Surface surface;
  surface.centre = centre_of(self);
  surface.origin = self.sensor();
  surface.ground.offset = surface.centre.z();
  workspace.surface.resize(0);
  draw_sample(self, points, surface.centre, workspace.sample);
  RandomGenerator random(seed, cluster);
  BeamPlaneFit fit, ground;
  double explained = 0.0;
  const bool fitted = fit_surface(self, random, fit, ground, surface, explained);
  clear_marks(self, 0xFF);
  slope.iterations = params.hypotheses;
  if (!fitted) {
    slope.status = FeatureStatus::kDegenerate;
    return slope;
  }
  report_plane(fit, surface.centre, slope);
  report_ground(fit, ground, surface.centre, params.max_angle_sigma, slope.to_ground);
  const double cosine = fit.plane.normal.dot((surface.centre - surface.origin).normalized());
  const double across = fit.range_sigma * std::hypot(cosine, kAcrossBeam);
  const bool planar =
      explained >= params.least_share * static_cast<double>(points) && across <= params.max_scatter;
  const bool certain = fit.converged && slope.angle_sigma <= params.max_angle_sigma;
  slope.status = !planar   ? FeatureStatus::kNotPlanar
                 : certain ? FeatureStatus::kOk
                           : FeatureStatus::kUncertain;
  return slope;
}

}  // namespace mrpt_terrain
