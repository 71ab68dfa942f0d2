// What lets one header serve GLSL and C++: the same names, laid out "scalar" on both sides. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_TYPES_H
#define VESPER_SHARED_TYPES_H

#ifdef __cplusplus
#include <cstdint>
#include <glm/glm.hpp>
#define SHARED_BEGIN              \
    namespace vesper::shared {    \
    using glm::uvec2, glm::uvec4; \
    using glm::vec2;              \
    using glm::vec3, glm::vec4;   \
    using uint = std::uint32_t;
#define SHARED_END }
#define SHARED_SIZE(type, bytes) static_assert(sizeof(type) == bytes);
#else
#define SHARED_BEGIN
#define SHARED_END
#define SHARED_SIZE(type, bytes)
#endif

#endif
