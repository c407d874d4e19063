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
    if (!alive) lanes.alive = static_cast<std::uint16_t>(lanes.alive & ~(1U << lane));
  }
}

#ifdef MRPT_TERRAIN_HAS_VECTORS

// `complete` of some lanes, from the steps at which they entered a word, a row of bits per step,
// and the number of their steps.
[[gnu::target("avx2")]] void set_complete(const std::uint8_t* entered, const std::uint64_t* steps,
                                          std::size_t lanes, std::uint32_t* complete) {
  const __m256i rows = _mm256_load_si256(reinterpret_cast<const __m256i*>(entered));
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const __m256i column = _mm256_slli_epi16(rows, 7 - static_cast<int>(lane));
    const auto bits = static_cast<std::uint32_t>(_mm256_movemask_epi8(column));
    complete[lane] = last_in_word(bits, steps[lane]);
  }
}

template <Ties kTies>
inline constexpr int kGoesFirst = kTies == Ties::kAsOctomap ? _CMP_LT_OQ : _CMP_LE_OQ;

#define MRPT_TERRAIN_AVX512 gnu::target("avx512f,avx512dq")

// Eight of the lanes in registers.
struct EightLanes {
  std::size_t first;
  __m512d tx, ty, tz;
  __m512i cell, word, steps;
  __mmask8 alive;
  alignas(32) __mmask8 entered[kChunk];
};

[[MRPT_TERRAIN_AVX512, gnu::always_inline]] inline void load(const Lanes& lanes, std::size_t first,
                                                             EightLanes& eight) {
  eight.first = first;
  eight.tx = _mm512_load_pd(lanes.crossing[0] + first);
  eight.ty = _mm512_load_pd(lanes.crossing[1] + first);
  eight.tz = _mm512_load_pd(lanes.crossing[2] + first);
  eight.cell = _mm512_load_si512(lanes.cell + first);
  eight.word = _mm512_setzero_si512();
  eight.steps = _mm512_setzero_si512();
  eight.alive = static_cast<__mmask8>(lanes.alive >> first);
}

template <Ties kTies>
[[MRPT_TERRAIN_AVX512, gnu::always_inline]] inline void step_all(const Lanes& lanes, std::size_t k,
                                                                 EightLanes& eight, Trail& trail) {
  const std::size_t first = eight.first;
  const __m512i bits_x = _mm512_set1_epi64(static_cast<long long>(kAxisBits[0]));
  const __m512i bits_y = _mm512_set1_epi64(static_cast<long long>(kAxisBits[1]));
  const __m512i bits_z = _mm512_set1_epi64(static_cast<long long>(kAxisBits[2]));
  const __m512i one = _mm512_set1_epi64(1);
  const __m512i within_word = _mm512_set1_epi64(63);
  const __m512i beyond_word = _mm512_set1_epi64(~63LL);
  const auto at = [first](const auto* row) { return row + first; };
  auto& [unused, tx, ty, tz, cell, word, steps, alive, entered] = eight;
  const __mmask8 x_before_y = _mm512_cmp_pd_mask(tx, ty, kGoesFirst<kTies>);
  const __mmask8 x = _mm512_mask_cmp_pd_mask(x_before_y, tx, tz, kGoesFirst<kTies>);
  const __mmask8 y = _mm512_mask_cmp_pd_mask(_knot_mask8(x_before_y), ty, tz, kGoesFirst<kTies>);
  const __mmask8 z = _kxnor_mask8(x, y);  // never both
  const __m512i bits = _mm512_mask_mov_epi64(_mm512_mask_mov_epi64(bits_z, x, bits_x), y, bits_y);
  const __m512i step =
      _mm512_mask_mov_epi64(_mm512_mask_mov_epi64(_mm512_load_si512(at(lanes.step[2])), x,
                                                  _mm512_load_si512(at(lanes.step[0]))),
                            y, _mm512_load_si512(at(lanes.step[1])));
  // Counts along one axis: carries run through the bits of the others, which are set.
  const __m512i sum = _mm512_add_epi64(_mm512_ternarylogic_epi64(cell, bits, bits, 0xf3), step);
  const __m512i before = cell;
  cell = _mm512_ternarylogic_epi64(bits, sum, cell, 0xca);  // bits ? sum : cell
  const __m512i bit = _mm512_maskz_sllv_epi64(0xff, one, _mm512_and_si512(cell, within_word));
  entered[k] = _mm512_test_epi64_mask(_mm512_xor_si512(cell, before), beyond_word);
  word = _mm512_mask_or_epi64(bit, _knot_mask8(entered[k]), word, bit);
  tx = _mm512_mask_add_pd(tx, x, tx, _mm512_load_pd(at(lanes.spacing[0])));
  ty = _mm512_mask_add_pd(ty, y, ty, _mm512_load_pd(at(lanes.spacing[1])));
  tz = _mm512_mask_add_pd(tz, z, tz, _mm512_load_pd(at(lanes.spacing[2])));
  const __m512d next = _mm512_maskz_min_pd(0xff, _mm512_maskz_min_pd(0xff, tx, ty), tz);
  alive = _mm512_mask_cmp_pd_mask(alive, next, _mm512_load_pd(at(lanes.length)), _CMP_LE_OQ);
  alive = _mm512_mask_cmpneq_epi64_mask(alive, cell, _mm512_load_si512(at(lanes.last)));
  steps = _mm512_mask_add_epi64(steps, alive, steps, one);
  _mm512_store_si512(trail.cell[k] + first, cell);
  _mm512_store_si512(trail.word[k] + first, word);
}

[[MRPT_TERRAIN_AVX512]] void store(const EightLanes& eight, Lanes& lanes, Trail& trail) {
  _mm512_store_pd(lanes.crossing[0] + eight.first, eight.tx);
  _mm512_store_pd(lanes.crossing[1] + eight.first, eight.ty);
  _mm512_store_pd(lanes.crossing[2] + eight.first, eight.tz);
  _mm512_store_si512(lanes.cell + eight.first, eight.cell);
  lanes.alive = static_cast<std::uint16_t>((lanes.alive & ~(0xff << eight.first)) |
                                           eight.alive << eight.first);
  alignas(64) std::uint64_t counts[8];
  _mm512_store_si512(counts, eight.steps);
  set_complete(eight.entered, counts, 8, trail.complete + eight.first);
}

// Two times eight lanes take turns: a step of one does not wait for the step of the other.
template <Ties kTies>
[[MRPT_TERRAIN_AVX512]] void walk_avx512(Lanes& lanes, Trail& trail) {
  static_assert(kLanes == 16);
  EightLanes low, high;
  load(lanes, 0, low);
  load(lanes, 8, high);
  for (std::size_t k = 0; k < kChunk; ++k) {
    step_all<kTies>(lanes, k, low, trail);
    step_all<kTies>(lanes, k, high, trail);
  }
  store(low, lanes, trail);
  store(high, lanes, trail);
}

// Four of the lanes, from number `first` on.
template <Ties kTies>
[[gnu::target("avx2")]] void walk_four_lanes(Lanes& lanes, Trail& trail, int first) {
  const auto words = [first](auto* row) { return reinterpret_cast<__m256i*>(row + first); };
  __m256d tx = _mm256_load_pd(lanes.crossing[0] + first);
  __m256d ty = _mm256_load_pd(lanes.crossing[1] + first);
  __m256d tz = _mm256_load_pd(lanes.crossing[2] + first);
  const __m256i bits_x = _mm256_set1_epi64x(static_cast<long long>(kAxisBits[0]));
  const __m256i bits_y = _mm256_set1_epi64x(static_cast<long long>(kAxisBits[1]));
  const __m256i bits_z = _mm256_set1_epi64x(static_cast<long long>(kAxisBits[2]));
  const __m256i ones = _mm256_set1_epi64x(-1);
  const __m256i within_word = _mm256_set1_epi64x(63);
  __m256i cell = _mm256_load_si256(words(lanes.cell));
  __m256i word = _mm256_setzero_si256(), steps = _mm256_setzero_si256();
  const int up = lanes.alive >> first;
  __m256i alive = _mm256_set_epi64x(-(up >> 3 & 1), -(up >> 2 & 1), -(up >> 1 & 1), -(up & 1));
  alignas(32) std::uint8_t entered[kChunk];
  for (std::size_t k = 0; k < kChunk; ++k) {
    const __m256d x_before_y = _mm256_cmp_pd(tx, ty, kGoesFirst<kTies>);
    const __m256d x = _mm256_and_pd(x_before_y, _mm256_cmp_pd(tx, tz, kGoesFirst<kTies>));
    const __m256d y = _mm256_andnot_pd(x_before_y, _mm256_cmp_pd(ty, tz, kGoesFirst<kTies>));
    const __m256i xi = _mm256_castpd_si256(x), yi = _mm256_castpd_si256(y);
    const __m256i bits = _mm256_blendv_epi8(_mm256_blendv_epi8(bits_z, bits_x, xi), bits_y, yi);
    const __m256i step_xz = _mm256_blendv_epi8(_mm256_load_si256(words(lanes.step[2])),
                                               _mm256_load_si256(words(lanes.step[0])), xi);
    const __m256i step = _mm256_blendv_epi8(step_xz, _mm256_load_si256(words(lanes.step[1])), yi);
    const __m256i sum = _mm256_add_epi64(_mm256_or_si256(cell, _mm256_xor_si256(bits, ones)), step);
    const __m256i before = cell;
    cell = _mm256_or_si256(_mm256_and_si256(bits, sum), _mm256_andnot_si256(bits, before));
    const __m256i bit =
        _mm256_sllv_epi64(_mm256_set1_epi64x(1), _mm256_and_si256(cell, within_word));
    const __m256i stays = _mm256_cmpeq_epi64(
        _mm256_andnot_si256(within_word, _mm256_xor_si256(cell, before)), _mm256_setzero_si256());
    entered[k] = static_cast<std::uint8_t>(~_mm256_movemask_pd(_mm256_castsi256_pd(stays)));
    word = _mm256_or_si256(bit, _mm256_and_si256(stays, word));
    tx = _mm256_add_pd(tx, _mm256_and_pd(x, _mm256_load_pd(lanes.spacing[0] + first)));
    ty = _mm256_add_pd(ty, _mm256_and_pd(y, _mm256_load_pd(lanes.spacing[1] + first)));
    tz = _mm256_add_pd(
        tz, _mm256_andnot_pd(_mm256_or_pd(x, y), _mm256_load_pd(lanes.spacing[2] + first)));
    const __m256d next = _mm256_min_pd(_mm256_min_pd(tx, ty), tz);
    const __m256d in_length = _mm256_cmp_pd(next, _mm256_load_pd(lanes.length + first), _CMP_LE_OQ);
    const __m256i arrived = _mm256_cmpeq_epi64(cell, _mm256_load_si256(words(lanes.last)));
    alive = _mm256_andnot_si256(arrived, _mm256_and_si256(alive, _mm256_castpd_si256(in_length)));
    steps = _mm256_sub_epi64(steps, alive);
    _mm256_store_si256(words(trail.cell[k]), cell);
    _mm256_store_si256(words(trail.word[k]), word);
  }
  _mm256_store_pd(lanes.crossing[0] + first, tx);
  _mm256_store_pd(lanes.crossing[1] + first, ty);
  _mm256_store_pd(lanes.crossing[2] + first, tz);
  _mm256_store_si256(words(lanes.cell), cell);
  const int still = _mm256_movemask_pd(_mm256_castsi256_pd(alive));
  lanes.alive = static_cast<std::uint16_t>((lanes.alive & ~(15 << first)) | still << first);
  alignas(32) std::uint64_t counts[4];
  _mm256_store_si256(reinterpret_cast<__m256i*>(counts), steps);
  set_complete(entered, counts, 4, trail.complete + first);
}

template <Ties kTies>
void walk_avx2(Lanes& lanes, Trail& trail) {
  for (int first = 0; first < static_cast<int>(kLanes); first += 4) {
    walk_four_lanes<kTies>(lanes, trail, first);
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
    if (__builtin_cpu_supports("avx2")) found[size++] = walk_avx2<kTies>;
#endif
    while (size < found.size()) found[size++] = walk_plain<kTies>;
    return found;
  }();
  return walkers;
}

template const std::array<ChunkWalker, 3>& chunk_walkers<Ties::kAsOctomap>();
template const std::array<ChunkWalker, 3>& chunk_walkers<Ties::kFlipped>();

}  // namespace mrpt_terrain::octree
