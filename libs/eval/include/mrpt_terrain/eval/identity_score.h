// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mrpt_terrain/eval/cluster_score.h"
#include "mrpt_terrain/eval/support_score.h"

namespace mrpt_terrain::eval {

struct IdentityScore {
  std::size_t objects = 0;  ///< that count in at least two of the scans
  Share kept;               ///< scans in which an object counts: it has its own identity there
  Share kept_where_found;   ///< the same of the scans in which it was found
  void add(const IdentityScore& other);
};

/// Identities that the things of one world had, scan by scan. The identity of an object is the one
/// that its cluster had most often, the first of those in order of scans.
class IdentityHistory {
 public:
  /// \param identities of the clusters of the scan
  void add_scan(const ClusterMatching& matching, const std::vector<std::uint64_t>& identities);
  [[nodiscard]] IdentityScore score() const;

 private:
  struct Sight {
    std::int32_t thing;
    std::uint64_t identity;  ///< 0: not found
  };
  std::vector<Sight> sights_;  ///< in the order of scans
};

}  // namespace mrpt_terrain::eval
