# SPDX-License-Identifier: BSD-3-Clause
# Compiler options of everything in this project; they are not exported to consumers.
add_library(mrpt_terrain_options INTERFACE)
target_compile_options(mrpt_terrain_options INTERFACE
  -Wall -Wextra -Wconversion -Wshadow
  $<$<BOOL:${MRPT_TERRAIN_WERROR}>:-Werror>
  # Fused multiply-add would make results depend on the machine that compiled them.
  -ffp-contract=off
  # Nobody asks for errno; without it square roots fit into vector registers.
  -fno-math-errno)
if(MRPT_TERRAIN_SANITIZE)
  target_compile_options(mrpt_terrain_options INTERFACE
    -fsanitize=${MRPT_TERRAIN_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(mrpt_terrain_options INTERFACE -fsanitize=${MRPT_TERRAIN_SANITIZE})
endif()
