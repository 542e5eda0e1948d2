# `cmake --install`: the command, the headers, and find_package(hosel).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
get_property(floors GLOBAL PROPERTY HOSEL_FLOORS)
# Eigen's alignment is part of the binary interface and follows the instruction set that the library is built for:
# whoever links it takes the same value, whatever its own flags are.
string(TOUPPER "${CMAKE_BUILD_TYPE}" config)
separate_arguments(flags UNIX_COMMAND "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${config}}")
execute_process(COMMAND ${CMAKE_CXX_COMPILER} ${flags} -dM -E -x c++ /dev/null OUTPUT_VARIABLE macros COMMAND_ERROR_IS_FATAL ANY)
if(macros MATCHES "__AVX512F__")
  set(alignment 64)
elseif(macros MATCHES "__AVX__")
  set(alignment 32)
else()
  set(alignment 16)
endif()
target_compile_definitions(hosel_golf INTERFACE $<INSTALL_INTERFACE:EIGEN_MAX_ALIGN_BYTES=${alignment}>)
install(TARGETS ${floors} EXPORT hosel ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS hosel RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY golf mesh fem solvers models post loop app
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/hosel FILES_MATCHING PATTERN "*.hpp")
install(FILES app/import/launch_monitors.toml DESTINATION ${CMAKE_INSTALL_DATADIR}/hosel)
install(DIRECTORY cases library DESTINATION ${CMAKE_INSTALL_DATADIR}/hosel PATTERN "make" EXCLUDE)
file(GLOB makes RELATIVE ${PROJECT_SOURCE_DIR} CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/cases/*/make)
foreach(make ${makes})  # scripts that made a case's data
  cmake_path(GET make PARENT_PATH folder)
  install(PROGRAMS ${make} DESTINATION ${CMAKE_INSTALL_DATADIR}/hosel/${folder})
endforeach()
install(DIRECTORY post/paraview DESTINATION ${CMAKE_INSTALL_DATADIR}/hosel)
# What moves in the pages: viewer.js is bundled by scripts/build-viewer.
install(FILES post/viewer/viewer.js post/viewer/viewer.sha256 post/viewer/LICENSES post/viewer/sliders.js post/viewer/sliders.sha256
        DESTINATION ${CMAKE_INSTALL_DATADIR}/hosel/viewer)
install(PROGRAMS scripts/pvbatch scripts/slurm-array DESTINATION ${CMAKE_INSTALL_DATADIR}/hosel/scripts)
# What the command says of itself, where man and bash look for it.
foreach(page "man|share/man/man1/hosel.1" "completion|share/bash-completion/completions/hosel")
  string(REPLACE "|" ";" page "${page}")
  list(GET page 0 command)
  list(GET page 1 file)
  install(CODE "set(file \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${file}\")
    cmake_path(GET file PARENT_PATH folder)
    file(MAKE_DIRECTORY \"\${folder}\")
    execute_process(COMMAND \"$<TARGET_FILE:hosel>\" ${command} OUTPUT_FILE \"\${file}\" COMMAND_ERROR_IS_FATAL ANY)")
endforeach()
install(EXPORT hosel NAMESPACE hosel:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/hosel)
configure_package_config_file(cmake/hosel-config.cmake.in ${PROJECT_BINARY_DIR}/hosel-config.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/hosel)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/hosel-config-version.cmake COMPATIBILITY SameMajorVersion)
install(FILES ${PROJECT_BINARY_DIR}/hosel-config.cmake ${PROJECT_BINARY_DIR}/hosel-config-version.cmake
        cmake/FindSuiteSparse.cmake DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/hosel)
