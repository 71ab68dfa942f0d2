#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

// Oriented contrast: energy of luminance in Gabor filters, even and odd, whose stripes change along 0, 45, 90 and 135 degrees, over
// the mean luminance under their Gaussian (Peli 1990: contrast of a band), at most of the order of 1 however bright a lamp is. A filter of
// a slanted direction is a product along x and y, too, of complex waves. The even ones are freed of their mean by the Gaussian.
// Differences to the texel itself make an even field exactly 0. Texels without finite pixels are as bright as it, and the picture goes on
// beyond its edge as in a mirror, where repeated pixels would make an edge of any texture.

#include "shared/photometry.h"
#include "shared/saliency.h"

layout(local_size_x = 64) in;

layout(binding = 0, rgba32f) readonly uniform image2D level;
layout(binding = 1, rgba32f) writeonly uniform image2D oriented;
layout(push_constant, scalar) uniform Push { OrientedPush push; };

// Of distances 0 to 4: the Gaussian, and waves of the period and of that which a slanted one has along an axis.
const float kFall = -0.5 / (kGaborDeviation * kGaborDeviation), kTurn = 2.0 * kPi / kGaborPeriod, kSlant = kTurn * 0.70710678;
const float kGauss[5] = float[5](1.0, exp(kFall), exp(4.0 * kFall), exp(9.0 * kFall), exp(16.0 * kFall));
const float kCos[5] = float[5](1.0, cos(kTurn), cos(2.0 * kTurn), cos(3.0 * kTurn), cos(4.0 * kTurn));
const float kSin[5] = float[5](0.0, sin(kTurn), sin(2.0 * kTurn), sin(3.0 * kTurn), sin(4.0 * kTurn));
const float kSlantCos[5] = float[5](1.0, cos(kSlant), cos(2.0 * kSlant), cos(3.0 * kSlant), cos(4.0 * kSlant));
const float kSlantSin[5] = float[5](0.0, sin(kSlant), sin(2.0 * kSlant), sin(3.0 * kSlant), sin(4.0 * kSlant));

const float kSum = kGauss[0] + 2.0 * (kGauss[1] + kGauss[2] + kGauss[3] + kGauss[4]);
const float kMeanAlong = (1.0 + 2.0 * (kGauss[1] * kCos[1] + kGauss[2] * kCos[2] + kGauss[3] * kCos[3] + kGauss[4] * kCos[4])) / kSum;
const float kSlantMean = (1.0 + 2.0 * (kGauss[1] * kSlantCos[1] + kGauss[2] * kSlantCos[2] + kGauss[3] * kSlantCos[3] + kGauss[4] * kSlantCos[4])) / kSum;
const vec4 kMean = vec4(kMeanAlong, kSlantMean * kSlantMean, kMeanAlong, kSlantMean * kSlantMean);

// Of one axis with `size` texels.
int mirrored(int at, uint size) { return clamp(at < 0 ? -1 - at : min(at, 2 * int(size) - 1 - at), 0, int(size) - 1); }

void main() {
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, ivec2(push.size)))) return;
    const vec4 own = imageLoad(level, at);
    vec4 even = vec4(0.0), odd = vec4(0.0);
    float gauss = 0.0;
    [[unroll]] for (int dy = -kGaborReach; dy <= kGaborReach; ++dy) {
        const int y = mirrored(at.y + dy, push.size.y), j = abs(dy);
        float mean = 0.0;  // of the row, by the Gaussian
        vec2 wave = vec2(0.0), slant = vec2(0.0);  // by cosines and sines
        [[unroll]] for (int dx = -kGaborReach; dx <= kGaborReach; ++dx) {
            const vec4 texel = imageLoad(level, ivec2(mirrored(at.x + dx, push.size.x), y));
            const int i = abs(dx);
            const float light = texel.a > 0.0 ? kGauss[i] * (texel.r - own.r) : 0.0, side = dx < 0 ? -1.0 : 1.0;
            mean += light;
            wave += light * vec2(kCos[i], side * kSin[i]);
            slant += light * vec2(kSlantCos[i], side * kSlantSin[i]);
        }
        const float down = dy < 0 ? -1.0 : 1.0;
        const vec2 here = vec2(kCos[j], down * kSin[j]), slanted = vec2(kSlantCos[j], down * kSlantSin[j]);
        gauss += kGauss[j] * mean;
        even += kGauss[j] * vec4(wave.x, slant.x * slanted.x - slant.y * slanted.y, here.x * mean, slant.x * slanted.x + slant.y * slanted.y);
        odd += kGauss[j] * vec4(wave.y, slant.y * slanted.x + slant.x * slanted.y, here.y * mean, slant.y * slanted.x - slant.x * slanted.y);
    }
    even -= kMean * gauss;
    const float over = 1.0 / (max(kSum * kSum * own.r + gauss, 0.0) + kSum * kSum * kDarkLight);
    even *= over, odd *= over;
    imageStore(oriented, at, own.a > 0.0 ? sqrt(even * even + odd * odd) : vec4(0.0));
}
