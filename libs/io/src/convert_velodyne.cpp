// SPDX-License-Identifier: BSD-3-Clause
#include <mrpt/system/datetime.h>

#include <array>

#include "conversion.h"

/// \file
/// Decodes the packets itself: MRPT 2.5.8 reads only the first 16 of the 32 returns of a block,
/// which is every other firing of a VLP-16 and half of the rings of an HDL-32E, stamps whole
/// packets instead of firings, and prints to the standard error stream.
namespace mrpt_terrain::io {
namespace {

using Velodyne = mrpt::obs::CObservationVelodyneScan;
using Packet = Velodyne::TVelodyneRawPacket;
using Block = Velodyne::raw_block_t;

constexpr double kRadians = M_PI / 180.0;
constexpr std::size_t kReturns = Velodyne::SCANS_PER_BLOCK;
constexpr std::size_t kBlocks = Velodyne::BLOCKS_PER_PACKET;

/// Microseconds between the starts of two lasers, firings and blocks (Velodyne's user manuals of
/// VLP-16 and HDL-32E). The HDL-64E's depend on its firmware; its packets count as instants.
struct Timing {
  double laser, firing, block;
};
constexpr Timing kVlp16{2.304, 55.296, 110.592};
constexpr Timing kHdl32{1.152, 46.08, 46.08};
constexpr Timing kHdl64{0.0, 0.0, 0.0};

/// What all packets of an observation have in common.
struct Decoder {
  const Velodyne& observation;
  Timing timing;
  std::size_t lasers;
  PointSink& sink;

  [[nodiscard]] bool dual(const Packet& packet) const {
    return packet.laser_return_mode == Velodyne::RETMODE_DUAL;
  }
};

struct SinCos {
  double sin, cos;
};
using LaserAngles = std::array<SinCos, kReturns>;

SinCos sin_cos(double angle) { return {std::sin(angle), std::cos(angle)}; }

/// Seconds from the first packet to this one; the sensor's counter restarts every hour.
double packet_time(const Velodyne& observation, const Packet& packet) {
  constexpr std::int64_t kHour = 3'600'000'000;
  const std::int64_t first = observation.scan_packets.front().gps_timestamp();
  std::int64_t micros = static_cast<std::int64_t>(packet.gps_timestamp()) - first;
  if (micros < 0) micros += kHour;
  return static_cast<double>(micros) * 1e-6;
}

/// How far the head turns from one block to the next, in radians: the median within the packet,
/// since single steps are rounded.
double turn_per_block(const Packet& packet, std::size_t blocks_per_azimuth) {
  std::array<int, kBlocks> steps{};
  const std::size_t n = kBlocks - blocks_per_azimuth;
  for (std::size_t b = 0; b < n; ++b) {
    steps[b] = (packet.blocks[b + blocks_per_azimuth].rotation() - packet.blocks[b].rotation() +
                Velodyne::ROTATION_MAX_UNITS) %
               Velodyne::ROTATION_MAX_UNITS;
  }
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(n / 2);
  std::nth_element(steps.begin(), middle, steps.begin() + static_cast<std::ptrdiff_t>(n));
  return *middle * static_cast<double>(Velodyne::ROTATION_RESOLUTION) * kRadians;
}

/// Turn of the head between the start of a block and each of its returns.
LaserAngles laser_angles(const Decoder& decoder, const Packet& packet) {
  LaserAngles angles{};
  const Timing& timing = decoder.timing;
  const double turn = turn_per_block(packet, decoder.dual(packet) ? 2 : 1);
  const std::size_t per_firing = std::min(decoder.lasers, kReturns);
  for (std::size_t k = 0; k < kReturns; ++k) {
    const double micros = static_cast<double>(k % per_firing) * timing.laser +
                          static_cast<double>(k / per_firing) * timing.firing;
    angles[k] = sin_cos(timing.block > 0.0 ? turn * micros / timing.block : 0.0);
  }
  return angles;
}

/// One return at a distance and a direction of the head (clockwise, as Velodyne counts).
void add_return(const mrpt::obs::VelodyneCalibration::PerLaserCalib& laser, double distance,
                SinCos azimuth, std::size_t slot, float time, PointSink& sink) {
  if (laser.azimuthCorrection != 0.0) {
    const SinCos shift = sin_cos(laser.azimuthCorrection * kRadians);
    azimuth = {azimuth.sin * shift.cos - azimuth.cos * shift.sin,
               azimuth.cos * shift.cos + azimuth.sin * shift.sin};
  }
  const double level =
      distance * laser.cosVertCorrection + laser.verticalOffsetCorrection * laser.sinVertCorrection;
  const double side = laser.horizontalOffsetCorrection;
  sink.put(static_cast<float>(level * azimuth.cos + side * azimuth.sin),
           static_cast<float>(-level * azimuth.sin + side * azimuth.cos),
           static_cast<float>(distance * laser.sinVertCorrection + laser.verticalOffsetCorrection),
           slot, time);
}

/// \param repeats block whose returns the sensor repeats where it saw only one echo, or null
/// \param time of the block's first firing, seconds
void decode_block(const Decoder& decoder, const Block& block, const Block* repeats,
                  const LaserAngles& angles, double time, std::size_t first_slot) {
  const std::size_t bank = block.header() == Velodyne::LOWER_BANK ? kReturns : 0;
  const SinCos start = sin_cos(block.rotation() * 0.01 * kRadians);
  const std::size_t per_firing = std::min(decoder.lasers, kReturns);
  for (std::size_t k = 0; k < kReturns; ++k) {
    const auto raw = block.laser_returns[k].distance();
    if (raw == 0 || (repeats != nullptr && repeats->laser_returns[k].distance() == raw)) {
      decoder.sink.add_no_return();
      continue;
    }
    const auto& laser =
        decoder.observation.calibration.laser_corrections[(k + bank) % decoder.lasers];
    const double distance =
        raw * static_cast<double>(Velodyne::DISTANCE_RESOLUTION) + laser.distanceCorrection;
    if (!decoder.sink.accepts_range(distance)) continue;
    const SinCos azimuth{start.sin * angles[k].cos + start.cos * angles[k].sin,
                         start.cos * angles[k].cos - start.sin * angles[k].sin};
    // The lasers of a firing share its time: they start within 40 us, 1 mm at 25 m/s.
    const double firing = static_cast<double>(k / per_firing) * decoder.timing.firing * 1e-6;
    add_return(laser, distance, azimuth, first_slot + k, static_cast<float>(time + firing),
               decoder.sink);
  }
}

bool is_valid(const Decoder& decoder, const Block& block) {
  return block.header() == Velodyne::UPPER_BANK ||
         (block.header() == Velodyne::LOWER_BANK && decoder.lasers == 64);
}

void decode_packet(const Decoder& decoder, const Packet& packet, std::size_t first_slot) {
  const bool dual = decoder.dual(packet);
  const LaserAngles angles = laser_angles(decoder, packet);
  const double start = packet_time(decoder.observation, packet);
  for (std::size_t b = 0; b < kBlocks; ++b) {
    const Block& block = packet.blocks[b];
    if (!is_valid(decoder, block)) {
      for (std::size_t k = 0; k < kReturns; ++k) decoder.sink.add_no_return();
      continue;
    }
    const std::size_t firing = dual ? b / 2 : b;
    const double time = start + static_cast<double>(firing) * decoder.timing.block * 1e-6;
    const Block* repeats = dual && b % 2 == 1 ? &packet.blocks[b - 1] : nullptr;
    decode_block(decoder, block, repeats, angles, time, first_slot + b * kReturns);
  }
}

void decode_packets(const Velodyne& observation, const Timing& timing, const InputParams& params,
                    SensorPoints& result) {
  const auto& packets = observation.scan_packets;
  PointSink sink(result, packets.size() * kBlocks * kReturns,
                 limits_of(params, observation.minRange, observation.maxRange), true);
  const Decoder decoder{observation, timing, observation.calibration.laser_corrections.size(),
                        sink};
  for (std::size_t p = 0; p < packets.size(); ++p) {
    decode_packet(decoder, packets[p], p * kBlocks * kReturns);
  }
  sink.finish();
}

/// Takes over the points that somebody generated before.
void copy_point_cloud(const Velodyne& observation, const InputParams& params,
                      SensorPoints& result) {
  const auto& cloud = observation.point_cloud;
  const std::size_t n = std::min({cloud.x.size(), cloud.y.size(), cloud.z.size()});
  const bool timed = n > 0 && cloud.timestamp.size() == n;
  PointSink sink(result, n, limits_of(params, observation.minRange, observation.maxRange), timed);
  for (std::size_t k = 0; k < n; ++k) {
    const double time =
        timed ? mrpt::system::timeDifference(observation.timestamp, cloud.timestamp[k]) : 0.0;
    sink.add_point(cloud.x[k], cloud.y[k], cloud.z[k], k, static_cast<float>(time));
  }
  sink.finish();
}

}  // namespace

Conversion convert(const Velodyne& observation, const InputParams& params, SensorPoints& result) {
  if (observation.scan_packets.empty()) {
    copy_point_cloud(observation, params, result);
    return {ConversionStatus::kOk, {}};
  }
  const std::size_t lasers = observation.calibration.laser_corrections.size();
  if (lasers != 16 && lasers != 32 && lasers != 64) {
    return {ConversionStatus::kUnknownModel,
            name_of(observation) + " has raw packets and a calibration of " +
                std::to_string(lasers) + " lasers; packets of 16, 32 and 64 can be decoded"};
  }
  decode_packets(observation,
                 lasers == 16   ? kVlp16
                 : lasers == 32 ? kHdl32
                                : kHdl64,
                 params, result);
  return {ConversionStatus::kOk, {}};
}

}  // namespace mrpt_terrain::io
