// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <utility>
#include <vector>

#include "mrpt_terrain/core/describe.h"
#include "mrpt_terrain/core/param_info.h"

namespace mrpt_terrain {

/// How things of one scan are found again in the next.
struct TrackingParams {
  double memory = 5.0;       ///< seconds for which a thing is remembered that is not seen
  double margin = 0.15;      ///< metres by which boxes are grown on all sides
  double least_share = 0.2;  ///< of the smaller box that must be common to both
  double height_gap = 0.5;   ///< metres between the heights of both

  template <class Self, class Visitor>
  static void visit_params(Self& self, Visitor&& visit) {
    visit(self.memory, ParamInfo{"memory", "", "s", 0.0, 1e6,
                                 "how long a thing is remembered that is not seen"});
    visit(self.margin,
          ParamInfo{"margin", "", "m", 0.0, 10.0, "by which boxes are grown on all sides"});
    visit(self.least_share, ParamInfo{"least_share", "", "", 0.0, 1.0,
                                      "least share of the smaller box that is common to both"});
    visit(self.height_gap,
          ParamInfo{"height_gap", "", "m", 0.0, 100.0, "greatest gap between the heights of both"});
  }
};

/// Area that two boxes share seen from above, m^2, each grown by `margin` metres on all sides.
[[nodiscard]] double common_area(const OrientedBox& a, const OrientedBox& b, double margin);

/// A box in another frame. Its sides stay horizontal: roll and pitch of the frame only move it.
[[nodiscard]] OrientedBox moved(const OrientedBox& box, const Eigen::Isometry3d& T_to_from);

/// Gives things numbers that they keep from scan to scan.
///
/// Pairs of a thing and a remembered one whose boxes, in the map frame, share enough area and
/// height are taken in the order of their intersection over union, the largest first; each has one
/// partner at most. So when a thing splits, the part that is most like it keeps the number, and
/// when two merge, the one that is most like both; the other is remembered for a while and finds
/// its number again when they part. Classes do not matter. Equal pairs are taken in the order of
/// numbers.
class ThingTracker {
 public:
  explicit ThingTracker(const TrackingParams& params = {}) : params_(params) {}

  /// Identities of the things of a scan, in their order; never 0, never used again.
  /// \param stamp of the scan, seconds; not before that of the last one
  const std::vector<std::uint64_t>& update(const std::vector<ClusterDescription>& things,
                                           const Eigen::Isometry3d& T_map_robot, double stamp);

  /// A thing that is remembered.
  struct Track {
    std::uint64_t identity = 0;
    OrientedBox box;    ///< map frame
    double seen = 0.0;  ///< stamp of the last scan that showed it, seconds
  };
  /// All that `update` depends on besides its arguments: for copies and files.
  struct State {
    std::uint64_t next = 1;     ///< identity that is given out next
    std::vector<Track> tracks;  ///< by identity
  };
  [[nodiscard]] const State& state() const { return state_; }
  /// Goes on from a state of this or another tracker.
  /// \param state its tracks in the order of their identities, all below `next`
  void restore(State state) { state_ = std::move(state); }

  /// Forgets all things. Their identities are not used again.
  void forget() { state_.tracks.clear(); }

  /// Things that are remembered.
  [[nodiscard]] std::size_t remembered() const { return state_.tracks.size(); }

 private:
  struct Pair {
    double likeness;
    std::size_t track, thing;
  };
  void find_pairs();
  void take_pairs(double stamp);

  TrackingParams params_;
  State state_;
  std::vector<OrientedBox> boxes_;
  std::vector<Pair> pairs_;
  std::vector<std::uint8_t> taken_;  ///< per track
  std::vector<std::uint64_t> identities_;
};

}  // namespace mrpt_terrain
