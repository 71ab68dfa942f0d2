#version 460

// Clipmaps, fragments: masked materials let light through where their texture does.

layout(constant_id = 0) const uint kMask = 0u;

layout(location = 0) in vec2 texture_uv;
layout(location = 1) in float opacity;

layout(binding = 0) uniform sampler2D base_texture;  // opacity in alpha
layout(push_constant) uniform Push {
    float base_opacity;
    float cutoff;
} push;

void main() {
    if (kMask != 0u && push.base_opacity * opacity * texture(base_texture, texture_uv).a < push.cutoff) discard;
}
