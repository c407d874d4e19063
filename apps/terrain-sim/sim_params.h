// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mrpt_terrain/sensors/sensor_noise.h"
#include "mrpt_terrain/sim/vehicle.h"
#include "odometry.h"

/// What `--set SECTION.KEY=VALUE` can change.
struct SimParams {
  mrpt_terrain::sensors::SensorNoise noise;
  mrpt_terrain::sim::VehicleParams vehicle;
  OdometryParams odometry;

  template <class Self, class Visitor>
  static void visit_sections(Self& self, Visitor&& visit) {
    visit(self.noise, "noise", "How the sensor differs from a perfect one");
    visit(self.vehicle, "vehicle", "Wheels of the vehicle, mounting of the sensor");
    visit(self.odometry, "odometry", "How the wheels count");
  }
};
