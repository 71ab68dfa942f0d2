# The programs, and what they need and say: data, manual pages, documents, examples, licences.
include(GNUInstallDirs)
set(documents ${CMAKE_INSTALL_DOCDIR})

install(TARGETS vesper-cli vesper-drive-cli vesper-bench-cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
if(TARGET vesper-mpi)
    install(TARGETS vesper-mpi LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/vesper)
endif()
# The generators stay with the source.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/data/ DESTINATION ${CMAKE_INSTALL_DATADIR}/vesper
        PATTERN generate.py EXCLUDE PATTERN rivoli/street EXCLUDE PATTERN __pycache__ EXCLUDE)
install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md ${PROJECT_SOURCE_DIR}/CONTRIBUTING.md DESTINATION ${documents})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs DESTINATION ${documents})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/apps/examples/ DESTINATION ${documents}/examples PATTERN __pycache__ EXCLUDE)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${documents} RENAME copyright)
# Parts of these are in the programs; where the system says under which licences, that goes along.
foreach(package libimgui-dev libcli11-dev nlohmann-json3-dev libglm-dev libeigen3-dev libtinygltf-dev)
    if(EXISTS /usr/share/doc/${package}/copyright)
        install(FILES /usr/share/doc/${package}/copyright DESTINATION ${documents}/parts RENAME ${package}.txt)
    endif()
endforeach()

if(NOT CMAKE_CROSSCOMPILING)
    set(pages "")
    foreach(name vesper vesper-drive vesper-bench)
        set(page ${PROJECT_BINARY_DIR}/man/${name}.1)
        add_custom_command(
            OUTPUT ${page}
            DEPENDS ${name}-cli ${PROJECT_SOURCE_DIR}/cmake/manual_page.cmake
            COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:${name}-cli> -DNAME=${name} -DVERSION=${PROJECT_VERSION}
                    "-DABOUT=${PROJECT_DESCRIPTION}" -DPAGE=${page} -P ${PROJECT_SOURCE_DIR}/cmake/manual_page.cmake
            COMMENT "Manual page ${name}.1"
            VERBATIM)
        list(APPEND pages ${page})
    endforeach()
    add_custom_target(vesper-manual ALL DEPENDS ${pages})
    install(FILES ${pages} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
endif()
