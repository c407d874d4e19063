// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/obs/CObservation.h>
#include <mrpt/poses/CPose3D.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mrpt_terrain/core/param_info.h"
#include "mrpt_terrain/core/points.h"
#include "mrpt_terrain/io/trajectory.h"
#include "mrpt_terrain/sensors/sensor_model.h"

namespace mrpt_terrain::io {

/// How observations become points.
struct InputParams {
  double min_range = 0.3;    ///< metres from the sensor; closer points are the robot itself
  double max_range = 200.0;  ///< metres
  int depth_decimation = 1;  ///< every n-th row and column of depth images
  bool deskew = true;        ///< undo the motion during the sweep where times and poses are known

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.min_range,
          ParamInfo{"min_range", "", "m", 0.0, 1000.0, "points closer to the sensor are left out"});
    visit(self.max_range, ParamInfo{"max_range", "", "m", 0.0, 10000.0,
                                    "points farther from the sensor are left out"});
    visit(self.depth_decimation, ParamInfo{"depth_decimation", "", "", 1, 64,
                                           "uses every n-th row and column of depth images"});
    visit(self.deskew,
          ParamInfo{"deskew", "", "", 0, 0,
                    "undoes the motion during a sweep where times and poses are known"});
  }
};

/// What became of the returns of one observation; `points` is what was handed on.
struct ReturnCounts {
  std::size_t points = 0;
  std::size_t no_return = 0;  ///< zero returns and rays flagged invalid
  std::size_t not_finite = 0;
  std::size_t out_of_range = 0;  ///< closer than min_range or farther than max_range
};

/// Points of one observation in the sensor's own frame.
struct SensorPoints {
  Points points;
  /// Per point: seconds after the observation's time stamp (finite, may be negative); empty where
  /// the sensor does not give it.
  std::vector<float> time;
  /// Per point: its place in the sensor's own order (all slots counted, zero returns and invalid
  /// rays included), so that labels and predictions can be put beside the original data.
  std::vector<std::uint32_t> source_index;
  std::size_t source_size = 0;  ///< number of slots of the observation
  mrpt::poses::CPose3D T_robot_sensor;
  double stamp = 0.0;  ///< seconds since the Unix epoch; NaN if the observation has no time stamp
  ReturnCounts counts;

  /// Empties everything and keeps the memory.
  void clear();
};

/// Whether an observation could be turned into points, and if not, why.
enum class ConversionStatus : std::uint8_t {
  kOk = 0,
  kNoGeometry,    ///< a class without 3D points (GPS, IMU, image, ...)
  kNoPoints,      ///< a class with points, but this one holds none
  kUnknownModel,  ///< CObservationRotatingScan of a sensor without a model table
  kPlanarScan,    ///< one horizontal scan plane: says nothing about the ground
  kLoadFailed,    ///< externally stored data could not be read
};
constexpr EnumNames<ConversionStatus, 6> enum_names(ConversionStatus) {
  return {{{ConversionStatus::kOk, "ok"},
           {ConversionStatus::kNoGeometry, "no_geometry"},
           {ConversionStatus::kNoPoints, "no_points"},
           {ConversionStatus::kUnknownModel, "unknown_model"},
           {ConversionStatus::kPlanarScan, "planar_scan"},
           {ConversionStatus::kLoadFailed, "load_failed"}}};
}

struct Conversion {
  ConversionStatus status = ConversionStatus::kNoGeometry;
  std::string reason;  ///< for people: class, sensor label and what to do; empty when ok
};

/// Turns any supported observation into points in its sensor frame: CObservationVelodyneScan,
/// CObservationPointCloud, CObservation3DRangeScan, CObservationRotatingScan,
/// CObservation2DRangeScan. Loads externally stored data and unloads what it loaded.
Conversion convert_observation(const mrpt::obs::CObservation& observation,
                               const InputParams& params, const sensors::SensorModels& models,
                               SensorPoints& result);

/// Memory that `to_robot_frame` reuses from scan to scan; means nothing to anyone else.
struct DeskewScratch {
  struct Segment {  ///< of the path, times in seconds after the scan's stamp
    double begin, end, angle;
    std::array<double, 12> constant, linear, sine, versine;
  };
  struct Bin {
    float time;
    std::uint32_t firing;
  };
  std::vector<Segment> segments;
  std::vector<Bin> bins;
  std::vector<std::array<float, 12>> T_robot_sensor;  ///< per firing, 3x4, row by row
};

/// One scan in the robot frame at its reference time (the observation's time stamp), ready for
/// `describe` and for ray casting.
struct Scan {
  Points points;  ///< robot frame, metres
  /// Origins of the rays, robot frame, metres: one, or one per firing time of a de-skewed scan.
  std::vector<std::array<float, 3>> ray_origins;
  std::vector<std::uint32_t> origin_of;  ///< per point: its ray's origin; empty: all the first one
  std::vector<std::uint32_t> source_index;
  std::size_t source_size = 0;
  double stamp = 0.0;
  std::optional<mrpt::poses::CPose3D> T_map_robot;  ///< at `stamp`, when poses are known
  bool deskewed = false;
  ReturnCounts counts;
  DeskewScratch scratch;
};

/// Puts points into the robot frame with the sensor's pose; undoes the motion of the robot during
/// the sweep if `params.deskew`, the points have times, and the trajectory covers them all.
/// \param trajectory of the robot; may be null
void to_robot_frame(const SensorPoints& sensor, const Trajectory* trajectory,
                    const InputParams& params, Scan& scan);

}  // namespace mrpt_terrain::io
