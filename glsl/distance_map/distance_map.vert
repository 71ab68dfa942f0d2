#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Distance maps, vertices: mesh frame to the frame of a map to a quadrant of a hemisphere (shared/distance_map.h). What
// is outside the quadrant is clipped, but for a hair, so that no texel on its border is left to neither side.

#include "shared/distance_map.h"

layout(location = 0) in vec3 position;
layout(location = 1) in vec2 uv;
layout(location = 2) in vec4 colour;
layout(location = 3) in vec4 row_x;
layout(location = 4) in vec4 row_y;
layout(location = 5) in vec4 row_z;
layout(location = 6) in vec4 place;
layout(location = 7) in vec4 window;
layout(location = 8) in float y_sign;

layout(location = 0) out vec2 texture_uv;
layout(location = 1) out float opacity;

out float gl_ClipDistance[7];

const float kHair = 1e-5;

void main() {
    const vec4 p = vec4(position, 1.0);
    const vec3 q = vec3(dot(row_x, p), dot(row_y, p), dot(row_z, p));
    const float x = y_sign == 0.0 ? 0.0 : place.w < 0.0 ? -q.x : q.x, y = y_sign * q.y;
    const float norm = x + y + q.z;
    const vec2 square = abs(place.w) * vec2(q.x + q.y, q.x - q.y);
    gl_Position = vec4(place.x * square + norm * place.yz, kMapNear, norm);
    gl_ClipDistance[0] = x + kHair * norm;
    gl_ClipDistance[1] = y + kHair * norm;
    gl_ClipDistance[2] = q.z + kHair * norm;
    gl_ClipDistance[3] = square.x - window.x * norm;
    gl_ClipDistance[4] = square.y - window.y * norm;
    gl_ClipDistance[5] = window.z * norm - square.x;
    gl_ClipDistance[6] = window.w * norm - square.y;
    texture_uv = uv;
    opacity = colour.a;
}
