// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace mrpt_terrain::io {

/// Beam table of a rotating LiDAR.
struct SensorModel {
  std::string name;                  ///< as in CObservationRotatingScan::lidarModel
  std::vector<std::string> aliases;  ///< other names, compared without regard to case
  std::vector<double> elevation;     ///< per ring, in the order of the sensor's rows, radians, up > 0
  double max_range = 0.0;            ///< metres
};

/// All known sensor models.
class SensorModels {
 public:
  /// Reads every .yaml file of a folder; throws std::runtime_error "file: what is wrong".
  [[nodiscard]] static SensorModels from_folder(const std::string& folder);
  void add(SensorModel model);
  /// The model of that name or alias (case ignored), or null.
  [[nodiscard]] const SensorModel* find(const std::string& name) const;
  [[nodiscard]] const std::vector<SensorModel>& all() const { return models_; }

 private:
  std::vector<SensorModel> models_;
};

}  // namespace mrpt_terrain::io
