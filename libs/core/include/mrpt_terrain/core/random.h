// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace mrpt_terrain {

/// Small portable random generator, PCG-XSH-RR 64/32 (O'Neill 2014). The same numbers with every
/// compiler and standard library, which `<random>`'s distributions do not promise.
class RandomGenerator {
 public:
  /// \param seed start of the sequence
  /// \param stream which of 2^63 independent sequences
  explicit RandomGenerator(std::uint64_t seed, std::uint64_t stream = 0)
      : increment_((stream << 1U) | 1U) {
    next();
    state_ += seed;
    next();
  }

  /// Uniform over all 32-bit numbers.
  std::uint32_t next() {
    const std::uint64_t old = state_;
    state_ = old * 6364136223846793005ULL + increment_;
    const auto xorshifted = static_cast<std::uint32_t>(((old >> 18U) ^ old) >> 27U);
    const auto rotation = static_cast<std::uint32_t>(old >> 59U);
    return (xorshifted >> rotation) | (xorshifted << ((32U - rotation) & 31U));
  }

  /// Uniform over [0, bound), without bias (Lemire 2019). Requires bound > 0.
  std::uint32_t below(std::uint32_t bound) {
    std::uint64_t product = std::uint64_t{next()} * bound;
    if (static_cast<std::uint32_t>(product) < bound) {
      const std::uint32_t threshold = (0U - bound) % bound;
      while (static_cast<std::uint32_t>(product) < threshold)
        product = std::uint64_t{next()} * bound;
    }
    return static_cast<std::uint32_t>(product >> 32U);
  }

  /// Uniform over [0, 1), 32 bits of resolution.
  double uniform() { return next() * 0x1p-32; }

 private:
  std::uint64_t state_ = 0;
  std::uint64_t increment_;
};

}  // namespace mrpt_terrain
