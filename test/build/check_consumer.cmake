# SPDX-License-Identifier: BSD-3-Clause
# Installs into a fresh folder, then configures, builds and runs a project that knows nothing but
# that folder.
set(prefix ${WORK_FOLDER}/prefix)
file(REMOVE_RECURSE ${WORK_FOLDER})

function(run what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output
    ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${what} failed (${status}):\n${output}")
  endif()
  message(STATUS "${what}: done")
endfunction()

run("Installing" ${CMAKE_COMMAND} --install ${BUILD_FOLDER} --prefix ${prefix})
if(NOT EXISTS ${prefix}/${DATA_FOLDER}/params/paper.ini)
  message(FATAL_ERROR "params/paper.ini was not installed into ${DATA_FOLDER}")
endif()
run("Configuring the consumer" ${CMAKE_COMMAND} -G ${GENERATOR}
  -S ${CMAKE_CURRENT_LIST_DIR}/consumer -B ${WORK_FOLDER}/build
  -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_BUILD_TYPE=${BUILD_TYPE}
  -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_FLAGS=${COMPILER_FLAGS} -DLIBRARIES=${LIBRARIES})
run("Building the consumer" ${CMAKE_COMMAND} --build ${WORK_FOLDER}/build)
run("Running the consumer" ${CMAKE_COMMAND} -E env MRPT_TERRAIN_DATA_DIR=${prefix}/${DATA_FOLDER}
  ${WORK_FOLDER}/build/consumer)

# No trace of the build or source folder may be left in what others include and link by name.
file(GLOB_RECURSE cmake_files ${prefix}/*.cmake)
foreach(file IN LISTS cmake_files)
  file(STRINGS ${file} traces REGEX "${SOURCE_FOLDER}/libs|mrpt_terrain_options")
  if(traces)
    message(FATAL_ERROR "${file} points into the build: ${traces}")
  endif()
endforeach()
