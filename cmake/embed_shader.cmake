# Compiles a shader to SPIR-V and writes it as a C++ source of two arrays, which begin with the number of their words: ARRAY, and
# ARRAY_storage, the same compiled with STORAGE_TEXELS. The second has no words unless the shader includes texels.glsl.
#   cmake -DGLSLANG=... -DSHADER=FILE -DARRAY=NAME -DGLSL=FOLDER -DOPERATORS=FOLDER -DMADE=SOURCE -P embed_shader.cmake
# Writes MADE and, with every file that the shader includes, MADE.d.
cmake_minimum_required(VERSION 3.25)

# compiled(NAME OPTION...): appends an array of SPIR-V to `source` and the included files to `included`.
function(compiled name)
    set(words ${MADE}.words)
    execute_process(COMMAND ${GLSLANG} --quiet --target-env vulkan1.3 ${ARGN} -I${GLSL} -I${OPERATORS} --vn code
                            --depfile ${words}.d -o ${words} ${SHADER}
                    RESULT_VARIABLE failed OUTPUT_VARIABLE said ERROR_VARIABLE said)
    if(failed)
        message(FATAL_ERROR "${said}")
    endif()
    file(READ ${words} code)
    string(REGEX REPLACE "^[^{]*{" "" code "${code}")
    string(REGEX MATCHALL "0x" counted "${code}")
    list(LENGTH counted count)
    file(READ ${words}.d depends)
    string(REGEX REPLACE "^[^:]*:|\n" "" depends "${depends}")
    file(REMOVE ${words} ${words}.d)
    set(source "${source}const uint32_t ${name}[]{${count}, ${code}" PARENT_SCOPE)
    set(included "${included}${depends}" PARENT_SCOPE)
endfunction()

set(source "")
set(included "")
file(READ ${SHADER} text)
compiled(${ARRAY})
if(text MATCHES "#include \"texels.glsl\"")
    compiled(${ARRAY}_storage -DSTORAGE_TEXELS)
else()
    string(APPEND source "const uint32_t ${ARRAY}_storage[]{0};\n")
endif()
cmake_path(GET SHADER FILENAME file)
file(WRITE ${MADE} "// Made of ${file}.\n#include \"${file}.inc\"\n\nnamespace vesper {\n\n${source}\n}  // namespace vesper\n")
file(WRITE ${MADE}.d "${MADE}:${included}\n")
