// Adaptation and tone curve: what maps scene luminance to display luminance. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_TONE_H
#define VESPER_SHARED_TONE_H
#include "luminance.h"
SHARED_BEGIN

// How the composite maps luminance, the number of the first operator that does so (vesper/operators.h).
const uint kToneCurve = 0u;     // the table below
const uint kToneReinhard = 2u;  // Reinhard et al. 2002, global
const uint kToneLinear = 3u;    // linear between two luminances
const uint kToneLdr = 4u;       // none: values in [0, 1] are shown as they are
const uint kToneColour = 5u;    // the table, with exponents of colour: Pattanaik et al. 2000
const uint kToneRods = 6u;      // linear, after grey for what rods see has been added: Ferwerda et al. 1996
// and, as bits beside that, how dim light is perceived before it is mapped, between 0.00562 and 5.62 cd/m^2 (Ward et al. 1997):
const uint kToneForm = 0xffu;
const uint kToneColourLoss = 0x100u;  // colour fades to grey
const uint kTonePurkinje = 0x200u;    // luminance becomes scotopic
const uint kTonePhotopicRods = 0x400u;  // and without: rods take luminance for scotopic luminance, whatever the colour

// Histogram adjustment: the threshold T that bounds the slope, d Ld / d L <= T_display(Ld) / T_scene(L). T_display is that of
// cones of the display's viewer; of Ward et al. 1997, that of cones (with kCeilingHuman: cones and rods) adapted to Ld.
const uint kCeilingEye = 0u;     // scene: the eye in its present state
const uint kCeilingHuman = 1u;   // adapted cones and rods merged (Ward et al. 1997)
const uint kCeilingCones = 2u;   // adapted cones
const uint kCeilingLinear = 3u;  // none beyond the contrast of the scene: d ln Ld / d ln L <= 1

// What a viewer of the display is adapted to, over its white: the mean of common pictures (their log average is some 0.18).
const float kViewerOfWhite = 0.3f;

// What the eye adapts to.
const uint kAdaptGaze = 0u;      // log average of 3 x 3 texels of the foveal level about the gaze, linear in its position
const uint kAdaptGazeMean = 1u;  // their mean: a headlamp there sets what everything else is seen with
const uint kAdaptTexel = 2u;     // mean of the texel of the foveal level at the gaze
const uint kAdaptAverage = 3u;   // the log average of the frame

// Cones or rods, see vision/eye.h. Luminances cd/m^2, times s.
struct ReceptorParameters {
    float response_step;    // Delta R, times the factor of the observer
    float dark_sigma;
    float factor;           // of all thresholds
    float fast_seconds;
    float slow_seconds;
    float fast_share;
    float bleach_seconds;
    float bleach_trolands;
};
SHARED_SIZE(ReceptorParameters, 32)

const uint kOperatorSettings = 2u;

struct ToneParameters {
    uint bins;                 // of the histogram
    uint steps_per_bin;        // of the curve; bins * steps_per_bin is at most kMaxBins
    float window;              // bins between the knots of the cubic B-spline that the curve sees votes through; 0: none, a bin is a step
    float ln_low;              // as in HistogramPush
    float bins_per_ln;
    float display_low;         // darkest and brightest luminance the display shows, ambient included, cd/m^2
    float display_high;
    float seconds;             // since the last frame
    float smoothing_seconds;   // time constant of the curve, against flicker; 0: none
    uint adapt_to;
    vec2 gaze;                 // texels of the foveal level from its top left, (0.5, 0.5) is the middle of the first
    uvec2 foveal_size;         // texels
    uint ceiling;
    uint use_rods;             // 1: the eye sees with the better of cones and rods
    float cone_break;          // log10 L from which Weber's law holds
    float rod_break;
    float scotopic;            // scotopic luminance over luminance of what the eye adapts to
    uvec2 colour_tiles;        // of the colours that the eye adapts to; 0: it does not
    float viewer_sigma;        // half saturation of an eye adapted to kViewerOfWhite, cd/m^2
    float viewer_step;         // just noticeable difference of its response
    ReceptorParameters cones;
    ReceptorParameters rods;
    vec4 settings[kOperatorSettings];  // of the operator, as its shader reads them
};
SHARED_SIZE(ToneParameters, 188)

const uint kMaxNodes = 1024u;
const float kResponsePower = 0.73f;  // Pattanaik et al. 2000, after Hunt

const uint kOperatorTexels = 5u;

// What an operator makes of a frame. Also read as a texel buffer of rgba32f.
struct ToneCurve {
    float ln_low;          // texel 0; ln L of node 0
    float bins_per_ln;     // nodes per unit of ln L
    float bins;            // steps of the curve, which has one node more
    float under_full;      // 1 if the display range is not filled: slopes are as steep as they may be, or linear; else 0
    float adaptation;      // texel 1; luminance the eye looks at, cd/m^2
    float log_average;     // exp(mean ln L), cd/m^2
    float maximum;         // largest luminance, cd/m^2
    float slack;           // part of ln(display_high / display_low) that is left over
    float cone_sigma;      // texel 2; half saturation of the eye, cd/m^2
    float rod_sigma;       // scotopic cd/m^2
    vec2 unused;
    vec4 block[kOperatorTexels];  // texels 3 to 7: numbers of the operator, for its pixels (glsl/operators/)
    // r: ln of display luminance, cd/m^2; for kToneColour r: response of cones to that luminance, g: exponent of colour,
    // b: response of rods to white of that luminance
    vec4 node[kMaxNodes + 1u];
};
SHARED_SIZE(ToneCurve, 16528)

const uint kToneBlock = 3u;  // texel of block[0]
const uint kToneNode0 = 8u;  // texel of node[0]

struct ReceptorMemory {
    float pigment;  // unbleached part
    float fast;     // log10 of what fast neural adaptation multiplies sigma with
    float slow;
};
SHARED_SIZE(ReceptorMemory, 12)

// For Pattanaik et al. 2000.
struct PattanaikState {
    float cones;         // adaptation luminance, cd/m^2; 0 before the first frame
    float rods;
    float cone_pigment;  // unbleached part
    float rod_pigment;
};
SHARED_SIZE(PattanaikState, 16)

// The first frame finds the pupil of a driver at night (of 1 cd/m^2, Moon and Spencer 1944), mm, which then follows with this time constant, s.
const float kFirstPupil = 4.9f;
const float kPupilSeconds = 0.5;
const float kLongestLife = 1e12f;  // of an eye, s: it grows no older

// What the eye, and what smooths the picture, remember from frame to frame.
struct EyeState {
    float adaptation;     // cd/m^2; 0 before the first frame
    float seconds;        // time since the first frame,
    float seconds_lost;   // and what rounding has left out of it
    float pupil;          // diameter on its way to that of the adaptation, its unrest aside, mm; 0 before the first frame
    ReceptorMemory cones;
    ReceptorMemory rods;
    float steps;          // of the curve below; 0: there is none
    float ln_low;
    float steps_per_ln;
    PattanaikState pattanaik;
    vec3 chroma;          // slow part of chromatic adaptation: ln of response over that to white of the same luminance, of each cone
    float node[kMaxBins + 1u];  // of the smoothed curve, ln of display luminance
};
SHARED_SIZE(EyeState, 1108)

SHARED_END
#endif
