// SPDX-License-Identifier: BSD-3-Clause
#include <mrpt/core/Clock.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/obs/CSensoryFrame.h>

#include "mrpt_terrain/io/object_stream.h"

namespace mrpt_terrain::io {
namespace {

using mrpt::poses::CPose3D;

bool is_known(mrpt::Clock::time_point stamp) { return stamp != INVALID_TIMESTAMP; }

/// Collects the candidates of a rawlog side by side, since only its end tells which one counts.
class PoseCollector {
 public:
  void take(const mrpt::serialization::CSerializable& object) {
    if (const auto* actions = dynamic_cast<const mrpt::obs::CActionCollection*>(&object)) {
      take_actions(*actions);
    } else if (const auto* frame = dynamic_cast<const mrpt::obs::CSensoryFrame*>(&object)) {
      for (const auto& observation : *frame) {
        if (observation) take_observation(*observation);
      }
    } else if (const auto* single = dynamic_cast<const mrpt::obs::CObservation*>(&object)) {
      take_observation(*single);
    }
  }

  Trajectory best(PoseSource& source) {
    if (!robot_poses_.empty()) {
      source = PoseSource::kRobotPose;
      return std::move(robot_poses_);
    }
    if (!odometry_.empty()) {
      source = PoseSource::kOdometry;
      return std::move(odometry_);
    }
    source = actions_.empty() ? PoseSource::kNone : PoseSource::kActions;
    return std::move(actions_);
  }

 private:
  void take_actions(const mrpt::obs::CActionCollection& actions) {
    CPose3D increment;
    if (const auto in_3d = actions.getActionByClass<mrpt::obs::CActionRobotMovement3D>()) {
      in_3d->poseChange.getMean(increment);
      move(increment, in_3d->timestamp);
    } else if (const auto in_2d = actions.getBestMovementEstimation()) {
      move(CPose3D(in_2d->poseChange->getMeanVal()), in_2d->timestamp);
    }
  }

  void move(const CPose3D& increment, mrpt::Clock::time_point stamp) {
    T_start_robot_ = T_start_robot_ + increment;
    waits_for_stamp_ = !is_known(stamp);
    if (!waits_for_stamp_) actions_.add(mrpt::Clock::toDouble(stamp), T_start_robot_);
  }

  void take_observation(const mrpt::obs::CObservation& observation) {
    if (!is_known(observation.timestamp)) return;
    const double stamp = mrpt::Clock::toDouble(observation.timestamp);
    if (waits_for_stamp_) {
      actions_.add(stamp, T_start_robot_);
      waits_for_stamp_ = false;
    }
    if (const auto* pose = dynamic_cast<const mrpt::obs::CObservationRobotPose*>(&observation)) {
      robot_poses_.add(stamp, pose->pose.getMeanVal());
    } else if (const auto* odometry =
                   dynamic_cast<const mrpt::obs::CObservationOdometry*>(&observation)) {
      odometry_.add(stamp, CPose3D(odometry->odometry));
    }
  }

  Trajectory robot_poses_, odometry_, actions_;
  CPose3D T_start_robot_;
  bool waits_for_stamp_ = false;  // the last action had none; the next observation gives it
};

/// Calls `next` until it says false or throws ReadError, what then goes to `damage`.
/// \return whether there is more
template <class Next>
bool has_next(const Next& next, std::string* damage) {
  if (damage == nullptr) return next();
  try {
    return next();
  } catch (const ReadError& error) {
    *damage = error.what();
    return false;
  }
}

Trajectory read_keyframes(const std::string& file, std::string* damage) {
  Trajectory keyframes;
  const auto reader = open_observations(file);
  ReadObservation read;
  std::optional<std::size_t> last;
  while (has_next([&] { return reader->next(read); }, damage)) {
    if (!read.T_map_robot || last == read.entry || !is_known(read.observation->timestamp)) continue;
    keyframes.add(mrpt::Clock::toDouble(read.observation->timestamp), *read.T_map_robot);
    last = read.entry;
  }
  return keyframes;
}

}  // namespace

Trajectory read_trajectory(const std::string& file, PoseSource& source, std::string* damage) {
  ObjectStream stream(file);
  const auto* id = mrpt::rtti::findRegisteredClass(stream.first_class());
  if (id != nullptr && id->derivedFrom(CLASS_ID(mrpt::maps::CSimpleMap))) {
    Trajectory keyframes = read_keyframes(file, damage);
    source = keyframes.empty() ? PoseSource::kNone : PoseSource::kKeyframes;
    return keyframes;
  }
  PoseCollector collector;
  StoredObject stored;
  while (has_next([&] { return stream.next(stored); }, damage)) {
    if (stored.object) collector.take(*stored.object);
  }
  return collector.best(source);
}

}  // namespace mrpt_terrain::io
