# SuiteSparse 5.12 has no CMake package on Debian: imported targets SuiteSparse::cholmod,
# SuiteSparse::umfpack and SuiteSparse::klu. A config package, where one exists, is preferred.
find_package(SuiteSparse CONFIG QUIET)
if(SuiteSparse_FOUND)
  return()
endif()
include(FindPackageHandleStandardArgs)
find_path(SuiteSparse_INCLUDE_DIR umfpack.h PATH_SUFFIXES suitesparse)
foreach(part umfpack klu btf cholmod amd colamd camd ccolamd suitesparseconfig)
  find_library(SuiteSparse_${part}_LIBRARY ${part})
  list(APPEND _needed SuiteSparse_${part}_LIBRARY)
endforeach()
if(SuiteSparse_INCLUDE_DIR)
  file(STRINGS ${SuiteSparse_INCLUDE_DIR}/SuiteSparse_config.h _lines REGEX "#define SUITESPARSE_(MAIN|SUB)_VERSION")
  string(REGEX REPLACE ".*MAIN_VERSION +([0-9]+).*SUB_VERSION +([0-9]+).*" "\\1.\\2" SuiteSparse_VERSION "${_lines}")
endif()
find_package_handle_standard_args(SuiteSparse REQUIRED_VARS SuiteSparse_INCLUDE_DIR ${_needed}
                                  VERSION_VAR SuiteSparse_VERSION)
if(SuiteSparse_FOUND AND NOT TARGET SuiteSparse::umfpack)
  foreach(part suitesparseconfig amd colamd camd ccolamd cholmod umfpack btf klu)
    add_library(SuiteSparse::${part} UNKNOWN IMPORTED)
    set_target_properties(SuiteSparse::${part} PROPERTIES IMPORTED_LOCATION ${SuiteSparse_${part}_LIBRARY}
                          INTERFACE_INCLUDE_DIRECTORIES ${SuiteSparse_INCLUDE_DIR})
  endforeach()
  set_property(TARGET SuiteSparse::cholmod PROPERTY INTERFACE_LINK_LIBRARIES SuiteSparse::amd
    SuiteSparse::colamd SuiteSparse::camd SuiteSparse::ccolamd SuiteSparse::suitesparseconfig)
  set_property(TARGET SuiteSparse::umfpack PROPERTY INTERFACE_LINK_LIBRARIES SuiteSparse::cholmod
    SuiteSparse::amd SuiteSparse::suitesparseconfig)
  set_property(TARGET SuiteSparse::klu PROPERTY INTERFACE_LINK_LIBRARIES SuiteSparse::btf
    SuiteSparse::amd SuiteSparse::colamd SuiteSparse::suitesparseconfig)
endif()
