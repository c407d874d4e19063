# SPDX-License-Identifier: BSD-3-Clause
# Compiler options of everything in this project; they are not exported to consumers.
# terrain_options(NAME SANITIZERS): they as a target, with these sanitizers.
function(terrain_options name sanitizers)
  add_library(${name} INTERFACE)
  target_compile_options(${name} INTERFACE
    -Wall -Wextra -Wconversion -Wshadow
    $<$<BOOL:${MRPT_TERRAIN_WERROR}>:-Werror>
    # Fused multiply-add would make results depend on the machine that compiled them.
    -ffp-contract=off
    # Nobody asks for errno; without it square roots fit into vector registers.
    -fno-math-errno)
  if(sanitizers)
    target_compile_options(${name} INTERFACE
      -fsanitize=${sanitizers} -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(${name} INTERFACE -fsanitize=${MRPT_TERRAIN_SANITIZE})
  endif()
endfunction()

terrain_options(mrpt_terrain_options "${MRPT_TERRAIN_SANITIZE}")
# Tests are there to exercise the libraries: optimising them, and looking for undefined behaviour in
# them, costs a third of the time that they take to compile, and finds nothing in the libraries.
string(REPLACE "address,undefined" "address" test_sanitizers "${MRPT_TERRAIN_SANITIZE}")
terrain_options(mrpt_terrain_test_options "${test_sanitizers}")
target_compile_options(mrpt_terrain_test_options INTERFACE $<$<CONFIG:Release>:-O1>)
