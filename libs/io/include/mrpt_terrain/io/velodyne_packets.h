// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/obs/CObservationVelodyneScan.h>

#include <cstdint>
#include <string>
#include <vector>

#include "mrpt_terrain/sensors/sensor_model.h"

namespace mrpt_terrain::io {

/// The returns of one turn of a Velodyne. Slot: column * lasers + laser, lasers in the order of the
/// model's rows.
struct VelodyneTurn {
  std::vector<float> range;             ///< per slot, metres; 0: no return
  std::vector<std::uint8_t> intensity;  ///< per slot
  double stamp = 0.0;                   ///< of the first column, seconds since the Unix epoch
};

/// Empty if turns of the model can be written as packets, otherwise the rule that it breaks: a
/// VLP-16, HDL-32E or HDL-64E by name, with that number of rows, and with rate and columns.
[[nodiscard]] std::string velodyne_problem(const sensors::SensorModel& model);

/// Writes a turn as the data packets that the sensor would send (Velodyne's user manuals): twelve
/// blocks of 32 returns each, ranges in units of 2 mm, azimuths of blocks in 0.01 deg clockwise,
/// microseconds since the full hour, single return mode. A VLP-16 has two columns in a block, an
/// HDL-32E one, an HDL-64E one in two blocks (upper and lower bank). The last packet is filled up
/// with empty blocks.
///
/// The observation carries the calibration that belongs to the model's rows, its angles rounded to
/// 1e-9 so that its bytes are the same on every machine. Slot s of the turn is slot s of what
/// `convert_observation` (scan.h) reads, azimuths are exact to 0.01 deg and times to 1 microsecond;
/// the packets of an HDL-64E have one time each, so that times are exact to 0.3 ms.
///
/// Ranges beyond 131.07 m are no returns. Throws std::invalid_argument with the text of
/// `velodyne_problem`, or if the number of slots is not that of the model.
[[nodiscard]] mrpt::obs::CObservationVelodyneScan encode_velodyne(const sensors::SensorModel& model,
                                                                  const VelodyneTurn& turn);

}  // namespace mrpt_terrain::io
