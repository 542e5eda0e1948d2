# Includes are paths of the tree ("fem/contact.hpp"); the install keeps the tree under include/hosel.
# One floor of the house: the static library of all sources in a folder, linked to the floors below.
function(hosel_floor name)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${name}/*.cpp)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${name}/*.hpp)
  list(FILTER sources EXCLUDE REGEX "/app/main\\.cpp$")
  if(NOT sources)
    add_library(hosel_${name} INTERFACE)
    set(scope INTERFACE)
  else()
    add_library(hosel_${name} STATIC ${sources} ${headers})
    set(scope PUBLIC)
    target_compile_options(hosel_${name} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wno-restrict
                           # Designated initialisers leave out what has a default. Without AVX lanes are returned in memory,
                           # by all that is linked here.
                           "$<$<BOOL:${HOSEL_WERROR}>:-Werror;-Wno-missing-field-initializers;-Wno-psabi>")
    # Files of the upper floors are compiled several at a time where the preset says so (CMAKE_UNITY_BUILD): a third of the time.
    if(name MATCHES "^(golf|mesh|fem|solvers)$")
      set_target_properties(hosel_${name} PROPERTIES UNITY_BUILD OFF)
    endif()
    # Floors with the same flags share one precompiled header, the first one's.
    if(NOT CMAKE_DISABLE_PRECOMPILE_HEADERS)
      # False alarms of GCC 12: inside Eigen's AVX-512 packets, and where a string is moved into a vector.
      target_compile_options(hosel_${name} PRIVATE "$<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds;-Wno-stringop-overread;-Wno-stringop-overflow>")
    endif()
    if(name MATCHES "^(mesh|fem|solvers|models|post)$")
      target_precompile_headers(hosel_${name} REUSE_FROM hosel_golf)
    else()
      target_precompile_headers(hosel_${name} PRIVATE ${PROJECT_SOURCE_DIR}/cmake/precompiled.hpp)
    endif()
  endif()
  add_library(hosel::${name} ALIAS hosel_${name})
  set_target_properties(hosel_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(hosel_${name} ${scope} $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                             $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/hosel>)
  target_link_libraries(hosel_${name} ${scope} ${ARGN})
  target_compile_features(hosel_${name} ${scope} cxx_std_20)
  set_property(GLOBAL APPEND PROPERTY HOSEL_FLOORS hosel_${name})
endfunction()
