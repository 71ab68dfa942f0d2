#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Shadow maps, texels of large opaque triangles.

#include "shared/shadow_map.h"
#include "fragment.glsl"

void main() { draw_fragment(true); }
