// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace mrpt_terrain {

/// Brings entries together by counting, those of each bucket in the order in which they were.
/// \param bucket_of from an entry to its bucket, 0 to buckets - 1
/// \param scratch overwritten; keeps its memory
/// \param[out] end per bucket: the place behind its last entry, and one more number
template <class T, class BucketOf>
void put_into_buckets(std::size_t buckets, BucketOf&& bucket_of, std::vector<T>& entries,
                      std::vector<T>& scratch, std::vector<std::int32_t>& end) {
  end.assign(buckets + 1, 0);
  for (const T& entry : entries) ++end[bucket_of(entry) + 1];
  std::partial_sum(end.begin(), end.end(), end.begin());
  scratch.resize(entries.size());
  for (const T& entry : entries) scratch[static_cast<std::size_t>(end[bucket_of(entry)]++)] = entry;
  entries.swap(scratch);
}

/// Sorts entries that are spread over many buckets: into these by counting, then within each.
/// \param bucket_of as above, ascending in the order of `less`
/// \param scratch,end overwritten; keep their memory
template <class T, class BucketOf, class Less>
void sort_in_buckets(std::size_t buckets, BucketOf&& bucket_of, Less&& less,
                     std::vector<T>& entries, std::vector<T>& scratch,
                     std::vector<std::int32_t>& end) {
  put_into_buckets(buckets, bucket_of, entries, scratch, end);
  std::ptrdiff_t first = 0;
  for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
    const std::ptrdiff_t last = end[bucket];
    if (last - first > 1) std::sort(entries.begin() + first, entries.begin() + last, less);
    first = last;
  }
}

}  // namespace mrpt_terrain
