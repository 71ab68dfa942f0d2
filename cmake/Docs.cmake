# The reference documentation of the public headers: cmake --build build/release --target docs. Whatever is not documented is an error.
if(NOT PROJECT_IS_TOP_LEVEL)
    return()
endif()
find_package(Doxygen QUIET OPTIONAL_COMPONENTS dot)
if(DOXYGEN_FOUND)
    set(DOXYGEN_PROJECT_NAME Vesper)
    set(DOXYGEN_PROJECT_BRIEF ${PROJECT_DESCRIPTION})
    set(DOXYGEN_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/docs)
    set(DOXYGEN_USE_MDFILE_AS_MAINPAGE ${PROJECT_SOURCE_DIR}/docs/embedding.md)
    set(DOXYGEN_OPTIMIZE_OUTPUT_FOR_C YES)
    set(DOXYGEN_EXTRACT_ALL NO)
    set(DOXYGEN_QUIET YES)
    set(DOXYGEN_WARN_IF_UNDOCUMENTED YES)
    set(DOXYGEN_WARN_NO_PARAMDOC NO)  # parameters say what they are by name
    set(DOXYGEN_WARN_AS_ERROR FAIL_ON_WARNINGS)
    set(DOXYGEN_EXCLUDE_SYMBOLS VESPER_VESPER_H VESPER_VULKAN_H VESPER_VISION_H VESPER_VESPER_HPP VESPER_ROADS_HPP VESPER_ROAD_LIGHTING_HPP)
    doxygen_add_docs(docs ${PROJECT_SOURCE_DIR}/engine/include/vesper ${PROJECT_SOURCE_DIR}/docs/embedding.md
                     ${PROJECT_SOURCE_DIR}/docs/embedding-device.md ${PROJECT_SOURCE_DIR}/docs/embedding-vision.md ${PROJECT_SOURCE_DIR}/docs/quality.md ${PROJECT_SOURCE_DIR}/docs/quality-errors.md ${PROJECT_SOURCE_DIR}/docs/tone-settings.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md
                     COMMENT "Reference documentation")
endif()
