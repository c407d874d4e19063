// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/core/beam_plane.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>

#include "wide_registers.h"

namespace mrpt_terrain {
namespace {

constexpr std::size_t kLanes = BeamPoints::kPadding;
constexpr auto kAcrossSquared = static_cast<float>(kAcrossBeam * kAcrossBeam);
// E[w r^2] / E[w] of Tukey's weights over standard normal residuals r.
constexpr double kTukeyBias = 0.8924;
// A normal distribution has its absolute median at 0.6745 sigma.
constexpr double kSigmaOfMedian = 1.4826;
// Reciprocal condition number below which points span no plane.
constexpr double kLeastCondition = 1e-7;
// Radians; where points have no noise, the standard deviation of their plane is as good as zero.
constexpr double kNegligibleTurn = 1e-4;

typedef float Lanes __attribute__((vector_size(kLanes * sizeof(float))));
typedef std::int32_t IntLanes __attribute__((vector_size(kLanes * sizeof(std::int32_t))));

// By reference: passing vectors by value would depend on the instruction set.
inline void load(const std::vector<float>& array, std::size_t i, Lanes& lanes) {
  std::memcpy(&lanes, array.data() + i, sizeof(lanes));
}
inline void store(const Lanes& lanes, std::vector<float>& array, std::size_t i) {
  std::memcpy(array.data() + i, &lanes, sizeof(lanes));
}

/// Eight points and their beams.
struct PointLanes {
  Lanes x, y, z, dx, dy, dz;
};
inline void load(const BeamPoints& points, std::size_t i, PointLanes& lanes) {
  load(points.x, i, lanes.x);
  load(points.y, i, lanes.y);
  load(points.z, i, lanes.z);
  load(points.dx, i, lanes.dx);
  load(points.dy, i, lanes.dy);
  load(points.dz, i, lanes.dz);
}

/// What one pass over the points sums up. `matrix` and `vector` are those of the normal equations
/// of (normal, offset), at the points where the beams meet the plane.
struct BeamSums {
  enum : std::size_t {
    kXX,
    kXY,
    kXZ,
    kYY,
    kYZ,
    kZZ,
    kX,
    kY,
    kZ,
    kOne,  // of the matrix
    kEX,
    kEY,
    kEZ,
    kE,  // of the vector
    kWeight,
    kWeightedSquare,
    kPsiSquare,
    kPsiSlope,
    kInliers,
    kCount
  };
  std::array<double, kCount> value{};
};

struct PlaneLanes {
  float a, b, c, d;         // normal and offset
  float square_per_cutoff;  // 1 / (Tukey's constant * sigma)^2
};

// Eight points at a time, in eight sums each: the same bits with every width of registers.
MRPT_TERRAIN_WIDE_REGISTERS
void add_blocks(const BeamPoints& points, std::size_t stride, const PlaneLanes& plane,
                float (*sums)[kLanes]) {
  Lanes total[BeamSums::kCount] = {};
  const Lanes zero{};
  const Lanes one = zero + 1.0F;
  for (std::size_t i = 0; i < points.size; i += stride * kLanes) {
    PointLanes p;
    load(points, i, p);
    Lanes count;
    load(points.count, i, count);
    const Lanes e = plane.a * p.x + plane.b * p.y + plane.c * p.z + plane.d;
    const Lanes cosine = plane.a * p.dx + plane.b * p.dy + plane.c * p.dz;
    const Lanes inverse = one / (cosine * cosine + kAcrossSquared);
    const Lanes square = e * e * inverse * count;  // of the range residual of a single point
    const Lanes t = square * plane.square_per_cutoff;
    const Lanes inside = (t < one) & (count > zero) ? one - t : zero;
    const Lanes tukey = inside * inside;
    const Lanes weight = tukey * inverse * count;
    const Lanes along = cosine * e * inverse;
    const Lanes qx = p.x - p.dx * along;
    const Lanes qy = p.y - p.dy * along;
    const Lanes qz = p.z - p.dz * along;
    const Lanes wx = weight * qx;
    const Lanes wy = weight * qy;
    const Lanes wz = weight * qz;
    total[BeamSums::kXX] += wx * qx;
    total[BeamSums::kXY] += wx * qy;
    total[BeamSums::kXZ] += wx * qz;
    total[BeamSums::kYY] += wy * qy;
    total[BeamSums::kYZ] += wy * qz;
    total[BeamSums::kZZ] += wz * qz;
    total[BeamSums::kX] += wx;
    total[BeamSums::kY] += wy;
    total[BeamSums::kZ] += wz;
    total[BeamSums::kOne] += weight;
    total[BeamSums::kEX] += wx * e;
    total[BeamSums::kEY] += wy * e;
    total[BeamSums::kEZ] += wz * e;
    total[BeamSums::kE] += weight * e;
    total[BeamSums::kWeight] += tukey;
    total[BeamSums::kWeightedSquare] += tukey * square;
    total[BeamSums::kPsiSquare] += tukey * tukey * square;
    total[BeamSums::kPsiSlope] += inside * (one - 5.0F * t);
    total[BeamSums::kInliers] += inside > zero ? one : zero;
  }
  std::memcpy(sums, total, sizeof(total));
}

// Where cells lie, for the ids of a grid's padded arrays.
struct CellLanes {
  float x0, y0;  // of the centre of the points from the corner of the padded grid, metres
  float cells_per_metre;
  float last_l, last_w;  // greatest padded index, the frame's
  std::int32_t stride;
  float least_height;
};

MRPT_TERRAIN_WIDE_REGISTERS
void meet_blocks(const BeamPoints& points, std::size_t stride, const PlaneLanes& plane,
                 const PlaneLanes& ground, const CellLanes& grid, std::int32_t* cells) {
  const Lanes zero{};
  for (std::size_t i = 0; i < points.size; i += stride * kLanes) {
    PointLanes p;
    load(points, i, p);
    const Lanes e = plane.a * p.x + plane.b * p.y + plane.c * p.z + plane.d;
    const Lanes cosine = plane.a * p.dx + plane.b * p.dy + plane.c * p.dz;
    const Lanes along = cosine * e / (cosine * cosine + kAcrossSquared);
    const Lanes x = p.x - p.dx * along;
    const Lanes y = p.y - p.dy * along;
    const Lanes z = p.z - p.dz * along;
    const Lanes height = ground.a * x + ground.b * y + ground.c * z + ground.d;
    Lanes l = (x + grid.x0) * grid.cells_per_metre;
    Lanes w = (y + grid.y0) * grid.cells_per_metre;
    l = l > zero ? l : zero;
    l = l < grid.last_l ? l : zero + grid.last_l;
    w = w > zero ? w : zero;
    w = w < grid.last_w ? w : zero + grid.last_w;
    const IntLanes id =
        __builtin_convertvector(l, IntLanes) * grid.stride + __builtin_convertvector(w, IntLanes);
    const IntLanes high = (height >= grid.least_height) | (height <= -grid.least_height);
    const IntLanes result = id & high;
    std::memcpy(cells + i, &result, sizeof(result));
  }
}

MRPT_TERRAIN_WIDE_REGISTERS
void normalise_blocks(BeamPoints& points, std::size_t begin) {
  const Lanes zero{};
  const Lanes one = zero + 1.0F;
  for (std::size_t i = begin; i < points.size; i += kLanes) {
    PointLanes p;
    load(points, i, p);
    const Lanes square = p.dx * p.dx + p.dy * p.dy + p.dz * p.dz;
    float length[kLanes];
    std::memcpy(length, &square, sizeof(length));
    for (float& lane : length) lane = std::sqrt(lane);
    Lanes divisor;
    std::memcpy(&divisor, length, sizeof(divisor));
    const Lanes inverse = divisor > zero ? one / divisor : zero;
    store(p.dx * inverse, points.dx, i);
    store(p.dy * inverse, points.dy, i);
    store(p.dz * inverse, points.dz, i);
  }
}

PlaneLanes lanes_of(const BeamPlane& plane, double cutoff) {
  return {static_cast<float>(plane.normal.x()), static_cast<float>(plane.normal.y()),
          static_cast<float>(plane.normal.z()), static_cast<float>(plane.offset),
          static_cast<float>(1.0 / (cutoff * cutoff))};
}

BeamSums sum_up(const BeamPoints& points, std::size_t stride, const BeamPlane& plane,
                double sigma) {
  float sums[BeamSums::kCount][kLanes] = {};
  add_blocks(points, stride, lanes_of(plane, kTukey * sigma), sums);
  BeamSums result;
  for (std::size_t k = 0; k < BeamSums::kCount; ++k) {
    for (const float lane : sums[k]) result.value[k] += static_cast<double>(lane);
  }
  return result;
}

// Columns: the two directions in which the normal can turn, and the offset.
Eigen::Matrix<double, 4, 3> tangent_basis(const Eigen::Vector3d& normal) {
  Eigen::Matrix<double, 4, 3> basis = Eigen::Matrix<double, 4, 3>::Zero();
  basis.block<3, 1>(0, 0) = normal.unitOrthogonal();
  basis.block<3, 1>(0, 1) = normal.cross(basis.block<3, 1>(0, 0));
  basis(3, 2) = 1.0;
  return basis;
}

Eigen::Matrix4d matrix_of(const BeamSums& sums) {
  const auto& v = sums.value;
  Eigen::Matrix4d m;
  m << v[BeamSums::kXX], v[BeamSums::kXY], v[BeamSums::kXZ], v[BeamSums::kX],  //
      v[BeamSums::kXY], v[BeamSums::kYY], v[BeamSums::kYZ], v[BeamSums::kY],   //
      v[BeamSums::kXZ], v[BeamSums::kYZ], v[BeamSums::kZZ], v[BeamSums::kZ],   //
      v[BeamSums::kX], v[BeamSums::kY], v[BeamSums::kZ], v[BeamSums::kOne];
  return m;
}

// Inverse of a positive definite matrix; nothing if it is singular. The offset is scaled like the
// normal first, so that the condition number means the same near and far.
bool invert(const Eigen::Matrix3d& matrix, Eigen::Matrix3d& inverse) {
  const Eigen::Vector3d scale = matrix.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::Matrix3d scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  const Eigen::LLT<Eigen::Matrix3d> cholesky(scaled);
  if (cholesky.info() != Eigen::Success || !(cholesky.rcond() > kLeastCondition)) return false;
  inverse = scale.asDiagonal() * cholesky.solve(Eigen::Matrix3d::Identity()) * scale.asDiagonal();
  return true;
}

// Covariance of an M-estimate (Huber 1981): E[psi^2] / E[psi']^2 times the inverse information.
double variance_factor(const BeamSums& sums, double sigma) {
  const double n = sums.value[BeamSums::kInliers];
  const double slope = sums.value[BeamSums::kPsiSlope] / n;
  const double square = sums.value[BeamSums::kPsiSquare] / (n * sigma * sigma);
  const double mean_weight = sums.value[BeamSums::kWeight] / n;
  return square / (slope * slope) * mean_weight * sigma * sigma;
}

double sigma_from(const BeamSums& sums, double least_sigma) {
  const double square =
      sums.value[BeamSums::kWeightedSquare] / (kTukeyBias * sums.value[BeamSums::kWeight]);
  return std::max(least_sigma, std::sqrt(square));
}

}  // namespace

void BeamPoints::resize(std::size_t n) {
  size = n;
  const std::size_t padded = (n + kPadding - 1) / kPadding * kPadding;
  if (padded > x.size()) {
    for (auto* array : {&x, &y, &z, &dx, &dy, &dz, &count}) array->resize(padded);
  }
  std::fill(count.begin() + static_cast<std::ptrdiff_t>(n),
            count.begin() + static_cast<std::ptrdiff_t>(padded), 0.0F);
}

void BeamPoints::normalise_beams(std::size_t begin) {
  // A block that holds earlier points as well is done again; their directions stay what they are.
  normalise_blocks(*this, begin / kLanes * kLanes);
}

void find_meeting_cells(const BeamPoints& points, const BeamPlane& plane, const BeamPlane& ground,
                        double least_height, const GridGeometry& geometry,
                        const Eigen::Vector3d& centre, std::size_t stride,
                        std::vector<std::int32_t>& cells) {
  if (cells.size() < points.x.size()) cells.resize(points.x.size());
  const CellLanes grid{
      static_cast<float>(centre.x() + geometry.half_length() + geometry.cell_size()),
      static_cast<float>(centre.y() + geometry.half_width() + geometry.cell_size()),
      static_cast<float>(1.0 / geometry.cell_size()),
      static_cast<float>(geometry.cells_l() + 1),
      static_cast<float>(geometry.cells_w() + 1),
      geometry.stride(),
      static_cast<float>(least_height)};
  meet_blocks(points, stride, lanes_of(plane, 1.0), lanes_of(ground, 1.0), grid, cells.data());
}

BeamPlaneFit fit_beam_plane(const BeamPoints& points, const BeamPlane& start, double range_sigma,
                            double least_sigma, int steps, std::size_t stride) {
  BeamPlaneFit fit;
  fit.plane = start;
  fit.range_sigma = std::max(range_sigma, least_sigma);
  for (int step = 0; step < steps; ++step) {
    const BeamSums sums = sum_up(points, stride, fit.plane, fit.range_sigma);
    fit.inliers = static_cast<std::int32_t>(sums.value[BeamSums::kInliers]);
    if (fit.inliers < 4) return fit;
    const Eigen::Matrix<double, 4, 3> basis = tangent_basis(fit.plane.normal);
    Eigen::Matrix3d inverse;
    if (!invert(basis.transpose() * matrix_of(sums) * basis, inverse)) return fit;
    const Eigen::Vector4d gradient(sums.value[BeamSums::kEX], sums.value[BeamSums::kEY],
                                   sums.value[BeamSums::kEZ], sums.value[BeamSums::kE]);
    const Eigen::Vector4d update = -basis * (inverse * (basis.transpose() * gradient));
    const Eigen::Matrix<double, 3, 2> turn = basis.block<3, 2>(0, 0);
    fit.normal_covariance = variance_factor(sums, fit.range_sigma) * turn *
                            inverse.topLeftCorner<2, 2>() * turn.transpose();
    fit.converged = update.head<3>().squaredNorm() <=
                    std::max(fit.normal_covariance.trace(), kNegligibleTurn * kNegligibleTurn);
    const Eigen::Vector3d normal = fit.plane.normal + update.head<3>();
    const double length = normal.norm();
    fit.plane = {normal / length, (fit.plane.offset + update[3]) / length};
    fit.range_sigma = sigma_from(sums, least_sigma);
  }
  fit.ok = fit.plane.normal.allFinite();
  return fit;
}

double median_range_sigma(const BeamPoints& points, const BeamPlane& plane, std::size_t stride,
                          std::vector<float>& scratch) {
  scratch.clear();
  const Eigen::Vector3f normal = plane.normal.cast<float>();
  for (std::size_t i = 0; i < points.size; i += stride) {
    const float e = normal.dot(Eigen::Vector3f(points.x[i], points.y[i], points.z[i])) +
                    static_cast<float>(plane.offset);
    const float cosine = normal.dot(Eigen::Vector3f(points.dx[i], points.dy[i], points.dz[i]));
    scratch.push_back(points.count[i] * e * e / (cosine * cosine + kAcrossSquared));
  }
  if (scratch.empty()) return 0.0;
  const auto middle = scratch.begin() + static_cast<std::ptrdiff_t>(scratch.size() / 2);
  std::nth_element(scratch.begin(), middle, scratch.end());
  return kSigmaOfMedian * std::sqrt(static_cast<double>(*middle));
}

}  // namespace mrpt_terrain
