// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>

namespace mrpt_terrain {

/// Four numbers that are worked on at once; on all processors with the same bits.
typedef float FourFloats __attribute__((vector_size(4 * sizeof(float))));

/// Of (x, y, z, ...): the first factors of the products xy, xz and yz, and the second ones.
[[nodiscard]] inline FourFloats first_factors(const FourFloats& v) {
  return FourFloats{v[0], v[2], v[2], v[3]};
}
[[nodiscard]] inline FourFloats second_factors(const FourFloats& v) {
  return FourFloats{v[1], v[0], v[1], v[3]};
}

/// Sums of points about some centre, in single precision: for small neighbourhoods, where centre
/// and points are near each other.
struct HeightSums {
  FourFloats sum{};       ///< of x, y, z and 1
  FourFloats squares{};   ///< of xx, yy, zz; the fourth means nothing
  FourFloats products{};  ///< of xy, xz, yz; the fourth means nothing

  [[nodiscard]] float n() const { return sum[3]; }

  void add(float px, float py, float pz) { add_weighted(FourFloats{px, py, pz, 1.0F}, 1.0F); }

  /// Adds a point, (x, y, z, 1), that counts `weight` times.
  void add_weighted(const FourFloats& p, float weight) {
    const FourFloats weighted = weight * p;
    sum += weighted;
    squares += weighted * p;
    products += first_factors(weighted) * second_factors(p);
  }

  /// Adds sums whose centre lies at (dx, dy, dz) from this one.
  void add_shifted(const HeightSums& from, float dx, float dy, float dz) {
    const FourFloats shift{dx, dy, dz, 0.0F};
    const FourFloats shifted = from.sum + from.n() * shift;
    sum += shifted;
    squares += from.squares + shift * (from.sum + shifted);
    products += from.products + first_factors(shift) * second_factors(from.sum) +
                second_factors(shift) * first_factors(shifted);
  }
};

/// Means and covariances of at least one point, about the sums' centre.
struct HeightMoments {
  FourFloats mean;         ///< x, y, z; the fourth means nothing, nor do those below
  FourFloats variances;    ///< xx, yy, zz
  FourFloats covariances;  ///< xy, xz, yz

  explicit HeightMoments(const HeightSums& s)
      : mean(s.sum / s.n()),
        variances(s.squares / s.n() - mean * mean),
        covariances(s.products / s.n() - first_factors(mean) * second_factors(mean)) {}
};

/// Plane z = mean_z + gradient_x (x - mean_x) + gradient_y (y - mean_y), about the sums' centre.
struct SumsPlane {
  float mean_x, mean_y, mean_z;
  float gradient_x, gradient_y;
  float variance;  ///< mean square of the differences in z, m^2

  /// Height at the sums' centre.
  [[nodiscard]] float at_centre() const {
    return mean_z - gradient_x * mean_x - gradient_y * mean_y;
  }
};

/// Plane of least squares through at least one point.
/// \param hold m^2, > 0: added to the variances in x and y; holds the gradient to zero in
/// directions in which the points do not spread
[[nodiscard]] inline SumsPlane fit_plane(const HeightSums& s, float hold) {
  const HeightMoments m(s);
  const float x = m.mean[0], y = m.mean[1], z = m.mean[2];
  const float xx = m.variances[0], yy = m.variances[1], zz = m.variances[2];
  const float xy = m.covariances[0], xz = m.covariances[1], yz = m.covariances[2];
  const float determinant = (xx + hold) * (yy + hold) - xy * xy;
  const float gx = (xz * (yy + hold) - yz * xy) / determinant;
  const float gy = (yz * (xx + hold) - xz * xy) / determinant;
  const float variance =
      zz - 2.0F * (gx * xz + gy * yz) + gx * gx * xx + 2.0F * gx * gy * xy + gy * gy * yy;
  return {x, y, z, gx, gy, std::max(variance, 0.0F)};
}

/// Variance along a direction that is left where the coordinates across it have explained what they
/// can: 1 / (b' C^-1 b), C the covariance. Zero for points of a plane or of a line, whatever way it
/// runs, but for a direction in it; that of the noise for points of a volume. So beams that end at
/// a surface leave their range noise along them, even where one ring alone is seen, and beams that
/// go on into grass leave how far they go. \param v,c variances and covariances as in
/// `HeightMoments`, m^2 \param b direction, of length 1
[[nodiscard]] inline float variance_along(const FourFloats& v, const FourFloats& c,
                                          const std::array<float, 3>& b) {
  constexpr float kNoise = 1e-5F;  // m^2: gives planes and lines a volume
  const FourFloats d = v + kNoise;
  const float xx = d[1] * d[2] - c[2] * c[2], yy = d[0] * d[2] - c[1] * c[1];
  const float zz = d[0] * d[1] - c[0] * c[0];
  const float xy = c[1] * c[2] - c[0] * d[2], xz = c[0] * c[2] - c[1] * d[1];
  const float yz = c[0] * c[1] - c[2] * d[0];
  const float determinant = d[0] * xx + c[0] * xy + c[1] * xz;
  const float across = b[0] * b[0] * xx + b[1] * b[1] * yy + b[2] * b[2] * zz +
                       2.0F * (b[0] * b[1] * xy + b[0] * b[2] * xz + b[1] * b[2] * yz);
  return across > 0.0F ? std::max(determinant, 0.0F) / across : 0.0F;
}

}  // namespace mrpt_terrain
