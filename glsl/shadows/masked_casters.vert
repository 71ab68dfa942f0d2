#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Shadow maps, vertices of masked parts: mesh frame to the frame of a map to a quadrant of a hemisphere
// (shared/shadow_map.h), outside of which they are clipped.

#include "shared/shadow_map.h"

layout(location = 0) in vec3 position;
layout(location = 1) in vec2 uv;
layout(location = 2) in vec4 colour;
layout(location = 3) in vec4 row_x;
layout(location = 4) in vec4 row_y;
layout(location = 5) in vec4 row_z;
layout(location = 6) in uint number;

layout(binding = 0, scalar) readonly buffer Quadrants { MapQuadrant quadrants[]; };

layout(location = 0) flat out uint first;
layout(location = 1) flat out uint side;
layout(location = 2) out vec2 texture_uv;
layout(location = 3) out float opacity;

out float gl_ClipDistance[7];

#include "quadrant.glsl"

void main() {
    const vec4 p = vec4(position, 1.0);
    const MapQuadrant quadrant = quadrants[number];
    const InQuadrant at = to_quadrant(vec3(dot(row_x, p), dot(row_y, p), dot(row_z, p)), quadrant);
    gl_Position = in_raster(at, quadrant);
    for (int i = 0; i < 7; ++i) gl_ClipDistance[i] = at.outside[i];
    first = quadrant.first;
    side = quadrant.side;
    texture_uv = uv;
    opacity = colour.a;
}
