// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/io/velodyne_packets.h"

#include <mrpt/core/Clock.h>

#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <stdexcept>

namespace mrpt_terrain::io {
namespace {

using Velodyne = mrpt::obs::CObservationVelodyneScan;
using Packet = Velodyne::TVelodyneRawPacket;

constexpr double kDegrees = 180.0 / M_PI;
constexpr std::size_t kReturns = Velodyne::SCANS_PER_BLOCK;
constexpr std::size_t kBlocks = Velodyne::BLOCKS_PER_PACKET;
constexpr std::size_t kBlockBytes = Velodyne::SIZE_BLOCK;
constexpr std::size_t kReturnBytes = Velodyne::RAW_SCAN_SIZE;
constexpr double kRangeUnit = 0.002;  // metres
constexpr double kMostUnits = 65535.0;

struct Format {
  const char* name;
  std::size_t lasers;
  std::uint8_t product;  ///< second factory byte
};
// The HDL-64E has status bytes in the place of the factory bytes; readers tell it by its banks.
constexpr std::array<Format, 3> kFormats{
    {{"VLP-16", 16, 0x22}, {"HDL-32E", 32, 0x21}, {"HDL-64E", 64, 0x00}}};

std::optional<Format> format_of(const sensors::SensorModel& model) {
  for (const Format& format : kFormats) {
    if (model.name == format.name) return format;
  }
  return std::nullopt;
}

/// A packet under construction, byte by byte: MRPT's fields are private and not aligned.
class PacketBytes {
 public:
  void put(std::size_t at, std::uint32_t value, std::size_t size) {
    for (std::size_t k = 0; k < size; ++k) {
      bytes_[at + k] = static_cast<std::uint8_t>(value >> (8 * k));
    }
  }
  [[nodiscard]] Packet packet() const {
    Packet result;
    static_assert(sizeof(result) == sizeof(bytes_));
    std::memcpy(static_cast<void*>(&result), bytes_.data(), sizeof(result));
    return result;
  }

 private:
  std::array<std::uint8_t, sizeof(Packet)> bytes_{};
};

std::uint32_t range_units(float range) {
  const double units = std::round(static_cast<double>(range) / kRangeUnit);
  return units >= 1.0 && units <= kMostUnits ? static_cast<std::uint32_t>(units) : 0;
}

/// Hundredths of a degree, clockwise. Columns behind the end of the turn go on turning.
std::uint32_t rotation(const sensors::SensorModel& model, std::size_t column) {
  const double azimuth = model.start_azimuth + static_cast<double>(column) * model.azimuth_step();
  const auto units = std::lround(-azimuth * kDegrees * 100.0);
  constexpr long kTurn = Velodyne::ROTATION_MAX_UNITS;
  return static_cast<std::uint32_t>((units % kTurn + kTurn) % kTurn);
}

/// Microseconds since the full hour.
std::uint32_t hour_micros(double stamp) {
  constexpr double kHour = 3600.0;
  const double seconds = stamp - std::floor(stamp / kHour) * kHour;
  return static_cast<std::uint32_t>(std::llround(seconds * 1e6) % 3'600'000'000LL);
}

/// First slot of a block.
std::size_t first_slot(std::size_t block) { return block * kReturns; }

std::size_t column_of(const Format& format, std::size_t block) {
  return first_slot(block) / format.lasers;
}

void put_block(const Format& format, const sensors::SensorModel& model, const VelodyneTurn& turn,
               std::size_t block, PacketBytes& bytes) {
  const std::size_t at = (block % kBlocks) * kBlockBytes;
  const bool lower = format.lasers == 64 && block % 2 == 1;
  bytes.put(at, lower ? Velodyne::LOWER_BANK : Velodyne::UPPER_BANK, 2);
  bytes.put(at + 2, rotation(model, column_of(format, block)), 2);
  for (std::size_t k = 0; k < kReturns; ++k) {
    const std::size_t slot = first_slot(block) + k;
    if (slot >= turn.range.size()) return;
    const std::uint32_t units = range_units(turn.range[slot]);
    if (units == 0) continue;
    bytes.put(at + 4 + k * kReturnBytes, units, 2);
    bytes.put(at + 6 + k * kReturnBytes, turn.intensity[slot], 1);
  }
}

Packet make_packet(const Format& format, const sensors::SensorModel& model,
                   const VelodyneTurn& turn, std::size_t first_block) {
  PacketBytes bytes;
  for (std::size_t b = 0; b < kBlocks; ++b) put_block(format, model, turn, first_block + b, bytes);
  const double after =
      static_cast<double>(column_of(format, first_block)) * model.column_interval();
  const std::size_t end = kBlocks * kBlockBytes;
  bytes.put(end, hour_micros(turn.stamp + after), 4);
  bytes.put(end + 4, Velodyne::RETMODE_STRONGEST, 1);
  bytes.put(end + 5, format.product, 1);
  return bytes.packet();
}

double rounded(double value) { return std::round(value * 1e9) / 1e9; }

mrpt::obs::VelodyneCalibration calibration_of(const sensors::SensorModel& model) {
  mrpt::obs::VelodyneCalibration calibration;
  calibration.laser_corrections.resize(model.elevation.size());
  for (std::size_t ring = 0; ring < model.elevation.size(); ++ring) {
    auto& laser = calibration.laser_corrections[ring];
    laser.verticalCorrection = rounded(model.elevation[ring] * kDegrees);
    laser.sinVertCorrection = rounded(std::sin(model.elevation[ring]));
    laser.cosVertCorrection = rounded(std::cos(model.elevation[ring]));
    if (!model.azimuth_offset.empty()) {
      laser.azimuthCorrection = rounded(model.azimuth_offset[ring] * kDegrees);
    }
  }
  return calibration;
}

}  // namespace

std::string velodyne_problem(const sensors::SensorModel& model) {
  const std::optional<Format> format = format_of(model);
  if (!format) {
    return "sensor " + model.name + ": has no packets; VLP-16, HDL-32E and HDL-64E have";
  }
  if (model.elevation.size() != format->lasers) {
    return "sensor " + model.name + ": has " + std::to_string(model.elevation.size()) +
           " rows; its packets hold " + std::to_string(format->lasers);
  }
  if (!model.has_timing()) return "sensor " + model.name + ": rate_hz and columns must be given";
  return {};
}

Velodyne encode_velodyne(const sensors::SensorModel& model, const VelodyneTurn& turn) {
  const std::string problem = velodyne_problem(model);
  if (!problem.empty()) throw std::invalid_argument(problem);
  const Format format = *format_of(model);
  const std::size_t slots = static_cast<std::size_t>(model.columns) * format.lasers;
  if (turn.range.size() != slots || turn.intensity.size() != slots) {
    throw std::invalid_argument("sensor " + model.name + ": a turn has " + std::to_string(slots) +
                                " slots, not " + std::to_string(turn.range.size()));
  }
  Velodyne scan;
  scan.timestamp = mrpt::Clock::fromDouble(turn.stamp);
  scan.originalReceivedTimestamp = scan.timestamp;
  scan.has_satellite_timestamp = true;
  // All that the packets can hold: noise may carry a range across the model's own limits.
  scan.minRange = 0.0;
  scan.maxRange = (kMostUnits + 0.5) * kRangeUnit;
  scan.calibration = calibration_of(model);
  const std::size_t blocks = (slots + kReturns - 1) / kReturns;
  for (std::size_t block = 0; block < blocks; block += kBlocks) {
    scan.scan_packets.push_back(make_packet(format, model, turn, block));
  }
  return scan;
}

}  // namespace mrpt_terrain::io
