// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace mrpt_terrain::sensors {

/// Greatest number of rows that a beam table may have.
inline constexpr std::size_t kMaxSensorRows = 256;

/// Beam table of a rotating LiDAR.
struct SensorModel {
  std::string name;                  ///< as in CObservationRotatingScan::lidarModel
  std::vector<std::string> aliases;  ///< other names, compared without regard to case
  std::vector<double> elevation;  ///< per ring, in the order of the sensor's rows, radians, up > 0
  double max_range = 0.0;         ///< metres
  double rate = 0.0;              ///< turns per second, nominal; 0: not given
  int columns = 0;                ///< firings per turn at that rate; 0: not given
  double laser_interval = 0.0;    ///< seconds between two rows of a column; 0: all fire at once
};

/// All known sensor models.
class SensorModels {
 public:
  /// Reads every .yaml file of a folder, each with these keys: `name`, `elevation_deg` (1 to
  /// kMaxSensorRows numbers), `max_range` in metres, and optionally `aliases`, `rate_hz`,
  /// `columns`, `laser_interval_us`. Throws std::runtime_error "file: key: what is wrong" for other
  /// keys, missing ones, bad values, and names that two models claim.
  [[nodiscard]] static SensorModels from_folder(const std::string& folder);
  /// Adds a model; throws std::runtime_error if its name or an alias is taken already.
  void add(SensorModel model);
  /// The model of that name or alias (case ignored), or null.
  [[nodiscard]] const SensorModel* find(const std::string& name) const;
  [[nodiscard]] const std::vector<SensorModel>& all() const { return models_; }

 private:
  std::vector<SensorModel> models_;
};

}  // namespace mrpt_terrain::sensors
