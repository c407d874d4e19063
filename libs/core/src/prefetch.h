// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace mrpt_terrain {

/// Lets the processor fetch an object that is going to be written to.
template <class T>
void prefetch_for_writing(const T& object) {
#if defined(__GNUC__)
  const char* bytes = reinterpret_cast<const char*>(&object);
  __builtin_prefetch(bytes, 1);
  if (sizeof(T) > 16) __builtin_prefetch(bytes + sizeof(T) - 1, 1);
#else
  (void)object;
#endif
}

}  // namespace mrpt_terrain
