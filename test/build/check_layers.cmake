# SPDX-License-Identifier: BSD-3-Clause
# terrain_library() must stop the configuration at a dependency that its table does not allow.
function(configure_edge library used result)
  file(REMOVE_RECURSE ${WORK_FOLDER})
  file(WRITE ${WORK_FOLDER}/CMakeLists.txt
    "cmake_minimum_required(VERSION 3.22)\n"
    "project(edge LANGUAGES NONE)\n"
    "include(\"${SOURCE_FOLDER}/cmake/layers.cmake\")\n"
    # A project without language makes no library; only the verdict on the edge matters.
    "function(add_library)\n  message(FATAL_ERROR \"edge accepted\")\nendfunction()\n"
    "terrain_library(${library} ${used})\n")
  execute_process(
    COMMAND ${CMAKE_COMMAND} -G ${GENERATOR} -S ${WORK_FOLDER} -B ${WORK_FOLDER}/build
    RESULT_VARIABLE status OUTPUT_QUIET ERROR_VARIABLE output)
  string(REGEX REPLACE "[ \n]+" " " output "${output}")
  if(status EQUAL 0)
    message(FATAL_ERROR "libs/${library} ${used}: neither refused nor accepted")
  endif()
  set(${result} "${output}" PARENT_SCOPE)
endfunction()

function(expect library used message)
  configure_edge(${library} "${used}" output)
  string(FIND "${output}" "${message}" found)
  if(found EQUAL -1)
    message(FATAL_ERROR "libs/${library} ${used}: expected \"${message}\", got:\n${output}")
  endif()
endfunction()

expect(core "USES mrpt::obs" "libs/core may not use mrpt::obs")
expect(core "USES params" "libs/core may not use params")
expect(core "USES Eigen3::Eigen PRIVATE_USES octomap" "libs/core may not use octomap")
expect(octree "USES octomap core" "libs/octree may not use core")
expect(params "USES core io" "libs/params may not use io")
expect(nosuchlayer "USES core" "libs/nosuchlayer is not in the table")
expect(core "USES Eigen3::Eigen" "edge accepted")
expect(params "USES core PRIVATE_USES mrpt::config" "edge accepted")
