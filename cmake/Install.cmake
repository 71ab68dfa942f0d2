# What other programs need: find_package(vesper CONFIG), pkg-config, or libvesper-c.so alone.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(VESPER_CONFIG_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/vesper)

install(TARGETS vesper-c EXPORT vesper-shared LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS vesper vesper-analysis EXPORT vesper-static ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/engine/include/vesper DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} PATTERN road*.hpp EXCLUDE)
foreach(kind shared static)
    install(EXPORT vesper-${kind} NAMESPACE vesper:: FILE vesper-${kind}.cmake DESTINATION ${VESPER_CONFIG_DIR})
endforeach()

# Roads stand on the static library. vesper-traffic has no public header and is not installed.
set(road_headers ${PROJECT_SOURCE_DIR}/engine/include/vesper/roads.hpp ${PROJECT_SOURCE_DIR}/engine/include/vesper/road_lighting.hpp)
install(TARGETS vesper-roads EXPORT vesper-roads ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT roads)
install(FILES ${road_headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/vesper COMPONENT roads)
install(EXPORT vesper-roads NAMESPACE vesper:: FILE vesper-roads.cmake DESTINATION ${VESPER_CONFIG_DIR} COMPONENT roads)

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/vesperConfig.cmake.in ${PROJECT_BINARY_DIR}/vesperConfig.cmake INSTALL_DESTINATION ${VESPER_CONFIG_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/vesperConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/vesperConfig.cmake ${PROJECT_BINARY_DIR}/vesperConfigVersion.cmake DESTINATION ${VESPER_CONFIG_DIR})
file(RELATIVE_PATH VESPER_UP /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
# NAME LIBS: makes NAME.pc for pkg-config; what follows is what the library requires of others.
function(vesper_pkgconfig PC_NAME PC_LIBS)
    string(JOIN " " PC_REQUIRES ${ARGN})
    configure_file(${PROJECT_SOURCE_DIR}/cmake/vesper.pc.in ${PROJECT_BINARY_DIR}/${PC_NAME}.pc @ONLY)
endfunction()
vesper_pkgconfig(vesper -lvesper-c)
# Embree and meshoptimizer have no files for pkg-config.
set(VESPER_WEBP "")
if(webp_FOUND)
    set(VESPER_WEBP libwebp)
endif()
vesper_pkgconfig(vesper-static "-lvesper-analysis -lvesper -lembree${EMBREE_VERSION_MAJOR} -lmeshoptimizer -lstdc++ -lm" vulkan OpenEXR libpng libjpeg libexif ${VESPER_WEBP})
vesper_pkgconfig(vesper-roads -lvesper-roads pugixml vesper-static)
install(FILES ${PROJECT_BINARY_DIR}/vesper.pc ${PROJECT_BINARY_DIR}/vesper-static.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
install(FILES ${PROJECT_BINARY_DIR}/vesper-roads.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT roads)
