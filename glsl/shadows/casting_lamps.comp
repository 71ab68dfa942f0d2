#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Lamps whose shadows are drawn: all but the faintest of those that may be left out, as many as together give at most a share of
// the picture's light. These keep no map, so that nothing hides them. One lamp per invocation.

#include "shared/visibility.h"

layout(local_size_x = 64) in;

layout(binding = 0, scalar) readonly buffer Sums { uint sums[]; };        // as light_shares.comp leaves them
layout(binding = 1, scalar) readonly buffer Optional { uint optional[]; };  // lamps that may be left out, ascending
layout(binding = 2, scalar) readonly buffer Given { ShadowMap given[]; };
layout(binding = 3, scalar) writeonly buffer Maps { ShadowMap maps[]; };
layout(binding = 4, scalar) buffer Report { VisibilityReport report; };
layout(push_constant, scalar) uniform Push { CastingLampsPush push; };

void main() {
    const uint lamp = gl_GlobalInvocationID.x;
    if (lamp >= push.lamps) return;
    const uint own = sums[lamp];
    bool may_be_left_out = false;
    float light = 0.0;  // of those that are no brighter, of lamps of the same light the first
    uint i = 0u;
    do {
        const uint other = optional[i], its = other < push.lamps ? sums[other] : 0u;
        may_be_left_out = may_be_left_out || other == lamp;
        light += its < own || (its == own && other <= lamp) ? float(its) : 0.0;
    } while (++i < push.optional);
    ShadowMap map = given[lamp];
    const float all_light = float(push.whole) * float(push.blocks);
    if (may_be_left_out && sums[push.lamps] == 0u && light <= push.most_share * all_light && map.side != 0.0) {
        map.side = 0.0;
        atomicAdd(report.unshadowed, 1u);
        atomicAdd(report.unshadowed_light, uint(1e6 * float(own) / all_light + 0.5));
    }
    maps[lamp] = map;
}
