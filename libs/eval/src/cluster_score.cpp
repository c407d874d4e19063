// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_terrain/eval/cluster_score.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace mrpt_terrain::eval {
namespace {

/// Points of a thing or a cluster.
struct Size {
  std::size_t returns = 0;
  std::size_t counted = 0;
};

/// Points that a thing and a cluster share.
struct Overlap {
  std::int32_t thing, cluster;
  std::size_t points = 0;
};

struct Sizes {
  std::vector<Size> thing, cluster;
  std::vector<double> distance;   ///< per thing: sum over its counted points
  std::vector<Overlap> overlaps;  ///< sorted by thing, then cluster
};

std::size_t index(std::int32_t number) { return static_cast<std::size_t>(number); }

bool is_counted(const ScanTruth& truth, std::size_t point) {
  return truth.support[point] != Support::kUnknown &&
         (truth.cover.empty() || truth.cover[point] == 0);
}

bool is_thing(const ScanTruth& truth, std::int32_t thing) {
  return truth.things[index(thing)].terrain_class != TerrainClass::kNone;
}

/// Equal pairs of numbers, sorted, with how often they occur.
std::vector<Overlap> counted_pairs(std::vector<std::int64_t>& keys, std::int64_t clusters) {
  std::sort(keys.begin(), keys.end());
  std::vector<Overlap> overlaps;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (i == 0 || keys[i] != keys[i - 1]) {
      overlaps.push_back({static_cast<std::int32_t>(keys[i] / clusters),
                          static_cast<std::int32_t>(keys[i] % clusters), 0});
    }
    ++overlaps.back().points;
  }
  return overlaps;
}

Sizes measure(const PointsView& points, const ScanTruth& truth, const PointLabels& labels,
              const std::vector<ClusterDescription>& clusters) {
  Sizes sizes;
  sizes.thing.resize(truth.things.size());
  sizes.distance.assign(truth.things.size(), 0.0);
  sizes.cluster.resize(clusters.size());
  std::vector<std::int64_t> keys;
  for (std::size_t i = 0; i < points.size; ++i) {
    const std::int32_t thing = truth.thing[i];
    std::int32_t cluster = labels.cluster[i];
    if (cluster != kNoCluster && clusters[index(cluster)].terrain_class == TerrainClass::kNone) {
      cluster = kNoCluster;
    }
    ++sizes.thing[index(thing)].returns;
    if (cluster != kNoCluster) ++sizes.cluster[index(cluster)].returns;
    if (!is_counted(truth, i)) continue;
    ++sizes.thing[index(thing)].counted;
    sizes.distance[index(thing)] +=
        std::hypot(static_cast<double>(points.x[i]), static_cast<double>(points.y[i]));
    if (cluster == kNoCluster) continue;
    ++sizes.cluster[index(cluster)].counted;
    keys.push_back(std::int64_t{thing} * static_cast<std::int64_t>(clusters.size()) + cluster);
  }
  sizes.overlaps =
      counted_pairs(keys, std::max<std::int64_t>(1, static_cast<std::int64_t>(clusters.size())));
  return sizes;
}

bool is_enough(const Size& size, const ClusterRules& rules) {
  return size.returns >= rules.returns && size.counted >= rules.counted;
}

/// Things that count, with distance.
std::vector<MatchedThing> countable_things(const ScanTruth& truth, const Sizes& sizes,
                                           const ClusterRules& rules) {
  std::vector<MatchedThing> things;
  for (std::size_t t = 1; t < truth.things.size(); ++t) {
    const auto thing = static_cast<std::int32_t>(t);
    if (!is_thing(truth, thing) || !is_enough(sizes.thing[t], rules)) continue;
    MatchedThing entry;
    entry.thing = thing;
    entry.distance = sizes.distance[t] / static_cast<double>(sizes.thing[t].counted);
    things.push_back(entry);
  }
  return things;
}

void compare(const Overlap& overlap, const Sizes& sizes, const ClusterRules& rules,
             MatchedThing& thing, ClusterMatching& matching) {
  const std::size_t of_thing = sizes.thing[index(overlap.thing)].counted;
  const std::size_t of_cluster = sizes.cluster[index(overlap.cluster)].counted;
  const auto both = static_cast<double>(overlap.points);
  const double share = both / static_cast<double>(of_thing);
  if (share >= rules.split_share) ++thing.parts;
  if (share >= rules.merged_share) ++matching.swallowed[index(overlap.cluster)];
  const double iou = both / static_cast<double>(of_thing + of_cluster - overlap.points);
  if (iou <= rules.least_iou || iou <= thing.iou) return;
  thing.iou = iou;
  thing.cluster = overlap.cluster;
}

/// Per cluster: points of things that are none or too small to count.
std::vector<std::size_t> points_of_small_things(const ScanTruth& truth, const Sizes& sizes,
                                                const ClusterRules& rules, std::size_t clusters) {
  std::vector<std::size_t> result(clusters, 0);
  for (const Overlap& overlap : sizes.overlaps) {
    if (overlap.thing == kNoThing) continue;
    const bool counts =
        is_thing(truth, overlap.thing) && is_enough(sizes.thing[index(overlap.thing)], rules);
    if (!counts) result[index(overlap.cluster)] += overlap.points;
  }
  return result;
}

void decide_fates(const ScanTruth& truth, const Sizes& sizes, const ClusterRules& rules,
                  ClusterMatching& matching) {
  const std::vector<std::size_t> small =
      points_of_small_things(truth, sizes, rules, sizes.cluster.size());
  for (std::size_t c = 0; c < sizes.cluster.size(); ++c) {
    const Size& size = sizes.cluster[c];
    const std::size_t beside = size.returns - size.counted + small[c];
    const bool counts = is_enough(size, rules) && 2 * beside <= size.returns;
    matching.fate[c] = counts ? ClusterFate::kFalse : ClusterFate::kNotCounted;
  }
  for (const MatchedThing& thing : matching.things) {
    if (thing.cluster != kNoCluster) matching.fate[index(thing.cluster)] = ClusterFate::kMatched;
  }
}

}  // namespace

ClusterMatching match_clusters(const PointsView& points, const ScanTruth& truth,
                               const PointLabels& labels,
                               const std::vector<ClusterDescription>& clusters,
                               const ClusterRules& rules) {
  assert(truth.thing.size() == points.size && labels.cluster.size() == points.size);
  const Sizes sizes = measure(points, truth, labels, clusters);
  ClusterMatching matching;
  matching.fate.resize(clusters.size());
  matching.swallowed.assign(clusters.size(), 0);
  matching.things = countable_things(truth, sizes, rules);
  auto thing = matching.things.begin();
  for (const Overlap& overlap : sizes.overlaps) {
    while (thing != matching.things.end() && thing->thing < overlap.thing) ++thing;
    if (thing == matching.things.end()) break;
    if (thing->thing == overlap.thing) compare(overlap, sizes, rules, *thing, matching);
  }
  decide_fates(truth, sizes, rules, matching);
  return matching;
}

void ClusterScore::add(const ClusterScore& other) {
  found.add(other.found);
  right.add(other.right);
  split.add(other.split);
  merged.add(other.merged);
  not_counted += other.not_counted;
  for (std::size_t k = 0; k < kClassCount; ++k) found_of_class[k].add(other.found_of_class[k]);
  for (std::size_t k = 0; k < kDistanceBins; ++k) found_at[k].add(other.found_at[k]);
  for (std::size_t r = 0; r < kClassCount; ++r) {
    for (std::size_t c = 0; c < kClassCount; ++c) confusion[r][c] += other.confusion[r][c];
  }
}

void add_clusters(const ClusterMatching& matching, const ScanTruth& truth,
                  const std::vector<ClusterDescription>& clusters, ClusterScore& score) {
  const auto class_of = [&clusters](std::int32_t cluster) {
    return cluster == kNoCluster ? std::size_t{0}
                                 : static_cast<std::size_t>(clusters[index(cluster)].terrain_class);
  };
  for (const MatchedThing& thing : matching.things) {
    const auto row = static_cast<std::size_t>(truth.things[index(thing.thing)].terrain_class);
    const bool found = thing.cluster != kNoCluster;
    score.found.count(found);
    score.found_of_class[row].count(found);
    score.found_at[distance_bin(thing.distance)].count(found);
    score.split.count(thing.parts >= 2);
    ++score.confusion[row][class_of(thing.cluster)];
  }
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    if (matching.fate[c] == ClusterFate::kNotCounted) {
      ++score.not_counted;
      continue;
    }
    score.right.count(matching.fate[c] == ClusterFate::kMatched);
    score.merged.count(matching.swallowed[c] >= 2);
    if (matching.fate[c] == ClusterFate::kFalse) {
      ++score.confusion[0][class_of(static_cast<std::int32_t>(c))];
    }
  }
}

namespace {

/// Place and labels of a thing's counted points.
struct ThingPoints {
  double x = 0.0, y = 0.0;
  std::size_t counted = 0, loose = 0, dropped = 0;
};

std::vector<ThingPoints> look_at_things(const PointsView& points, const ScanTruth& truth,
                                        const PointLabels& labels) {
  std::vector<ThingPoints> result(truth.things.size());
  for (std::size_t i = 0; i < points.size; ++i) {
    if (!is_counted(truth, i)) continue;
    ThingPoints& thing = result[index(truth.thing[i])];
    ++thing.counted;
    thing.x += static_cast<double>(points.x[i]);
    thing.y += static_cast<double>(points.y[i]);
    if (labels.cluster[i] != kNoCluster) continue;
    ++(labels.support[i] == Support::kGround ? thing.loose : thing.dropped);
  }
  return result;
}

void add_truth(const ScanTruth& truth, std::int32_t thing, const std::vector<ThingPoints>& all,
               ThingRecord& record) {
  const ThingPoints& of_thing = all[index(thing)];
  const double n = std::max<double>(1.0, static_cast<double>(of_thing.counted));
  record.thing = truth.things[index(thing)].id;
  record.type = truth.things[index(thing)].type;
  record.truth = truth.things[index(thing)].terrain_class;
  record.x = of_thing.x / n;
  record.y = of_thing.y / n;
  record.of_thing = of_thing.counted;
  record.loose = of_thing.loose;
  record.dropped = of_thing.dropped;
}

/// Of the overlaps that `wanted` accepts, the one with the most points; null: none.
template <class Wanted>
const Overlap* largest(const std::vector<Overlap>& overlaps, Wanted&& wanted) {
  const Overlap* best = nullptr;
  for (const Overlap& overlap : overlaps) {
    if (wanted(overlap) && (best == nullptr || overlap.points > best->points)) best = &overlap;
  }
  return best;
}

}  // namespace

double ThingRecord::iou() const {
  const std::size_t all = of_thing + of_cluster - shared;
  return all == 0 ? 0.0 : static_cast<double>(shared) / static_cast<double>(all);
}

std::vector<ThingRecord> list_things(const PointsView& points, const ScanTruth& truth,
                                     const PointLabels& labels,
                                     const std::vector<ClusterDescription>& clusters,
                                     const ClusterMatching& matching) {
  const Sizes sizes = measure(points, truth, labels, clusters);
  const std::vector<ThingPoints> of_things = look_at_things(points, truth, labels);
  std::vector<ThingRecord> records;
  const auto add = [&](const Overlap* overlap, ThingRecord record) {
    if (overlap != nullptr) {
      record.shared = overlap->points;
      record.cluster = overlap->cluster;
    }
    if (record.cluster != kNoCluster) {
      const ClusterDescription& cluster = clusters[index(record.cluster)];
      record.described = cluster.terrain_class;
      record.points = cluster.points;
      record.cells = cluster.cells;
      record.raised = cluster.raised;
      record.confidence = cluster.confidence;
      record.of_cluster = sizes.cluster[index(record.cluster)].counted;
      record.swallowed = matching.swallowed[index(record.cluster)];
    }
    records.push_back(std::move(record));
  };
  for (const MatchedThing& thing : matching.things) {
    ThingRecord record;
    add_truth(truth, thing.thing, of_things, record);
    record.parts = thing.parts;
    add(largest(sizes.overlaps,
                [&thing](const Overlap& overlap) {
                  return overlap.thing == thing.thing &&
                         (thing.cluster == kNoCluster || overlap.cluster == thing.cluster);
                }),
        std::move(record));
  }
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    if (matching.fate[c] != ClusterFate::kFalse) continue;
    const Overlap* overlap =
        largest(sizes.overlaps, [c](const Overlap& each) { return index(each.cluster) == c; });
    ThingRecord record;
    record.is_false = true;
    record.cluster = static_cast<std::int32_t>(c);
    if (overlap != nullptr) add_truth(truth, overlap->thing, of_things, record);
    add(overlap, std::move(record));
  }
  return records;
}

}  // namespace mrpt_terrain::eval
