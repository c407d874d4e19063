// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "mrpt_terrain/core/param_info.h"

namespace mrpt_terrain::sensors {

/// What separates the ranges of a real sensor from those of a perfect one. All zero (and one ray
/// per beam): a perfect sensor.
///
/// The standard deviation of a range r met at the angle of incidence a is
/// (range_sigma + range_growth * r) * (1 + incidence_growth * (min(1 / cos a, incidence_limit)
/// - 1)).
struct SensorNoise {
  double range_sigma = 0.0;   ///< metres, straight on
  double range_growth = 0.0;  ///< metres per metre of range
  double incidence_growth = 0.0;
  double incidence_limit = 4.0;
  double ring_bias_sigma = 0.0;  ///< metres; one constant offset per ring and unit
  std::uint64_t unit_seed = 1;  ///< which unit of the model it is: decides the offsets of the rings
  double range_quantum = 0.0;   ///< metres; ranges are whole multiples of it
  double beam_divergence = 0.0;  ///< full angle, radians
  /// 1: a beam is a line; 5: a line and four on the cone of the divergence, so that edges and
  /// grazing surfaces are smeared.
  int sub_rays = 1;
  double pulse_length = 0.5;  ///< metres; echoes closer together than this become one
  double dropout = 0.0;       ///< share of returns that are lost whatever they come from
  /// Metres: where half of the returns from a surface of 10 % reflectivity, seen straight on, are
  /// lost. Darker, farther and more oblique ones are lost more often. 0: no such loss.
  double detection_range = 0.0;

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.range_sigma,
          ParamInfo{"range_sigma", "", "m", 0.0, 1.0, "standard deviation of a range at 0 m"});
    visit(self.range_growth, ParamInfo{"range_growth", "", "", 0.0, 0.1,
                                       "growth of the standard deviation per metre of range"});
    visit(self.incidence_growth,
          ParamInfo{"incidence_growth", "", "", 0.0, 10.0,
                    "growth of the standard deviation with 1 / cos of the angle of incidence"});
    visit(self.incidence_limit,
          ParamInfo{"incidence_limit", "", "", 1.0, 100.0, "greatest 1 / cos that counts"});
    visit(self.ring_bias_sigma,
          ParamInfo{"ring_bias_sigma", "", "m", 0.0, 1.0, "spread of the rings' constant offsets"});
    visit(self.unit_seed, ParamInfo{"unit_seed", "", "", 0, 9e15, "which unit of the model"});
    visit(self.range_quantum,
          ParamInfo{"range_quantum", "", "m", 0.0, 1.0, "ranges are whole multiples of it"});
    visit(self.beam_divergence,
          ParamInfo{"beam_divergence_deg", "", "deg", 0.0, 5.0, "full angle of the beam"});
    visit(self.sub_rays, ParamInfo{"sub_rays", "", "", 1, 5, "rays per beam, 1 or 5"});
    visit(self.pulse_length, ParamInfo{"pulse_length", "", "m", 0.0, 10.0,
                                       "echoes closer together than this become one"});
    visit(self.dropout, ParamInfo{"dropout", "", "", 0.0, 1.0, "share of returns lost at random"});
    visit(self.detection_range,
          ParamInfo{"detection_range", "", "m", 0.0, 10000.0,
                    "where half the returns of a surface of 10 % reflectivity are lost; 0: off"});
  }
};

}  // namespace mrpt_terrain::sensors
