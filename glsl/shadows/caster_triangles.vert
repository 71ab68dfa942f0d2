#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Shadow maps, corners of the large opaque triangles that cull_triangles.comp has listed.

#include "shared/shadow_map.h"

layout(location = 0) in vec3 position;
layout(location = 1) in uint number;

layout(binding = 0, scalar) readonly buffer Quadrants { MapQuadrant quadrants[]; };

layout(location = 0) flat out uint first;
layout(location = 1) flat out uint side;
out float gl_ClipDistance[7];

#include "quadrant.glsl"

void main() {
    const MapQuadrant quadrant = quadrants[number];
    const InQuadrant at = to_quadrant(position, quadrant);
    first = quadrant.first;
    side = quadrant.side;
    gl_Position = in_raster(at, quadrant);
    for (int i = 0; i < 7; ++i) gl_ClipDistance[i] = at.outside[i];
}
