#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Shadow maps, texels of masked parts, which let light through where their texture does.

#include "shared/shadow_map.h"

layout(constant_id = 0) const uint kMask = 0u;

layout(location = 2) in vec2 texture_uv;
layout(location = 3) in float opacity;

layout(binding = 3) uniform sampler2D base_texture;  // opacity in alpha
layout(push_constant) uniform Push {
    float base_opacity;
    float cutoff;
} push;

#include "fragment.glsl"

void main() {
    draw_fragment(kMask == 0u || push.base_opacity * opacity * texture(base_texture, texture_uv).a >= push.cutoff);
}
