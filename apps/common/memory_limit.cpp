// SPDX-License-Identifier: BSD-3-Clause
#include "memory_limit.h"

#include <mrpt/core/aligned_allocator.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <new>

// MRPT 2.5.8's own returns null when there is no memory, and its containers write through that. The
// definition in the program comes before the one in the shared library and throws, as the
// containers expect of an allocator.
void* mrpt::aligned_malloc(std::size_t size, std::size_t alignment) {
  const std::size_t whole = (size + alignment - 1) / alignment * alignment;
  void* memory = whole < size ? nullptr : std::aligned_alloc(alignment, whole);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

// The sanitizers reserve terabytes of address space.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)

void limit_memory() {}

#else

void limit_memory() {
  const long pages = sysconf(_SC_PHYS_PAGES);
  const long page_size = sysconf(_SC_PAGESIZE);
  rlimit limit{};
  if (pages <= 0 || page_size <= 0 || getrlimit(RLIMIT_AS, &limit) != 0) return;
  const rlim_t half = static_cast<rlim_t>(pages) * static_cast<rlim_t>(page_size) / 2;
  limit.rlim_cur = std::min(limit.rlim_cur, half);
  // Without the limit the program works as well, so a refusal is no reason to stop.
  (void)setrlimit(RLIMIT_AS, &limit);
}

#endif
