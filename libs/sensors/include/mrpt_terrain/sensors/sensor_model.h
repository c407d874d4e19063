// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "mrpt_terrain/sensors/sensor_noise.h"

namespace mrpt_terrain::sensors {

/// Greatest number of rows that a beam table may have.
inline constexpr std::size_t kMaxSensorRows = 256;

/// A rotating LiDAR: beam table, timing, limits, noise. Its frame: x forward, y left, z along the
/// axis of rotation; azimuths count from x towards y.
///
/// The columns of a turn fire one after the other. The first one looks at `start_azimuth`; the head
/// turns towards `end_azimuth`: clockwise seen from above (azimuths fall) as Velodyne and Ouster
/// do, if that is the smaller one. In a full turn the end is the start again and the last column is
/// one step before it; in a shorter span the last column looks at the end. The rings of a column
/// fire `laser_interval` apart while the head turns on, so each has an azimuth of its own.
struct SensorModel {
  std::string name;                  ///< as in CObservationRotatingScan::lidarModel
  std::vector<std::string> aliases;  ///< other names, compared without regard to case
  std::vector<double> elevation;  ///< per ring, in the order of the sensor's rows, radians, up > 0
  double max_range = 0.0;         ///< metres
  double rate = 0.0;              ///< turns per second, nominal; 0: not given
  int columns = 0;                ///< firings per turn at that rate; 0: not given
  double laser_interval = 0.0;    ///< seconds between two rows of a column; 0: all fire at once
  double min_range = 0.0;         ///< metres; nearer returns are lost
  double start_azimuth = M_PI;    ///< of the first column, radians
  double end_azimuth = -M_PI;     ///< radians, at most one turn away
  std::vector<double> azimuth_offset{};  ///< per ring, added to its azimuth, radians; empty: none
  SensorNoise noise{};

  /// Whether rate and columns are known, without which no turn can be simulated.
  [[nodiscard]] bool has_timing() const { return rate > 0.0 && columns > 0; }
  [[nodiscard]] bool full_turn() const;
  /// Radians from one column to the next, negative if clockwise. Requires `has_timing()`.
  [[nodiscard]] double azimuth_step() const;
  /// Seconds from one column to the next. Requires `has_timing()`.
  [[nodiscard]] double column_interval() const;
  /// Radians per second, negative if clockwise. Requires `has_timing()`.
  [[nodiscard]] double turn_rate() const { return azimuth_step() / column_interval(); }
  /// Where a ring of a column looks, radians. Requires `has_timing()`.
  [[nodiscard]] double azimuth(std::size_t column, std::size_t ring) const;
  /// When it fires, seconds after the start of the turn. Requires `has_timing()`.
  [[nodiscard]] double firing_time(std::size_t column, std::size_t ring) const {
    return static_cast<double>(column) * column_interval() +
           static_cast<double>(ring) * laser_interval;
  }
};

/// Reads the file of one model, which has these keys: `name`, `elevation_deg` (1 to kMaxSensorRows
/// numbers), `max_range` in metres, and optionally `aliases`, `rate_hz`, `columns`,
/// `laser_interval_us`, `min_range`, `start_azimuth_deg`, `end_azimuth_deg`, `azimuth_offset_deg`
/// (a number per ring) and `noise` (a map, see SensorNoise). Throws std::runtime_error
/// "file:line: key: what is wrong" for other keys, keys given twice, missing ones and bad values.
[[nodiscard]] SensorModel load_sensor_model(const std::string& file);

/// All known sensor models.
class SensorModels {
 public:
  /// Reads every .yaml file of a folder with `load_sensor_model`. Throws std::runtime_error for
  /// those that are wrong and for names that two models claim.
  [[nodiscard]] static SensorModels from_folder(const std::string& folder);
  /// Adds a model; throws std::runtime_error if its name or an alias is taken already.
  void add(SensorModel model);
  /// The model of that name or alias (case ignored), or null.
  [[nodiscard]] const SensorModel* find(const std::string& name) const;
  [[nodiscard]] const std::vector<SensorModel>& all() const { return models_; }

 private:
  std::vector<SensorModel> models_;
};

/// The model of a name or alias among those of a folder, or that of a file if the name ends in
/// ".yaml". Throws std::runtime_error "source = 'name': ..." with the known names.
/// \param source beginning of the message, such as "scene.yaml:3: sensor"
[[nodiscard]] SensorModel resolve_sensor(const std::string& name_or_path, const std::string& folder,
                                         const std::string& source = "sensor");

}  // namespace mrpt_terrain::sensors
