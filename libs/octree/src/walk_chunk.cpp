// SPDX-License-Identifier: BSD-3-Clause
#include "walk_chunk.h"

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
#define MRPT_TERRAIN_HAS_VECTORS
#endif

namespace mrpt_terrain::octree {
namespace {

template <Ties kTies>
bool goes_first(double a, double b) {
  return kTies == Ties::kAsOctomap ? a < b : a <= b;
}

template <Ties kTies>
void walk_plain(Lanes& lanes, Trail& trail) {
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    trail.steps[lane] = 0;
    double t[3] = {lanes.crossing[0][lane], lanes.crossing[1][lane], lanes.crossing[2][lane]};
    bool alive = (lanes.alive >> lane & 1) != 0;
    for (std::size_t k = 0; alive && k < kChunk; ++k) {
      std::size_t axis = 2;
      if (goes_first<kTies>(t[0], t[1])) {
        if (goes_first<kTies>(t[0], t[2])) axis = 0;
      } else if (goes_first<kTies>(t[1], t[2])) {
        axis = 1;
      }
      // Counts along one axis: carries run through the bits of the others, which are set.
      const CellCode bits = kAxisBits[axis];
      CellCode& cell = lanes.cell[lane];
      cell = (((cell | ~bits) + lanes.step[axis][lane]) & bits) | (cell & ~bits);
      t[axis] += lanes.spacing[axis][lane];
      const double length = lanes.length[lane];
      alive = cell != lanes.last[lane] && !(t[0] > length && t[1] > length && t[2] > length);
      trail.cell[k][lane] = cell;
      trail.steps[lane] += alive ? 1 : 0;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) lanes.crossing[axis][lane] = t[axis];
    if (!alive) lanes.alive = static_cast<std::uint8_t>(lanes.alive & ~(1U << lane));
  }
}

#ifdef MRPT_TERRAIN_HAS_VECTORS

template <Ties kTies>
inline constexpr int kGoesFirst = kTies == Ties::kAsOctomap ? _CMP_LT_OQ : _CMP_LE_OQ;

template <Ties kTies>
[[gnu::target("avx512f,avx512dq")]] void walk_avx512(Lanes& lanes, Trail& trail) {
  __m512d tx = _mm512_load_pd(lanes.crossing[0]);
  __m512d ty = _mm512_load_pd(lanes.crossing[1]);
  __m512d tz = _mm512_load_pd(lanes.crossing[2]);
  const __m512d spacing_x = _mm512_load_pd(lanes.spacing[0]);
  const __m512d spacing_y = _mm512_load_pd(lanes.spacing[1]);
  const __m512d spacing_z = _mm512_load_pd(lanes.spacing[2]);
  const __m512d length = _mm512_load_pd(lanes.length);
  const __m512i step_x = _mm512_load_si512(lanes.step[0]);
  const __m512i step_y = _mm512_load_si512(lanes.step[1]);
  const __m512i step_z = _mm512_load_si512(lanes.step[2]);
  const __m512i bits_x = _mm512_set1_epi64(static_cast<long long>(kAxisBits[0]));
  const __m512i bits_y = _mm512_set1_epi64(static_cast<long long>(kAxisBits[1]));
  const __m512i bits_z = _mm512_set1_epi64(static_cast<long long>(kAxisBits[2]));
  const __m512i one = _mm512_set1_epi64(1);
  const __m512i last = _mm512_load_si512(lanes.last);
  __m512i cell = _mm512_load_si512(lanes.cell);
  __m512i steps = _mm512_setzero_si512();
  __mmask8 alive = lanes.alive;
  for (std::size_t k = 0; k < kChunk; ++k) {
    const __mmask8 x_before_y = _mm512_cmp_pd_mask(tx, ty, kGoesFirst<kTies>);
    const __mmask8 x = _mm512_mask_cmp_pd_mask(x_before_y, tx, tz, kGoesFirst<kTies>);
    const __mmask8 y = _mm512_mask_cmp_pd_mask(_knot_mask8(x_before_y), ty, tz, kGoesFirst<kTies>);
    const __mmask8 z = _kxnor_mask8(x, y);  // never both
    const __m512i bits = _mm512_mask_mov_epi64(_mm512_mask_mov_epi64(bits_z, x, bits_x), y, bits_y);
    const __m512i step = _mm512_mask_mov_epi64(_mm512_mask_mov_epi64(step_z, x, step_x), y, step_y);
    // Counts along one axis: carries run through the bits of the others, which are set.
    const __m512i sum = _mm512_add_epi64(_mm512_ternarylogic_epi64(cell, bits, bits, 0xf3), step);
    cell = _mm512_ternarylogic_epi64(bits, sum, cell, 0xca);  // bits ? sum : cell
    tx = _mm512_mask_add_pd(tx, x, tx, spacing_x);
    ty = _mm512_mask_add_pd(ty, y, ty, spacing_y);
    tz = _mm512_mask_add_pd(tz, z, tz, spacing_z);
    const __m512d next = _mm512_maskz_min_pd(0xff, _mm512_maskz_min_pd(0xff, tx, ty), tz);
    alive = _mm512_mask_cmp_pd_mask(alive, next, length, _CMP_LE_OQ);
    alive = _mm512_mask_cmpneq_epi64_mask(alive, cell, last);
    steps = _mm512_mask_add_epi64(steps, alive, steps, one);
    _mm512_store_si512(trail.cell[k], cell);
  }
  _mm512_store_pd(lanes.crossing[0], tx);
  _mm512_store_pd(lanes.crossing[1], ty);
  _mm512_store_pd(lanes.crossing[2], tz);
  _mm512_store_si512(lanes.cell, cell);
  _mm512_store_si512(trail.steps, steps);
  lanes.alive = alive;
}

#endif

}  // namespace

template <Ties kTies>
const std::array<ChunkWalker, 3>& chunk_walkers() {
  static const std::array<ChunkWalker, 3> walkers = [] {
    std::array<ChunkWalker, 3> found{};
    std::size_t size = 0;
#ifdef MRPT_TERRAIN_HAS_VECTORS
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) {
      found[size++] = walk_avx512<kTies>;
    }
#endif
    while (size < found.size()) found[size++] = walk_plain<kTies>;
    return found;
  }();
  return walkers;
}

template const std::array<ChunkWalker, 3>& chunk_walkers<Ties::kAsOctomap>();
template const std::array<ChunkWalker, 3>& chunk_walkers<Ties::kFlipped>();

}  // namespace mrpt_terrain::octree
