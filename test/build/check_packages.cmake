# SPDX-License-Identifier: BSD-3-Clause
# packages.apt: every line is empty, a comment, or "package  # why", sorted out by scripts/common.sh.
file(STRINGS ${SOURCE_FOLDER}/packages.apt lines)
set(packages)
foreach(line IN LISTS lines)
  if(line MATCHES "^#" OR line STREQUAL "")
    continue()
  elseif(line MATCHES "^([a-z0-9][a-z0-9+.-]+) +# [^ ]")
    list(APPEND packages ${CMAKE_MATCH_1})
  else()
    message(FATAL_ERROR "packages.apt: `${line}` is not of the form `package  # why`")
  endif()
endforeach()

list(LENGTH packages count)
set(unique ${packages})
list(REMOVE_DUPLICATES unique)
if(count EQUAL 0 OR NOT unique STREQUAL packages)
  message(FATAL_ERROR "packages.apt: no package, or one listed twice: ${packages}")
endif()

execute_process(COMMAND bash -c ". \"$0/scripts/common.sh\" && listed_packages packages.apt" ${SOURCE_FOLDER}
  OUTPUT_VARIABLE listed RESULT_VARIABLE status OUTPUT_STRIP_TRAILING_WHITESPACE)
string(REPLACE "\n" ";" listed "${listed}")
if(NOT status EQUAL 0 OR NOT listed STREQUAL packages)
  message(FATAL_ERROR "scripts/common.sh reads [${listed}], the file has [${packages}]")
endif()
