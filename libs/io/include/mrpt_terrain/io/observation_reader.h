// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/obs/CObservation.h>
#include <mrpt/poses/CPose3D.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "mrpt_terrain/io/trajectory.h"

namespace mrpt_terrain::io {

/// One observation out of a file.
struct ReadObservation {
  mrpt::obs::CObservation::Ptr observation;
  std::size_t entry = 0;  ///< index in the file as rawlog tools count (of the sensory frame, say)
  /// T_map_robot of a simple map's keyframe; rawlogs give poses through `read_trajectory`.
  std::optional<mrpt::poses::CPose3D> T_map_robot;
};

/// What a reader met so far.
struct ReadSummary {
  std::size_t entries = 0;
  std::map<std::string, std::size_t> observations;     ///< per class name
  std::map<std::string, std::size_t> unknown_classes;  ///< class names that MRPT does not know
  std::uint64_t skipped_bytes = 0;                     ///< of unknown or damaged objects
};

/// A file cannot be read or is damaged. The message names file, entry and byte position
/// (uncompressed) and says what was found there.
class ReadError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Streams the observations of a rawlog (either format, gzip or not) or of a simple map.
class ObservationReader {
 public:
  virtual ~ObservationReader() = default;
  /// Next observation, in the order of the file. False at its proper end. Throws ReadError where
  /// the file is cut off or damaged; everything before was delivered.
  virtual bool next(ReadObservation& result) = 0;
  [[nodiscard]] virtual const ReadSummary& summary() const = 0;
  /// How much of the file was read, 0 to 1, for progress bars.
  [[nodiscard]] virtual double progress() const = 0;
};

/// Opens a file by its content (`.rawlog`, `.simplemap`, also gzipped). Throws ReadError when it is
/// missing, empty, a folder, or neither of the two.
[[nodiscard]] std::unique_ptr<ObservationReader> open_observations(const std::string& file);

/// Where the poses of a trajectory came from.
enum class PoseSource : std::uint8_t { kNone, kRobotPose, kOdometry, kActions, kKeyframes };

/// Poses of the robot that the file itself holds, in one streaming pass: CObservationRobotPose if
/// there are any, else CObservationOdometry, else the increments of the actions, else keyframes.
/// \param[out] source which of them it was
/// \param[out] damage null: a damaged or cut-off file throws ReadError; else it gives the poses
/// before
///   the damage, and `damage` says what is wrong (unchanged if nothing is)
[[nodiscard]] Trajectory read_trajectory(const std::string& file, PoseSource& source,
                                         std::string* damage = nullptr);

}  // namespace mrpt_terrain::io
