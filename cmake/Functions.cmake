# vesper_embed_shaders(<target> <file>...)
#   Compiles each shader of glsl/ to SPIR-V and links it into <target> as an array. The array is named after the file
#   without its folder, the header that declares it after both: glsl/sky/sky.comp becomes the array sky_comp of
#   <shaders/sky/sky.comp.inc>. Shaders include files of glsl/ by their path in it, files of their own folder by their
#   name. A shader that includes texels.glsl is compiled once more, with STORAGE_TEXELS: sky_comp_storage. Code includes
#   the declarations alone: when a shader changes, its array is compiled and what has it linked.
find_program(VESPER_GLSLANG NAMES glslang glslangValidator REQUIRED)

function(vesper_embed_shaders target)
    foreach(name IN LISTS ARGN)
        cmake_path(GET name FILENAME file)
        string(MAKE_C_IDENTIFIER ${file} array)
        set(source ${PROJECT_SOURCE_DIR}/glsl/${name})
        set(made ${CMAKE_CURRENT_BINARY_DIR}/shaders/${name}.cpp)
        file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/shaders/${name}.inc @ONLY
             CONTENT "#pragma once\n#include <cstdint>\n\nnamespace vesper {\nextern const uint32_t @array@[], @array@_storage[];\n}\n")
        add_custom_command(
            OUTPUT ${made}
            DEPENDS ${source} ${PROJECT_SOURCE_DIR}/cmake/embed_shader.cmake
            DEPFILE ${made}.d
            COMMAND ${CMAKE_COMMAND} -DGLSLANG=${VESPER_GLSLANG} -DSHADER=${source} -DARRAY=${array} -DGLSL=${PROJECT_SOURCE_DIR}/glsl
                    -DOPERATORS=${CMAKE_CURRENT_BINARY_DIR}/operators -DMADE=${made} -P ${PROJECT_SOURCE_DIR}/cmake/embed_shader.cmake
            COMMENT "Shader ${name}"
            VERBATIM)
        target_sources(${target} PRIVATE ${made})
        set_source_files_properties(${made} PROPERTIES SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON)
    endforeach()
    target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR})
endfunction()

# vesper_operators(<target>)
#   Reads the operators of vesper/operators.h and writes, for files named after them, what includes and calls them:
#   operators_frames.glsl (NAME_frame) and operators_pixels.glsl (NAME_seen, NAME_mapped, NAME_rgb, where
#   glsl/operators/NAME.glsl defines NAME_SEEN, NAME_MAPPED, NAME_RGB in capitals), and render/operators/all.inc of
#   engine/render/operators/NAME.h.
function(vesper_operators target)
    set(list ${PROJECT_SOURCE_DIR}/engine/include/vesper/operators.h)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${list})
    file(READ ${list} text)
    string(REGEX MATCHALL "X\\([A-Z]+, [A-Za-z]+, [a-z]+, [0-9]+," lines "${text}")
    foreach(line IN LISTS lines)
        string(REGEX REPLACE "X\\(([A-Z]+), [A-Za-z]+, ([a-z]+), ([0-9]+)," "\\1;\\2;\\3" parts "${line}")
        list(GET parts 0 NAME)
        list(GET parts 1 name)
        list(GET parts 2 value)
        string(APPEND includes "#include \"operators/${name}.glsl\"\n")
        string(APPEND headers "#include \"render/operators/${name}.h\"\n")
        string(APPEND frame "    if (kOperator == ${value}u) ${name}_frame(frame);\n")
        string(APPEND seen "#ifdef ${NAME}_SEEN\n    if (kForm == ${value}u) return ${name}_seen(tone, rgb);\n#endif\n")
        string(APPEND itself "#if defined(${NAME}_MAPPED) || defined(${NAME}_RGB)\n    || kForm == ${value}u\n#endif\n")
        string(APPEND mapped "#ifdef ${NAME}_MAPPED\n    if (kForm == ${value}u) return ${name}_mapped(curve, tone, rgb, luminance);\n#endif\n")
        string(APPEND rgb "#ifdef ${NAME}_RGB\n    if (kForm == ${value}u && is_finite(luminance_of(rgb))) return ${name}_rgb(tone, rgb);\n#endif\n")
    endforeach()
    set(pixel_includes "${includes}\nconst bool kMapsItself = false\n${itself};\n\n")
    set(made ${CMAKE_CURRENT_BINARY_DIR}/operators)
    file(CONFIGURE OUTPUT ${made}/operators_frames.glsl @ONLY
         CONTENT "${includes}\nvoid operator_frame(Frame frame) {\n${frame}}\n")
    file(CONFIGURE OUTPUT ${made}/operators_pixels.glsl @ONLY
         CONTENT "${pixel_includes}vec3 operator_seen(Tone tone, vec3 rgb) {\n${seen}    return rgb;\n}\n
Mapped operator_mapped(samplerBuffer curve, Tone tone, vec3 rgb, float luminance) {\n${mapped}    return Mapped(luminance, 1.0, 1.0);\n}\n
vec3 operator_rgb(Tone tone, vec3 rgb) {\n${rgb}    return rgb;\n}\n")
    file(CONFIGURE OUTPUT ${made}/render/operators/all.inc CONTENT "${headers}" @ONLY)
    target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${made}>)
endfunction()

# vesper_embed_texts(<target> <made> <file>...)
#   Writes the include file <made> with one line {"name", text} for each file, name without folder and extension.
function(vesper_embed_texts target made)
    set(lines "")
    foreach(file IN LISTS ARGN)
        get_filename_component(name ${file} NAME_WE)
        file(READ ${file} text)
        string(APPEND lines "{\"${name}\", R\"text(${text})text\"},\n")
        set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    endforeach()
    file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/${made} CONTENT "${lines}" @ONLY)
    target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR})
endfunction()

# vesper_warnings(<target>): the project's warnings, never passed on to users.
function(vesper_warnings target)
    target_compile_options(${target} PRIVATE
        -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
        $<$<AND:$<CXX_COMPILER_ID:GNU>,$<BOOL:${VESPER_PRECOMPILE}>>:-Wno-array-bounds -Wno-stringop-overflow>  # the same, from precompiled headers
        $<$<AND:$<CXX_COMPILER_ID:GNU>,$<BOOL:${CMAKE_UNITY_BUILD}>>:-Wno-subobject-linkage>  # files of a unity build look like headers
        -Wno-missing-field-initializers  # designated initializers leave the other Vulkan fields zero
        $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>  # false alarms on std::string in GCC 12 (its bug 105651)
        # false alarms on references into a document, got through a temporary that refers to it
        $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_GREATER_EQUAL:$<CXX_COMPILER_VERSION>,13>>:-Wno-dangling-reference>)
endfunction()

# vesper_precompile(<target> <header>...)
# vesper_precompile(<target> FROM <other>)
#   For shorter builds. Compiles the headers that most files use, and <header>..., once for all files of <target>; or
#   takes those of <other>, whose code must be as position-independent and whose -O0, or not, must be the same. Every
#   file still includes what it uses: with VESPER_PRECOMPILE=OFF all compile without.
option(VESPER_PRECOMPILE "Precompile headers" ON)
function(vesper_precompile target)
    cmake_parse_arguments(PARSE_ARGV 1 "" "" FROM "")
    if(NOT VESPER_PRECOMPILE)
    elseif(_FROM)
        target_precompile_headers(${target} REUSE_FROM ${_FROM})
    else()
        target_precompile_headers(${target} PRIVATE
            <algorithm> <array> <cmath> <cstdint> <cstdio> <cstring> <filesystem> <functional> <limits> <map> <memory> <numbers>
            <optional> <random> <set> <span> <string> <string_view> <tuple> <utility> <vector>
            <vulkan/vulkan.h> <glm/glm.hpp> <glm/gtc/quaternion.hpp> <nlohmann/json.hpp> ${_UNPARSED_ARGUMENTS})
    endif()
    vesper_unity(${target})
endfunction()

# vesper_unity(<target>)
#   In a unity build, files of one folder of <target> are compiled together, eight at a time. Names in anonymous
#   namespaces must differ within a folder.
function(vesper_unity target)
    set(most 8)
    get_target_property(sources ${target} SOURCES)
    list(FILTER sources INCLUDE REGEX "\\.cpp$")
    foreach(source IN LISTS sources)
        cmake_path(GET source PARENT_PATH folder)
        string(MD5 key "${folder}")
        if(NOT DEFINED number_${key})
            set(number_${key} 0)
        endif()
        math(EXPR group "${number_${key}} / ${most}")
        set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${key}_${group})
        math(EXPR number_${key} "${number_${key}} + 1")
    endforeach()
    set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
endfunction()
