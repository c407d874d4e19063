// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

#include "mrpt_terrain/core/random.h"
#include "mrpt_terrain/sensors/sensor_noise.h"
#include "mrpt_terrain/sim/ray_caster.h"

namespace mrpt_terrain::sim {

/// What a beam gets back, before noise.
struct Echo {
  double range = 0.0;       ///< metres; infinite: nothing
  double true_range = 0.0;  ///< of the ray that stands for the echo
  std::size_t hit = 0;      ///< of that ray
  double strength = 0.0;    ///< light that comes back, of a white surface straight on at 1
};

/// The hits of a beam's rays lie `stride` apart from `first` on.
struct BeamHits {
  const Hits& hits;
  std::size_t first;
  std::size_t stride;
  std::size_t sub_rays;
};

/// Share of light that a surface sends back, of a white one straight on, range apart.
[[nodiscard]] double brightness(const World& world, std::int32_t solid, double cos_incidence);

/// Joins the hits of a beam to its strongest echo.
[[nodiscard]] Echo strongest_echo(const World& world, const BeamHits& beam, double pulse_length);

/// One number of the standard normal distribution; takes two numbers of the generator.
[[nodiscard]] double normal_deviate(RandomGenerator& random);

/// What the sensor makes of an echo: noise, quantum and loss. Takes the same count of numbers of
/// the generator whatever the echo is.
/// \param bias of the ring, metres
/// \return measured range in metres, 0 if the return is lost
[[nodiscard]] double measured_range(const sensors::SensorNoise& noise, const Echo& echo,
                                    double cos_incidence, double bias, RandomGenerator& random);

/// Byte that the sensor reports for an echo.
[[nodiscard]] std::uint8_t intensity_of(const Echo& echo);

}  // namespace mrpt_terrain::sim
