#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// G-buffer, vertices: mesh frame to view frame to clip space with a reversed, endless depth range. What is constant over
// a batch is handed on as flat varyings, which a CPU device reads much faster than push constants in the fragment stage.

#include "shared/gbuffer.h"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec4 colour;
layout(location = 4) in vec4 row_x;
layout(location = 5) in vec4 row_y;
layout(location = 6) in vec4 row_z;
layout(location = 7) in float dimming;
layout(location = 8) in vec2 emission_shift;

layout(push_constant, scalar) uniform Push { GBufferPush push; };

layout(location = 0) out vec3 view_normal;
layout(location = 1) out vec2 texture_uv;
layout(location = 2) out vec4 base_colour;
layout(location = 3) flat out vec4 emission_cutoff;
layout(location = 4) flat out vec2 metallic_roughness;
layout(location = 6) out vec2 emission_uv;
layout(location = 5) flat out uvec2 triangle;  // of the first vertex, which no other triangle has as its first

void main() {
    const vec4 p = vec4(position, 1.0);
    const vec3 view = vec3(dot(row_x, p), dot(row_y, p), dot(row_z, p));
    gl_Position = vec4(push.clip_scale * view.xy + push.clip_offset * view.z, push.near, -view.z);

    // Normals go by the cofactor matrix: right under any scale, mirrored ones included once the determinant's sign is
    // taken out, since the winding of mirrored instances is flipped as well.
    const vec3 cofactor_x = cross(row_y.xyz, row_z.xyz);
    const vec3 cofactor_y = cross(row_z.xyz, row_x.xyz);
    const vec3 cofactor_z = cross(row_x.xyz, row_y.xyz);
    const vec3 n = vec3(dot(cofactor_x, normal), dot(cofactor_y, normal), dot(cofactor_z, normal));
    view_normal = dot(row_x.xyz, cofactor_x) < 0.0 ? -n : n;

    texture_uv = uv;
    emission_uv = uv + emission_shift;
    base_colour = push.base_colour * colour;
    emission_cutoff = vec4(dimming * push.emission, push.alpha_cutoff);
    metallic_roughness = vec2(push.metallic, push.roughness);
    triangle = uvec2(gl_InstanceIndex + 1, gl_VertexIndex);
}
