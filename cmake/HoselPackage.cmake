# The Debian package: `scripts/package` builds, checks and tries it. The preset `package` compiles for any x86-64.
set(HOSEL_MAINTAINER "The hosel authors <hosel@packages.invalid>" CACHE STRING "Who maintains the package: Name <address>")
if(DEFINED ENV{DEBEMAIL})  # as Debian's own tools take it
  set(HOSEL_MAINTAINER "$ENV{DEBFULLNAME} <$ENV{DEBEMAIL}>")
endif()

# The Python package, for the distribution's interpreter.
if(NOT TARGET hosel_python)
  message(FATAL_ERROR "a package needs the Python module: python3-dev and pybind11-dev are missing")
endif()
set(python lib/python3/dist-packages)
install(TARGETS hosel_python LIBRARY DESTINATION ${python}/hosel)
install(DIRECTORY python/hosel DESTINATION ${python} FILES_MATCHING PATTERN "*.py")

# What Debian asks of every package: copyright, both change logs and the manual page, compressed.
set(doc ${CMAKE_INSTALL_DATADIR}/doc/hosel)
install(FILES LICENSE DESTINATION ${doc} RENAME copyright)
install(FILES README.md SECURITY.md CITATION.cff DESTINATION ${doc})
install(DIRECTORY docs/ DESTINATION ${doc}/docs FILES_MATCHING PATTERN "*.md" PATTERN "*.png")
install(DIRECTORY examples DESTINATION ${doc} FILES_MATCHING PATTERN "*.cpp" PATTERN "*.py")
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE ${PROJECT_BINARY_DIR}/changelog.Debian
     "hosel (${PROJECT_VERSION}-1) bookworm; urgency=medium\n\n  * Version ${PROJECT_VERSION}; changelog.gz says what changed.\n\n -- ${HOSEL_MAINTAINER}  ${date}\n")
configure_file(CHANGELOG.md ${PROJECT_BINARY_DIR}/changelog COPYONLY)
foreach(log changelog changelog.Debian)
  execute_process(COMMAND gzip -9nf ${PROJECT_BINARY_DIR}/${log} COMMAND_ERROR_IS_FATAL ANY)
  install(FILES ${PROJECT_BINARY_DIR}/${log}.gz DESTINATION ${doc})
endforeach()
install(CODE "execute_process(COMMAND gzip -9nf \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/share/man/man1/hosel.1\" COMMAND_ERROR_IS_FATAL ANY)")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME hosel)
set(CPACK_PACKAGE_CONTACT "${HOSEL_MAINTAINER}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
execute_process(COMMAND "${Python_EXECUTABLE}" -c "import sys; print(*sys.version_info[:2], sys.version_info[1] + 1, sep=';')"
                OUTPUT_VARIABLE version OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
list(GET version 0 major)
list(GET version 1 minor)
list(GET version 2 next)
set(CPACK_DEBIAN_PACKAGE_DEPENDS
    "python3 (>= ${major}.${minor}), python3 (<< ${major}.${next}), python3-numpy, gnuplot-nox | gnuplot-qt | gnuplot-x11")
# Python compiles what root imports; the package takes it away again (py3clean of python3-minimal).
file(WRITE ${PROJECT_BINARY_DIR}/prerm "#!/bin/sh\nset -e\nif command -v py3clean >/dev/null; then\n  py3clean -p hosel\nfi\n")
file(CHMOD ${PROJECT_BINARY_DIR}/prerm PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/prerm)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3-matplotlib, bash-completion")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS
    "paraview, g++, cmake, libeigen3-dev, libsuitesparse-dev, libsundials-dev, libceres-dev, libtbb-dev, libboost-dev, libvtk9-dev, libfmt-dev, libspdlog-dev, libcli11-dev, libtomlplusplus-dev, libmuparser-dev, nlohmann-json3-dev")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "finite elements for the impact of a golf club on a ball")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
    "hosel computes what a ball does after a blow, and how much of that is due
to the shaft. The ball is viscoelastic, the head is rigid with a face that
deflects, and the shaft consists of tapered beam elements. Reduced models
answer the same question in microseconds. A loop compares each model with
measurement and names the missing effect.

The package holds the command, the C++ libraries, the Python package, the
cases and the library of balls, faces and heads.")
include(CPack)
