# SPDX-License-Identifier: BSD-3-Clause
# doc/parameters.md must be what the field lists in the headers give.
set(file ${SOURCE_FOLDER}/doc/parameters.md)
file(MAKE_DIRECTORY ${WORK_FOLDER})
execute_process(COMMAND ${PROGRAM} ${WORK_FOLDER}/parameters.md RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "${PROGRAM} failed: ${status}")
endif()
execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files ${file} ${WORK_FOLDER}/parameters.md
  RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "doc/parameters.md is out of date. To make it again:\n"
    "  ${PROGRAM} ${file}")
endif()
