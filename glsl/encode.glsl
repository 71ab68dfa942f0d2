// Displayed light to codes by a table of cells: exact for every display, and the same on every device.

#include "shared/encode.h"

uint code_of(samplerBuffer cells, EncodePush push, float light) {
    const uint bits = floatBitsToUint(light) & 0x7fffffffu;  // minus zero is zero
    const vec3 cell = texelFetch(cells, int(clamp(bits >> push.shift, push.first, push.last) - push.first)).rgb;
    return uint(light >= cell.r ? cell.b : cell.g);
}

// A pixel: red in the lowest bits, alpha full.
uint codes_of(samplerBuffer cells, EncodePush push, vec3 light) {
    const uint alpha = 0xffffffffu << (3u * push.bits);
    return code_of(cells, push, light.r) | code_of(cells, push, light.g) << push.bits |
           code_of(cells, push, light.b) << (2u * push.bits) | alpha;
}
