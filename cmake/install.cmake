# SPDX-License-Identifier: BSD-3-Clause
# The CMake package `mrpt_terrain`: find_package(mrpt_terrain) gives mrpt_terrain::core and so on.
include(CMakePackageConfigHelpers)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/mrpt_terrain)

# Packages behind the link interfaces of the libraries that were built, so that a core-only
# installation asks for Eigen alone.
get_property(libraries GLOBAL PROPERTY terrain_libraries)
set(package_names)
foreach(library IN LISTS libraries)
  get_target_property(used mrpt_terrain_${library} INTERFACE_LINK_LIBRARIES)
  foreach(item IN LISTS used)
    string(REGEX REPLACE "^\\$<LINK_ONLY:(.*)>$" "\\1" item "${item}")
    if(item MATCHES "^mrpt_terrain|^\\$<BUILD_INTERFACE:")
      continue()
    elseif(item MATCHES "^mrpt::(.+)$")
      list(APPEND package_names mrpt-${CMAKE_MATCH_1})
    elseif(item MATCHES "^PkgConfig::(.+)$")
      list(APPEND package_names pkg-config:${CMAKE_MATCH_1})
    elseif(item MATCHES "^(embree|octomap|yaml-cpp)$")
      list(APPEND package_names ${item})
    elseif(item MATCHES "^(.+)::.+$")
      list(APPEND package_names ${CMAKE_MATCH_1})
    else()
      message(FATAL_ERROR "cmake/install.cmake: libs/${library} links ${item}, which is no "
        "namespaced target: users of the installed package could not find it")
    endif()
  endforeach()
endforeach()
list(REMOVE_DUPLICATES package_names)
list(SORT package_names)

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/mrpt_terrain-config.cmake.in
  ${PROJECT_BINARY_DIR}/mrpt_terrain-config.cmake INSTALL_DESTINATION ${package_folder})
# Before 1.0 a change of the minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/mrpt_terrain-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES
  ${PROJECT_BINARY_DIR}/mrpt_terrain-config.cmake
  ${PROJECT_BINARY_DIR}/mrpt_terrain-config-version.cmake
  DESTINATION ${package_folder})
install(EXPORT mrpt_terrain_targets NAMESPACE mrpt_terrain:: DESTINATION ${package_folder})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/params ${PROJECT_SOURCE_DIR}/rawlogs
  DESTINATION ${CMAKE_INSTALL_DATADIR}/mrpt_terrain)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
