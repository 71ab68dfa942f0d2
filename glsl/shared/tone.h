// Adaptation and tone curve: what maps scene luminance to display luminance. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_TONE_H
#define VESPER_SHARED_TONE_H
#include "luminance.h"
SHARED_BEGIN

// How the composite maps luminance.
const uint kToneCurve = 0u;     // the table below: histogram adjustment
const uint kToneReinhard = 1u;  // Reinhard et al. 2002, global
const uint kToneLinear = 2u;    // linear between two luminances
const uint kToneLdr = 3u;       // none: values in [0, 1] are shown as they are

struct AdaptPush {
    uint bins;            // of the histogram
    float ln_low;         // as in HistogramPush
    float bins_per_ln;
    float display_low;    // darkest and brightest luminance the display shows, ambient included, cd/m^2
    float display_high;
    float key;            // Reinhard: luminance the log average is mapped to, relative to white
    float white;          // Reinhard: scene luminance shown as white, cd/m^2; 0: the largest of the frame
    float linear_low;     // linear: scene luminance shown as black, cd/m^2
    float linear_high;    // linear: scene luminance shown as white, cd/m^2; 0: the largest of the frame
    float seconds;        // since the last frame
};
SHARED_SIZE(AdaptPush, 40)

// What a frame's statistics make of the operator. Also read as a texel buffer of r32f, hence no other types.
struct ToneCurve {
    float adaptation;      // luminance the eye is adapted to, cd/m^2
    float log_average;     // exp(mean ln L), cd/m^2
    float maximum;         // largest luminance, cd/m^2
    float reinhard_scale;  // X = reinhard_scale * L
    float reinhard_white;  // 1 / Xwhite^2
    float linear_low;      // cd/m^2
    float linear_gain;     // 1 / (high - low), m^2/cd
    float ln_low;          // ln L of node 0
    float bins_per_ln;     // nodes per unit of ln L
    float bins;            // the curve has bins + 1 nodes, at the edges of the bins
    float ceiling;         // 1 if the display range is not filled: every slope is at its ceiling; else 0
    float slack;           // and the part of ln(display_high / display_low) that is left over
    float node[kMaxBins + 1u];  // ln of display luminance, cd/m^2
};
SHARED_SIZE(ToneCurve, 1076)

const uint kToneNode0 = 12u;  // texel of node[0]

// What the eye remembers from frame to frame.
struct EyeState {
    float adaptation;  // cd/m^2; 0 before the first frame
    float seconds;     // time since the first frame
};
SHARED_SIZE(EyeState, 8)

SHARED_END
#endif
