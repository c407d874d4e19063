# SPDX-License-Identifier: BSD-3-Clause
# A generated document must be what the field lists in the headers give.
#   cmake -DSOURCE_FOLDER=... -DWORK_FOLDER=... -DPROGRAM=... -DDOCUMENT=parameters.md -P ...
set(file ${SOURCE_FOLDER}/doc/${DOCUMENT})
file(MAKE_DIRECTORY ${WORK_FOLDER})
execute_process(COMMAND ${PROGRAM} ${WORK_FOLDER}/${DOCUMENT} RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "${PROGRAM} failed: ${status}")
endif()
execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files ${file} ${WORK_FOLDER}/${DOCUMENT}
  RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "doc/${DOCUMENT} is out of date. To make it again:\n  ${PROGRAM} ${file}")
endif()
