// SPDX-License-Identifier: BSD-3-Clause
#include "echo.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mrpt_terrain/sim/sweep.h"

namespace mrpt_terrain::sim {
namespace {

constexpr std::size_t kMaxSubRays = 5;

/// Share of the beam's light in a ray: a Gaussian beam is weak at its edge.
double weight_of(std::size_t sub_ray, std::size_t sub_rays) {
  if (sub_rays == 1) return 1.0;
  return sub_ray == 0 ? 0.5 : 0.125;
}

}  // namespace

double reflectivity(Material material) {
  switch (material) {
    case Material::kAsphalt:
      return 0.17;
    case Material::kConcrete:
      return 0.35;
    case Material::kSoil:
      return 0.25;
    case Material::kGravel:
      return 0.30;
    case Material::kGrass:
    case Material::kFoliage:
      return 0.45;
    case Material::kWood:
      return 0.50;
    case Material::kBrick:
      return 0.40;
    case Material::kMetal:
      return 0.60;
    case Material::kPlastic:
      return 0.55;
    case Material::kCloth:
      return 0.40;
  }
  return 0.3;
}

double brightness(const World& world, std::int32_t solid, double cos_incidence) {
  // Rough surfaces send a share of light back whatever the angle; Lambert's law alone would leave
  // no ground beyond a few metres.
  constexpr double kBackscatter = 0.25;
  const Material material = world.solids[static_cast<std::size_t>(solid)].material;
  return reflectivity(material) * (kBackscatter + (1.0 - kBackscatter) * cos_incidence);
}

Echo strongest_echo(const World& world, const BeamHits& beam, double pulse_length) {
  Echo best;
  best.range = best.true_range = std::numeric_limits<double>::infinity();
  best.hit = beam.first;
  std::array<double, kMaxSubRays> range{}, strength{};
  for (std::size_t s = 0; s < beam.sub_rays; ++s) {
    const std::size_t hit = beam.first + s * beam.stride;
    range[s] = beam.hits.range[hit];
    if (!std::isfinite(range[s])) continue;
    strength[s] = weight_of(s, beam.sub_rays) *
                  brightness(world, beam.hits.solid[hit], beam.hits.cos_incidence[hit]);
  }
  // An echo begins at the range of one of its rays.
  for (std::size_t begin = 0; begin < beam.sub_rays; ++begin) {
    if (!std::isfinite(range[begin])) continue;
    double sum = 0.0, weighted = 0.0;
    std::size_t first = kMaxSubRays;
    for (std::size_t s = 0; s < beam.sub_rays; ++s) {
      if (!(range[s] >= range[begin] && range[s] <= range[begin] + pulse_length)) continue;
      sum += strength[s];
      weighted += strength[s] * (range[s] - range[begin]);
      if (first == kMaxSubRays) first = s;
    }
    if (sum <= best.strength) continue;
    best = {range[begin] + weighted / sum, range[first], beam.first + first * beam.stride, sum};
  }
  return best;
}

double normal_deviate(RandomGenerator& random) {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - random.uniform()));
  return radius * std::cos(2.0 * M_PI * random.uniform());
}

double measured_range(const sensors::SensorNoise& noise, const Echo& echo, double cos_incidence,
                      double bias, RandomGenerator& random) {
  const double deviate = normal_deviate(random);
  const double luck = random.uniform();
  if (!std::isfinite(echo.range)) return 0.0;
  if (luck < noise.dropout) return 0.0;
  if (noise.detection_range > 0.0) {
    // 1: as much light as from 10 % reflectivity straight on at the detection range.
    const double ratio = noise.detection_range / std::max(echo.range, 1e-3);
    const double light = echo.strength / 0.1 * ratio * ratio;
    const double lost = std::exp2(-light * light);
    if (luck < noise.dropout + (1.0 - noise.dropout) * lost) return 0.0;
  }
  const double slant = std::min(1.0 / std::max(cos_incidence, 1e-6), noise.incidence_limit);
  const double sigma = (noise.range_sigma + noise.range_growth * echo.range) *
                       (1.0 + noise.incidence_growth * (slant - 1.0));
  double range = echo.range + bias + sigma * deviate;
  if (noise.range_quantum > 0.0) {
    range = std::round(range / noise.range_quantum) * noise.range_quantum;
  }
  return std::max(range, 0.0);
}

std::uint8_t intensity_of(const Echo& echo) {
  // Sensors make up for range, but not all of it.
  constexpr double kHalfRange = 100.0;
  const double ratio = echo.range / kHalfRange;
  const double level = 255.0 * echo.strength / (1.0 + ratio * ratio);
  return static_cast<std::uint8_t>(std::clamp(std::round(level), 1.0, 255.0));
}

}  // namespace mrpt_terrain::sim
