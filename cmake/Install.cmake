# What other programs need: find_package(vesper CONFIG), pkg-config, or libvesper-c.so alone.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS vesper-c EXPORT vesper LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(FILES ${PROJECT_SOURCE_DIR}/engine/include/vesper/vesper.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/vesper)
install(EXPORT vesper NAMESPACE vesper:: FILE vesperConfig.cmake DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vesper)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/vesperConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/vesperConfigVersion.cmake DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vesper)
file(RELATIVE_PATH VESPER_UP /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
configure_file(${PROJECT_SOURCE_DIR}/cmake/vesper.pc.in ${PROJECT_BINARY_DIR}/vesper.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/vesper.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
