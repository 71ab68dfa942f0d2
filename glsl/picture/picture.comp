#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Picture: what another renderer left in an image of any float format, as scene luminance.

#include "shared/picture.h"

layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler2D picture;
layout(binding = 1, rgba32f) writeonly uniform image2D scene;
layout(push_constant, scalar) uniform Push { PicturePush push; };

void main() {
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, push.size))) return;
    imageStore(scene, ivec2(at), vec4(push.scale * texelFetch(picture, ivec2(at), 0).rgb, 1.0));
}
