# One package with everything that is installed: cpack -G DEB in a build folder.
set(CPACK_PACKAGE_NAME vesper)
set(CPACK_PACKAGE_VENDOR "The Vesper authors")
set(CPACK_PACKAGE_CONTACT "The Vesper authors <vesper@authors.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY ${PROJECT_DESCRIPTION})
set(CPACK_PACKAGE_DESCRIPTION "Vesper takes a daytime driving-simulator database, makes it photometric, renders it at night in cd/m^2,
and maps that to a described display with psychophysical operators. It has a command-line program, a driving simulator, a
benchmark, and a library for programs in C, C++ and Python.")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS mesa-vulkan-drivers)  # the device where there is no other
set(CPACK_DEBIAN_PACKAGE_SUGGESTS ffmpeg)              # films
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)           # with the call of ldconfig
include(CPack)
