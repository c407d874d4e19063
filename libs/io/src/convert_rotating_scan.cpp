// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "conversion.h"

namespace mrpt_terrain::io {
namespace {

using RotatingScan = mrpt::obs::CObservationRotatingScan;

/// Where the columns of a range image look, and when. Angles are counter-clockwise, radians.
struct Columns {
  std::size_t used = 0;
  double first_azimuth = 0.0;
  double azimuth_step = 0.0;
  double time_step = 0.0;  ///< seconds; 0: not known
};

/// Whether MRPT's own conversion from Velodyne packets made this image. It reserves a column per
/// return of a packet, `rows` times as many as there are firings, and leaves the rest empty.
bool is_from_velodyne(const RotatingScan& scan, std::size_t rows, std::size_t columns) {
  constexpr std::size_t kReturnsPerPacket = 384;
  if (scan.lidarModel != "VLP-16" && scan.lidarModel != "HDL-32E") return false;
  if (columns % kReturnsPerPacket != 0 || columns % rows != 0) return false;
  const auto& image = scan.rangeImage;
  for (std::size_t row = 0; row < rows; ++row) {
    const std::uint16_t* ranges = image.data() + row * columns;
    if (std::any_of(ranges + columns / rows, ranges + columns, [](auto r) { return r != 0; })) {
      return false;
    }
  }
  return true;
}

Columns columns_of(const RotatingScan& scan, std::size_t rows, std::size_t columns) {
  if (is_from_velodyne(scan, rows, columns)) {
    // Dual returns share a column. The angles are Velodyne's, clockwise, whatever the sign says.
    const std::size_t used = columns / rows / (scan.rangeOtherLayers.empty() ? 1 : 2);
    const auto n = static_cast<double>(used);
    return {used, -scan.startAzimuth, -std::abs(scan.azimuthSpan) / n, scan.sweepDuration / n};
  }
  // The last column is at the end of the span; in a full turn that would be the first one again.
  const auto n = static_cast<double>(columns);
  const bool full_turn = std::abs(scan.azimuthSpan) >= 2.0 * M_PI * (1.0 - 0.5 / n);
  const double steps = full_turn ? n : std::max(1.0, n - 1.0);
  return {columns, scan.startAzimuth, scan.azimuthSpan / steps, scan.sweepDuration / steps};
}

/// Direction of a row: its elevation, and its turn within the column while lasers fire in turn.
struct RowDirection {
  double cos_elevation, sin_elevation, cos_shift, sin_shift;
};
using RowDirections = std::array<RowDirection, sensors::kMaxSensorRows>;

RowDirections row_directions(const sensors::SensorModel& model, const Columns& columns) {
  RowDirections rows{};
  const double turn_rate = columns.time_step > 0.0 ? columns.azimuth_step / columns.time_step : 0.0;
  for (std::size_t r = 0; r < model.elevation.size(); ++r) {
    const double offset = model.azimuth_offset.empty() ? 0.0 : model.azimuth_offset[r];
    const double shift = turn_rate * model.laser_interval * static_cast<double>(r) + offset;
    rows[r] = {std::cos(model.elevation[r]), std::sin(model.elevation[r]), std::cos(shift),
               std::sin(shift)};
  }
  return rows;
}

void unproject(const RotatingScan& scan, const sensors::SensorModel& model,
               const InputParams& params, SensorPoints& result) {
  const std::size_t rows = model.elevation.size();
  const auto width = static_cast<std::size_t>(scan.rangeImage.cols());
  const Columns columns = columns_of(scan, rows, width);
  const RowDirections directions = row_directions(model, columns);
  const bool timed = columns.time_step > 0.0;
  PointSink sink(result, rows * width, limits_of(params, scan.minRange, scan.maxRange), timed);
  // Column by column, so that points of one firing stay together.
  for (std::size_t c = 0; c < columns.used; ++c) {
    const double azimuth = columns.first_azimuth + columns.azimuth_step * static_cast<double>(c);
    const double cosine = std::cos(azimuth), sine = std::sin(azimuth);
    const auto time = static_cast<float>(columns.time_step * static_cast<double>(c));
    for (std::size_t r = 0; r < rows; ++r) {
      const std::uint16_t raw = scan.rangeImage.data()[r * width + c];
      if (raw == 0) {
        sink.add_no_return();
        continue;
      }
      const double range = raw * scan.rangeResolution;
      if (!sink.accepts_range(range)) continue;
      const RowDirection& row = directions[r];
      const double level = range * row.cos_elevation;
      sink.put(static_cast<float>(level * (cosine * row.cos_shift - sine * row.sin_shift)),
               static_cast<float>(level * (sine * row.cos_shift + cosine * row.sin_shift)),
               static_cast<float>(range * row.sin_elevation), r * width + c, time);
    }
  }
  sink.finish();
}

Conversion unknown_model(const RotatingScan& scan, const sensors::SensorModels& models) {
  std::string known;
  for (const auto& model : models.all()) {
    known += (known.empty() ? "" : ", ") + model.name + " (" +
             std::to_string(model.elevation.size()) + " rows)";
  }
  return {ConversionStatus::kUnknownModel,
          name_of(scan) + ": no beam table for model '" + scan.lidarModel + "' with " +
              std::to_string(scan.rangeImage.rows()) +
              " rows; add one to params/sensors (known: " + (known.empty() ? "none" : known) + ")"};
}

}  // namespace

Conversion convert(const RotatingScan& observation, const InputParams& params,
                   const sensors::SensorModels& models, SensorPoints& result) {
  const auto rows = static_cast<std::size_t>(observation.rangeImage.rows());
  if (rows == 0 || observation.rangeImage.cols() == 0) {
    return {ConversionStatus::kNoPoints, name_of(observation) + " has an empty range image"};
  }
  if (rows == 1) {
    if (is_level(observation.sensorPose)) return planar_scan(observation);
    unproject(observation,
              sensors::SensorModel{"planar", {}, {0.0}, observation.maxRange, 0.0, 0, 0.0}, params,
              result);
    return {ConversionStatus::kOk, {}};
  }
  const sensors::SensorModel* model = models.find(observation.lidarModel);
  if (model == nullptr || model->elevation.size() != rows || rows > sensors::kMaxSensorRows) {
    return unknown_model(observation, models);
  }
  unproject(observation, *model, params, result);
  return {ConversionStatus::kOk, {}};
}

}  // namespace mrpt_terrain::io
