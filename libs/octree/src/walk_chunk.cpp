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

// Steps after which a lane leaves its word, from those at which it entered one, and their number.
std::uint32_t last_in_word(std::uint32_t entered, std::uint64_t steps) {
  if (steps == 0) return 0;
  const auto last = std::uint32_t{1} << (steps - 1);
  return (entered >> 1 & (last - 1)) | last;
}

template <Ties kTies>
void walk_plain(Lanes& lanes, Trail& trail) {
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    std::uint32_t entered = 0;
    std::uint64_t steps = 0;
    std::uint64_t word = 0;
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
      const CellCode before = cell;
      cell = (((cell | ~bits) + lanes.step[axis][lane]) & bits) | (cell & ~bits);
      t[axis] += lanes.spacing[axis][lane];
      const double length = lanes.length[lane];
      alive = cell != lanes.last[lane] && !(t[0] > length && t[1] > length && t[2] > length);
      const bool enters = (cell ^ before) > 63;
      entered |= static_cast<std::uint32_t>(enters) << k;
      word = (enters ? 0 : word) | std::uint64_t{1} << (cell & 63);
      trail.cell[k][lane] = cell;
      trail.word[k][lane] = word;
      steps += alive ? 1 : 0;
    }
    trail.complete[lane] = last_in_word(entered, steps);
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
  const __m512i within_word = _mm512_set1_epi64(63);
  const __m512i beyond_word = _mm512_set1_epi64(~63LL);
  __m512i word = _mm512_setzero_si512();
  alignas(32) __mmask8 entered[kChunk];
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
    const __m512i before = cell;
    cell = _mm512_ternarylogic_epi64(bits, sum, cell, 0xca);  // bits ? sum : cell
    const __m512i bit = _mm512_maskz_sllv_epi64(0xff, one, _mm512_and_si512(cell, within_word));
    entered[k] = _mm512_test_epi64_mask(_mm512_xor_si512(cell, before), beyond_word);
    word = _mm512_mask_or_epi64(bit, _knot_mask8(entered[k]), word, bit);
    tx = _mm512_mask_add_pd(tx, x, tx, spacing_x);
    ty = _mm512_mask_add_pd(ty, y, ty, spacing_y);
    tz = _mm512_mask_add_pd(tz, z, tz, spacing_z);
    const __m512d next = _mm512_maskz_min_pd(0xff, _mm512_maskz_min_pd(0xff, tx, ty), tz);
    alive = _mm512_mask_cmp_pd_mask(alive, next, length, _CMP_LE_OQ);
    alive = _mm512_mask_cmpneq_epi64_mask(alive, cell, last);
    steps = _mm512_mask_add_epi64(steps, alive, steps, one);
    _mm512_store_si512(trail.cell[k], cell);
    _mm512_store_si512(trail.word[k], word);
  }
  _mm512_store_pd(lanes.crossing[0], tx);
  _mm512_store_pd(lanes.crossing[1], ty);
  _mm512_store_pd(lanes.crossing[2], tz);
  _mm512_store_si512(lanes.cell, cell);
  lanes.alive = alive;
  alignas(64) std::uint64_t counts[kLanes];
  _mm512_store_si512(counts, steps);
  const __m256i rows = _mm256_load_si256(reinterpret_cast<const __m256i*>(entered));
  for (int lane = 0; lane < static_cast<int>(kLanes); ++lane) {
    // Bit k: lane's bit of row k.
    const int column = _mm256_movemask_epi8(_mm256_slli_epi16(rows, 7 - lane));
    trail.complete[lane] = last_in_word(static_cast<std::uint32_t>(column), counts[lane]);
  }
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
