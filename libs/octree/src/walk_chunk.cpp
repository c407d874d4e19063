// SPDX-License-Identifier: BSD-3-Clause
#include "walk_chunk.h"

#include <algorithm>

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
void walk_plain(Lanes& lanes, Marks& marks) {
  marks.size = 0;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
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
      std::uint64_t& word = lanes.word[lane];
      if (enters || !alive) {
        marks.cell[marks.size] = before;
        marks.word[marks.size++] = word;
      }
      word = (enters ? 0 : word) | std::uint64_t{1} << (cell & 63);
    }
    for (std::size_t axis = 0; axis < 3; ++axis) lanes.crossing[axis][lane] = t[axis];
    if (!alive) lanes.alive = static_cast<std::uint16_t>(lanes.alive & ~(1U << lane));
  }
}

void join_plain(Marks& marks) {
  if (marks.size == 0) return;
  marks.cell[marks.size] = ~marks.cell[marks.size - 1];  // ends the last run
  std::size_t size = 0;
  std::uint64_t word = 0;
  // Without branches: where runs end is hard to predict.
  for (std::size_t k = 0; k < marks.size; ++k) {
    const CellCode cell = marks.cell[k];
    word |= marks.word[k];
    marks.cell[size] = cell;
    marks.word[size] = word;
    const bool ends = (cell ^ marks.cell[k + 1]) > 63;
    size += ends ? 1 : 0;
    word &= std::uint64_t{ends} - 1;
  }
  marks.size = size;
}

#ifdef MRPT_TERRAIN_HAS_VECTORS

#define MRPT_TERRAIN_AVX512 gnu::target("avx512f,avx512dq,popcnt")

// Eight of the lanes in registers.
struct EightLanes {
  std::size_t first;
  __m512d tx, ty, tz, next;  // next: the least of them
  __m512i cell, word;
  __mmask8 alive;
};

[[MRPT_TERRAIN_AVX512, gnu::always_inline]] inline __m512d least(__m512d x, __m512d y, __m512d z) {
  return _mm512_maskz_min_pd(0xff, _mm512_maskz_min_pd(0xff, x, y), z);
}

[[MRPT_TERRAIN_AVX512, gnu::always_inline]] inline void load(const Lanes& lanes, std::size_t first,
                                                             EightLanes& eight) {
  eight.first = first;
  eight.tx = _mm512_load_pd(lanes.crossing[0] + first);
  eight.ty = _mm512_load_pd(lanes.crossing[1] + first);
  eight.tz = _mm512_load_pd(lanes.crossing[2] + first);
  eight.next = least(eight.tx, eight.ty, eight.tz);
  eight.cell = _mm512_load_si512(lanes.cell + first);
  eight.word = _mm512_load_si512(lanes.word + first);
  eight.alive = static_cast<__mmask8>(lanes.alive >> first);
}

// Appends those of the lanes that are in `which`.
[[MRPT_TERRAIN_AVX512, gnu::always_inline]] inline void append(__m512i cell, __m512i word,
                                                               __mmask8 which, Marks& marks,
                                                               std::size_t& size) {
  _mm512_storeu_si512(marks.cell + size, _mm512_maskz_compress_epi64(which, cell));
  _mm512_storeu_si512(marks.word + size, _mm512_maskz_compress_epi64(which, word));
  size += static_cast<std::size_t>(_mm_popcnt_u32(which));
}

// The axes along which the lanes go next. Which of those with the same border goes first is the
// order of the ties.
struct AxisMasks {
  __mmask8 x, y, z;
};
template <Ties kTies>
[[MRPT_TERRAIN_AVX512, gnu::always_inline]] inline AxisMasks next_axes(const EightLanes& eight) {
  AxisMasks axes;
  axes.y = _mm512_cmp_pd_mask(eight.ty, eight.next, _CMP_EQ_OQ);
  if constexpr (kTies == Ties::kAsOctomap) {
    axes.z = _mm512_cmp_pd_mask(eight.tz, eight.next, _CMP_EQ_OQ);
    axes.y = _kandn_mask8(axes.z, axes.y);
    axes.x = _kxnor_mask8(axes.z, axes.y);  // never both
  } else {
    axes.x = _mm512_cmp_pd_mask(eight.tx, eight.next, _CMP_EQ_OQ);
    axes.y = _kandn_mask8(axes.x, axes.y);
    axes.z = _kxnor_mask8(axes.x, axes.y);
  }
  return axes;
}

// The next step of eight lanes. Without `kMayArrive`, all are alive and stay so.
template <Ties kTies, bool kMayArrive>
[[MRPT_TERRAIN_AVX512, gnu::always_inline]] inline void step_all(const Lanes& lanes,
                                                                 EightLanes& eight, Marks& marks,
                                                                 std::size_t& size) {
  const std::size_t first = eight.first;
  const __m512i bits_x = _mm512_set1_epi64(static_cast<long long>(kAxisBits[0]));
  const __m512i bits_y = _mm512_set1_epi64(static_cast<long long>(kAxisBits[1]));
  const __m512i bits_z = _mm512_set1_epi64(static_cast<long long>(kAxisBits[2]));
  const __m512i one = _mm512_set1_epi64(1);
  const __m512i beyond_word = _mm512_set1_epi64(~63LL);
  const auto at = [first](const auto* row) { return row + first; };
  auto& [unused, tx, ty, tz, next, cell, word, alive] = eight;
  const auto [x, y, z] = next_axes<kTies>(eight);
  const __m512i bits = _mm512_mask_mov_epi64(_mm512_mask_mov_epi64(bits_z, x, bits_x), y, bits_y);
  const __m512i step =
      _mm512_mask_mov_epi64(_mm512_mask_mov_epi64(_mm512_load_si512(at(lanes.step[2])), x,
                                                  _mm512_load_si512(at(lanes.step[0]))),
                            y, _mm512_load_si512(at(lanes.step[1])));
  // Counts along one axis: carries run through the bits of the others, which are set.
  const __m512i sum = _mm512_add_epi64(_mm512_ternarylogic_epi64(cell, bits, bits, 0xf3), step);
  const __m512i before = cell;
  cell = _mm512_ternarylogic_epi64(bits, sum, cell, 0xca);  // bits ? sum : cell
  tx = _mm512_mask_add_pd(tx, x, tx, _mm512_load_pd(at(lanes.spacing[0])));
  ty = _mm512_mask_add_pd(ty, y, ty, _mm512_load_pd(at(lanes.spacing[1])));
  tz = _mm512_mask_add_pd(tz, z, tz, _mm512_load_pd(at(lanes.spacing[2])));
  next = least(tx, ty, tz);
  const __mmask8 stays = _mm512_testn_epi64_mask(_mm512_xor_si512(cell, before), beyond_word);
  __mmask8 leaves;
  if constexpr (kMayArrive) {
    const __mmask8 was_alive = alive;
    alive = _mm512_mask_cmp_pd_mask(alive, next, _mm512_load_pd(at(lanes.length)), _CMP_LE_OQ);
    alive = _mm512_mask_cmpneq_epi64_mask(alive, cell, _mm512_load_si512(at(lanes.last)));
    leaves = _kandn_mask8(_kand_mask8(stays, alive), was_alive);
  } else {
    leaves = _knot_mask8(stays);
  }
  append(before, word, leaves, marks, size);
  const __m512i bit = _mm512_maskz_rolv_epi64(0xff, one, cell);  // by the lowest six bits
  word = _mm512_mask_or_epi64(bit, stays, word, bit);
}

[[MRPT_TERRAIN_AVX512]] void store(const EightLanes& eight, Lanes& lanes) {
  _mm512_store_pd(lanes.crossing[0] + eight.first, eight.tx);
  _mm512_store_pd(lanes.crossing[1] + eight.first, eight.ty);
  _mm512_store_pd(lanes.crossing[2] + eight.first, eight.tz);
  _mm512_store_si512(lanes.cell + eight.first, eight.cell);
  _mm512_store_si512(lanes.word + eight.first, eight.word);
  lanes.alive = static_cast<std::uint16_t>((lanes.alive & ~(0xff << eight.first)) |
                                           eight.alive << eight.first);
}

// Two times eight lanes take turns: a step of one does not wait for the step of the other.
template <Ties kTies, bool kMayArrive>
[[MRPT_TERRAIN_AVX512, gnu::always_inline]] inline void walk_steps(const Lanes& lanes,
                                                                   std::size_t steps,
                                                                   EightLanes& low,
                                                                   EightLanes& high, Marks& marks) {
  std::size_t size = 0;
  for (std::size_t k = 0; k < steps; ++k) {
    if (kMayArrive && (low.alive | high.alive) == 0) break;
    step_all<kTies, kMayArrive>(lanes, low, marks, size);
    step_all<kTies, kMayArrive>(lanes, high, marks, size);
  }
  marks.size = size;
}

// Whether the next border is within the length of all lanes. It was then at all steps before.
[[MRPT_TERRAIN_AVX512]] bool is_within_length(const Lanes& lanes, const EightLanes& eight) {
  const __m512d length = _mm512_load_pd(lanes.length + eight.first);
  return _mm512_cmp_pd_mask(eight.next, length, _CMP_LE_OQ) == 0xff;
}

// Lanes that are too far from their last cells to arrive within so many steps, walk that many.
template <Ties kTies>
[[MRPT_TERRAIN_AVX512]] bool walk_on(Lanes& lanes, std::size_t steps, Marks& marks) {
  EightLanes low, high;
  load(lanes, 0, low);
  load(lanes, 8, high);
  walk_steps<kTies, false>(lanes, steps, low, high, marks);
  if (!is_within_length(lanes, low) || !is_within_length(lanes, high)) return false;
  store(low, lanes);
  store(high, lanes);
  return true;
}

template <Ties kTies>
[[MRPT_TERRAIN_AVX512]] void walk_avx512(Lanes& lanes, Marks& marks) {
  static_assert(kLanes == 16);
  const std::size_t surely = std::min<std::size_t>(lanes.surely_alive, kChunk);
  if (surely > 0) {
    lanes.surely_alive -= static_cast<std::uint32_t>(surely);
    if (walk_on<kTies>(lanes, surely, marks)) return;
    lanes.surely_alive = 0;
  }
  EightLanes low, high;
  load(lanes, 0, low);
  load(lanes, 8, high);
  walk_steps<kTies, true>(lanes, kChunk, low, high, marks);
  store(low, lanes);
  store(high, lanes);
}

// Or of each lane in `same` with the one that lies so many lanes below.
template <int kLanesBelow>
[[MRPT_TERRAIN_AVX512, gnu::always_inline]] inline __m512i join_below(__m512i word, unsigned same) {
  const __m512i below =
      _mm512_maskz_alignr_epi64(static_cast<__mmask8>(same), word, word, 8 - kLanesBelow);
  return _mm512_or_si512(word, below);
}

// Runs end with the register, too.
[[MRPT_TERRAIN_AVX512]] void join_avx512(Marks& marks) {
  const __m512i beyond_word = _mm512_set1_epi64(~63LL);
  std::size_t size = 0;
  for (std::size_t k = 0; k < marks.size; k += 8) {
    const __m512i cell = _mm512_loadu_si512(marks.cell + k);
    __m512i word = _mm512_loadu_si512(marks.word + k);
    const __m512i below = _mm512_maskz_alignr_epi64(0xff, cell, cell, 7);
    const __mmask8 equal = _mm512_testn_epi64_mask(_mm512_xor_si512(cell, below), beyond_word);
    // Lanes that belong together with one, two and four lanes below them.
    const unsigned one = equal & 0xfeU;
    const unsigned two = one & one << 1;
    const unsigned four = two & two << 2;
    word = join_below<1>(word, one);
    word = join_below<2>(word, two);
    word = join_below<4>(word, four);
    const std::size_t left = std::min<std::size_t>(marks.size - k, 8);
    const unsigned last = 1U << (left - 1);
    const unsigned ends = (~(one >> 1) | last) & (2 * last - 1);
    append(cell, word, static_cast<__mmask8>(ends), marks, size);
  }
  marks.size = size;
}

// For each of the 16 subsets of four lanes, the halves of lanes that move the subset to the front.
struct alignas(32) ToFront {
  std::int32_t half[16][8];
};
constexpr ToFront kToFront = [] {
  ToFront order{};
  for (int which = 0; which < 16; ++which) {
    int size = 0;
    for (int lane = 0; lane < 4; ++lane) {
      if ((which >> lane & 1) == 0) continue;
      order.half[which][size++] = 2 * lane;
      order.half[which][size++] = 2 * lane + 1;
    }
  }
  return order;
}();

[[gnu::target("avx2"), gnu::always_inline]] inline void append(__m256i cell, __m256i word,
                                                               int which, Marks& marks) {
  const __m256i order = _mm256_load_si256(reinterpret_cast<const __m256i*>(kToFront.half[which]));
  const auto to = [&marks](std::uint64_t* row) {
    return reinterpret_cast<__m256i*>(row + marks.size);
  };
  _mm256_storeu_si256(to(marks.cell), _mm256_permutevar8x32_epi32(cell, order));
  _mm256_storeu_si256(to(marks.word), _mm256_permutevar8x32_epi32(word, order));
  marks.size += static_cast<std::size_t>(__builtin_popcount(static_cast<unsigned>(which)));
}

template <Ties kTies>
inline constexpr int kGoesFirst = kTies == Ties::kAsOctomap ? _CMP_LT_OQ : _CMP_LE_OQ;

// Four of the lanes, from number `first` on.
template <Ties kTies>
[[gnu::target("avx2")]] void walk_four_lanes(Lanes& lanes, Marks& marks, int first) {
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
  __m256i word = _mm256_load_si256(words(lanes.word));
  const int up = lanes.alive >> first;
  __m256i alive = _mm256_set_epi64x(-(up >> 3 & 1), -(up >> 2 & 1), -(up >> 1 & 1), -(up & 1));
  for (std::size_t k = 0; k < kChunk && _mm256_testz_si256(alive, alive) == 0; ++k) {
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
    tx = _mm256_add_pd(tx, _mm256_and_pd(x, _mm256_load_pd(lanes.spacing[0] + first)));
    ty = _mm256_add_pd(ty, _mm256_and_pd(y, _mm256_load_pd(lanes.spacing[1] + first)));
    tz = _mm256_add_pd(
        tz, _mm256_andnot_pd(_mm256_or_pd(x, y), _mm256_load_pd(lanes.spacing[2] + first)));
    const __m256d next = _mm256_min_pd(_mm256_min_pd(tx, ty), tz);
    const __m256d in_length = _mm256_cmp_pd(next, _mm256_load_pd(lanes.length + first), _CMP_LE_OQ);
    const __m256i arrived = _mm256_cmpeq_epi64(cell, _mm256_load_si256(words(lanes.last)));
    const __m256i was_alive = alive;
    alive = _mm256_andnot_si256(arrived, _mm256_and_si256(alive, _mm256_castpd_si256(in_length)));
    const __m256i stays = _mm256_cmpeq_epi64(
        _mm256_andnot_si256(within_word, _mm256_xor_si256(cell, before)), _mm256_setzero_si256());
    const __m256i leaves = _mm256_andnot_si256(_mm256_and_si256(stays, alive), was_alive);
    append(before, word, _mm256_movemask_pd(_mm256_castsi256_pd(leaves)), marks);
    const __m256i bit =
        _mm256_sllv_epi64(_mm256_set1_epi64x(1), _mm256_and_si256(cell, within_word));
    word = _mm256_or_si256(bit, _mm256_and_si256(stays, word));
  }
  _mm256_store_pd(lanes.crossing[0] + first, tx);
  _mm256_store_pd(lanes.crossing[1] + first, ty);
  _mm256_store_pd(lanes.crossing[2] + first, tz);
  _mm256_store_si256(words(lanes.cell), cell);
  _mm256_store_si256(words(lanes.word), word);
  const int still = _mm256_movemask_pd(_mm256_castsi256_pd(alive));
  lanes.alive = static_cast<std::uint16_t>((lanes.alive & ~(15 << first)) | still << first);
}

template <Ties kTies>
[[gnu::target("avx2")]] void walk_avx2(Lanes& lanes, Marks& marks) {
  marks.size = 0;
  for (int first = 0; first < static_cast<int>(kLanes); first += 4) {
    walk_four_lanes<kTies>(lanes, marks, first);
  }
}

#endif

}  // namespace

const std::array<MarkJoiner, 2>& mark_joiners() {
  static const std::array<MarkJoiner, 2> joiners = [] {
    std::array<MarkJoiner, 2> found{join_plain, join_plain};
#ifdef MRPT_TERRAIN_HAS_VECTORS
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) {
      found[0] = join_avx512;
    }
#endif
    return found;
  }();
  return joiners;
}

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
