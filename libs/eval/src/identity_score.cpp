// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/eval/identity_score.h"

#include <algorithm>
#include <map>

namespace mrpt_terrain::eval {
namespace {

// The identity that occurs most often, 0 not counted; of equals the first.
std::uint64_t most_frequent(const std::vector<std::uint64_t>& identities) {
  std::uint64_t best = 0;
  std::ptrdiff_t most = 0;
  for (const std::uint64_t identity : identities) {
    if (identity == 0) continue;
    const std::ptrdiff_t n = std::count(identities.begin(), identities.end(), identity);
    if (n > most) {
      most = n;
      best = identity;
    }
  }
  return best;
}

}  // namespace

void IdentityScore::add(const IdentityScore& other) {
  objects += other.objects;
  kept.add(other.kept);
  kept_where_found.add(other.kept_where_found);
}

void IdentityHistory::add_scan(const ClusterMatching& matching,
                               const std::vector<std::uint64_t>& identities) {
  for (const MatchedThing& thing : matching.things) {
    sights_.push_back({thing.thing, thing.cluster == kNoCluster
                                        ? 0
                                        : identities[static_cast<std::size_t>(thing.cluster)]});
  }
}

IdentityScore IdentityHistory::score() const {
  std::map<std::int32_t, std::vector<std::uint64_t>> of_thing;
  for (const Sight& sight : sights_) of_thing[sight.thing].push_back(sight.identity);
  IdentityScore score;
  for (const auto& [thing, identities] : of_thing) {
    if (identities.size() < 2) continue;
    ++score.objects;
    const std::uint64_t own = most_frequent(identities);
    for (const std::uint64_t identity : identities) {
      const bool kept = identity != 0 && identity == own;
      score.kept.count(kept);
      if (identity != 0) score.kept_where_found.count(kept);
    }
  }
  return score;
}

}  // namespace mrpt_terrain::eval
