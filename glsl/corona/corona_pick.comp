#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// The kCoronaLamps brightest squares, brightest first, the one further up and left of two that are alike. What the next one has is taken
// off each, as a share of its light: a lamp that leaves the list has nothing left by then. One workgroup.

#include "shared/corona.h"

layout(local_size_x = 256) in;

layout(binding = 0, scalar) readonly buffer Tiles { CoronaTile tiles[]; };
layout(binding = 1, scalar) writeonly buffer Lamps { CoronaLamp lamps[]; };
layout(push_constant, scalar) uniform Push { CoronaPush push; };

const uint kNone = 0xffffffffu;

shared float brightest[256];
shared uint which[256];

// Whether a square comes before another.
bool before(float a, uint a_index, float b, uint b_index) { return a > b || (a == b && a_index < b_index); }

void main() {
    const uint mine = gl_LocalInvocationIndex;
    const uvec2 columns_rows = (push.size + kCoronaTile - 1u) / kCoronaTile;
    const uint count = columns_rows.x * columns_rows.y;

    // Each invocation knows the first of its own squares that comes after the last one taken.
    float own = 0.0, last = 3.4e38;
    uint own_index = kNone, last_index = 0u;
    bool look = true;
    float cut = 0.0;
    uint taken[kCoronaLamps];
    for (uint i = 0u; i <= kCoronaLamps; ++i) {
        if (look) {
            own = 0.0, own_index = kNone;
            for (uint t = mine; t < count; t += 256u) {
                const float value = tiles[t].luminance;
                if ((i == 0u || before(last, last_index, value, t)) && before(value, t, own, own_index)) own = value, own_index = t;
            }
        }
        barrier();
        brightest[mine] = own, which[mine] = own_index;
        for (uint half_ = 128u; half_ > 0u; half_ /= 2u) {
            barrier();
            if (mine < half_ && before(brightest[mine + half_], which[mine + half_], brightest[mine], which[mine]))
                brightest[mine] = brightest[mine + half_], which[mine] = which[mine + half_];
        }
        barrier();
        last = brightest[0], last_index = which[0];
        look = own_index == last_index;
        if (i < kCoronaLamps)
            taken[i] = last_index;
        else
            cut = last;
    }

    if (mine >= kCoronaLamps) return;
    CoronaLamp lamp = CoronaLamp(vec3(0.0, 0.0, -1.0), 0.0, vec3(0.0), 0.0);
    if (taken[mine] < count && tiles[taken[mine]].luminance > 0.0) {
        const CoronaTile tile = tiles[taken[mine]];
        const vec3 ray = vec3(push.ray_scale * tile.place + push.ray_offset, -1.0);
        const float cosine = inversesqrt(dot(ray, ray)), steradians = abs(push.ray_scale.x * push.ray_scale.y) * cosine * cosine * cosine;
        lamp = CoronaLamp(ray * cosine, steradians * (1.0 + 12.0 * tile.spread), tile.light * (steradians * (1.0 - cut / tile.luminance)), 0.0);
    }
    lamps[mine] = lamp;
}
