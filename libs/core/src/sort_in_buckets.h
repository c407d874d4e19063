// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace mrpt_terrain {

/// Sorts entries that are spread over many buckets: into these by counting, then within each.
/// \param bucket_of from an entry to its bucket, 0 to buckets - 1, ascending in the order of `less`
/// \param scratch,next overwritten; keep their memory
template <class T, class BucketOf, class Less>
void sort_in_buckets(std::size_t buckets, BucketOf&& bucket_of, Less&& less,
                     std::vector<T>& entries, std::vector<T>& scratch,
                     std::vector<std::int32_t>& next) {
  next.assign(buckets + 1, 0);
  for (const T& entry : entries) ++next[bucket_of(entry) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  scratch.resize(entries.size());
  for (const T& entry : entries)
    scratch[static_cast<std::size_t>(next[bucket_of(entry)]++)] = entry;
  // The place behind the last entry of each bucket is left.
  std::ptrdiff_t first = 0;
  for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
    const std::ptrdiff_t last = next[bucket];
    if (last - first > 1) std::sort(scratch.begin() + first, scratch.begin() + last, less);
    first = last;
  }
  entries.swap(scratch);
}

}  // namespace mrpt_terrain
