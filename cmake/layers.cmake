# SPDX-License-Identifier: BSD-3-Clause
# The layers of the project: a folder is a library is a target, and a library may use only what
# stands here.
set(terrain_layer_files "")
set(terrain_layer_core "Eigen3::Eigen")
set(terrain_layer_octree "octomap")
set(terrain_layer_params "core" "mrpt::config" "mrpt::containers")
set(terrain_layer_sensors "params" "yaml-cpp" "mrpt::containers")
set(terrain_layer_sim "core" "files" "params" "sensors" "embree" "yaml-cpp")
set(terrain_layer_io "core" "files" "params" "sensors" "mrpt::obs" "mrpt::maps" "mrpt::io" "mrpt::containers" "ZLIB::ZLIB")
set(terrain_layer_view "core" "files" "mrpt::opengl" "PkgConfig::cairo" "nlohmann_json::nlohmann_json"
  "ZLIB::ZLIB")
# `view` draws and writes descriptions for the map as for terrain-rawlog.
set(terrain_layer_map "core" "files" "io" "octomap" "octree" "params" "sensors" "view" "mrpt::maps" "mrpt::opengl"
  "ZLIB::ZLIB")
set(terrain_layer_eval "core" "files" "params" "io" "sensors" "sim")
set(terrain_layer_peers "core" "eval" "pcl_sample_consensus")
# Truth and result cannot leak into each other: of core, sim may include the data types only.
set(terrain_core_headers_of_sim grid_geometry labels param_info points random)

# terrain_library(NAME [SHARED] [NOT_INSTALLED] USES target... [PRIVATE_USES target...])
# Builds libs/NAME from all its sources as mrpt_terrain::NAME. Refuses a dependency that the table
# above does not allow; libraries of this project are written without namespace.
function(terrain_library name)
  cmake_parse_arguments(arg "SHARED;NOT_INSTALLED" "" "USES;PRIVATE_USES" ${ARGN})
  if(NOT DEFINED terrain_layer_${name})
    message(FATAL_ERROR "libs/${name} is not in the table of cmake/layers.cmake")
  endif()
  foreach(dependency IN LISTS arg_USES arg_PRIVATE_USES)
    if(NOT dependency IN_LIST terrain_layer_${name})
      message(FATAL_ERROR "libs/${name} may not use ${dependency}: cmake/layers.cmake allows "
        "${terrain_layer_${name}}")
    endif()
  endforeach()
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/src/*.cpp)
  set(kind STATIC)
  if(arg_SHARED)
    set(kind SHARED)
  endif()
  add_library(mrpt_terrain_${name} ${kind} ${sources})
  add_library(mrpt_terrain::${name} ALIAS mrpt_terrain_${name})
  set_target_properties(mrpt_terrain_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(mrpt_terrain_${name} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(mrpt_terrain_${name} PUBLIC cxx_std_17)
  # Names of this table are libraries of this project.
  foreach(list IN ITEMS arg_USES arg_PRIVATE_USES)
    set(targets_${list} ${${list}})
    foreach(dependency IN LISTS ${list})
      if(DEFINED terrain_layer_${dependency})
        list(TRANSFORM targets_${list} REPLACE "^${dependency}$" "mrpt_terrain::${dependency}")
      endif()
    endforeach()
  endforeach()
  target_link_libraries(mrpt_terrain_${name}
    PUBLIC ${targets_arg_USES}
    PRIVATE ${targets_arg_PRIVATE_USES} $<BUILD_INTERFACE:mrpt_terrain_options>)
  if(arg_NOT_INSTALLED)
    return()
  endif()
  install(TARGETS mrpt_terrain_${name} EXPORT mrpt_terrain_targets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  set_property(GLOBAL APPEND PROPERTY terrain_libraries ${name})
endfunction()
