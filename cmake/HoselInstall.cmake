# `cmake --install`: the command, the headers, and find_package(hosel).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
get_property(floors GLOBAL PROPERTY HOSEL_FLOORS)
install(TARGETS ${floors} EXPORT hosel ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS hosel RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY golf mesh fem solvers models post loop app
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/hosel FILES_MATCHING PATTERN "*.hpp")
install(DIRECTORY cases DESTINATION ${CMAKE_INSTALL_DATADIR}/hosel)
install(EXPORT hosel NAMESPACE hosel:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/hosel)
configure_package_config_file(cmake/hosel-config.cmake.in ${PROJECT_BINARY_DIR}/hosel-config.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/hosel)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/hosel-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/hosel-config.cmake ${PROJECT_BINARY_DIR}/hosel-config-version.cmake
        cmake/FindSuiteSparse.cmake DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/hosel)
