// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Functions marked so are compiled for several processors, and the widest registers are chosen when
// the program starts; x86-64-v4 has twice as many of them, too. All versions give the same bits,
// because nothing is contracted or reordered (-ffp-contract=off).
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define MRPT_TERRAIN_WIDE_REGISTERS \
  __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#else
#define MRPT_TERRAIN_WIDE_REGISTERS
#endif
