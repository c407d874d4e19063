// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mrpt_terrain/sim/ray_caster.h"
#include "triangle_set.h"

namespace mrpt_terrain::sim {

/// A length of a ray, from the origin: [begin, end] in metres, empty unless begin < end.
struct PathSpan {
  double begin = 0.0;
  double end = 0.0;
};

/// Where a ray is inside of the ellipsoid of a medium, or above and below the rectangle of a layer.
[[nodiscard]] PathSpan span_inside(const Medium& medium, const Eigen::Vector3d& origin,
                                   const Eigen::Vector3d& direction);

/// Rays of one call to `RayCaster::scatter`.
struct ScatteredRays {
  const Rays& rays;
  double max_range;
  std::uint64_t seed;
  std::uint64_t first_number;
};

/// Lets rays return from within a medium after a random free path, if that ends before their hit.
/// \param terrain what layers stand on
void scatter_in(const Medium& medium, const TriangleSet& terrain, const ScatteredRays& rays,
                Hits& hits);

}  // namespace mrpt_terrain::sim
