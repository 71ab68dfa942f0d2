// A fragment of what is rasterized into a shadow map. Needs what nearer.glsl needs.

layout(constant_id = 1) const uint kOver = 0u;
layout(location = 0) flat in uint first;  // texel of the hemisphere
layout(location = 1) flat in uint side;   // of it, texels
layout(binding = 1, scalar) buffer Words { uint words[]; };
layout(binding = 2, scalar) buffer Changed { uint changed[]; };

#include "nearer.glsl"

void draw_fragment(bool is_drawn) {
    // Invocations that only help others cover nothing.
    const uvec2 texel = uvec2(gl_FragCoord.xy);
    const bool covered = is_drawn && gl_SampleMaskIn[0] != 0 && all(lessThan(texel, uvec2(side)));
    if (kOver != 0u && covered) list_changed(first, side, texel);
    keep_nearer(covered, first + (covered ? texel.y * side + texel.x : 0u), gl_FragCoord.z);
}
