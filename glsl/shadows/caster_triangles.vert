#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Shadow maps, vertices of opaque parts that cull_triangles.comp has kept: in the frame of the map.

#include "shared/shadow_map.h"

layout(location = 0) in vec3 position;
layout(push_constant, scalar) uniform Push { MapQuadrant quadrant; };

out float gl_ClipDistance[7];

#include "quadrant.glsl"

void main() {
    const InQuadrant at = to_quadrant(position, quadrant.place, quadrant.window, quadrant.y_sign, quadrant.overlap);
    gl_Position = at.position;
    for (int i = 0; i < 7; ++i) gl_ClipDistance[i] = at.outside[i];
}
