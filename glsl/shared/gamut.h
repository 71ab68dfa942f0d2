// What gives way where a display cannot show a colour as bright as an operator asks. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_GAMUT_H
#define VESPER_SHARED_GAMUT_H
#include "types.h"
SHARED_BEGIN

// Bits beside kTone*.
const uint kGamutMask = 0x1800u;
const uint kGamutLuminance = 0u;         // chromaticity, smoothly towards the display's white: brighter light is shown brighter
const uint kGamutChromaticity = 0x800u;  // luminance: all light of a colour beyond what the display has is shown alike
const uint kGamutClip = 0x1000u;         // either: each channel ends at the display's

// kGamutLuminance. Chromaticity begins to give way this part below the largest channel's end, and the channel reaches its end as
// much above it, so that no edge is seen.
const float kGamutKnee = 0.15f;
// What light as bright as the display's white loses of its chroma (over lightness), and how much more the brighter the display is in its
// colour: a lantern glows nearly white, and a tail lamp stays red.
const float kGamutLost = 0.2f, kGamutLostOfBright = 0.5f;
// Colours whose largest channel is less than this above their luminance have little way to go to white, and lose less on it.
const float kGamutWay = 0.3f;

// Oklab (Ottosson 2020, "A perceptual color space for image processing"; public domain): responses of long, middle and short cones
// to linear Rec. 709, 1 to white; lightness is the sum of their cube roots by kOklabLightness.
const vec3 kOklabLong = vec3(0.4122214708f, 0.5363325363f, 0.0514459929f);
const vec3 kOklabMiddle = vec3(0.2119034982f, 0.6806995451f, 0.1073969566f);
const vec3 kOklabShort = vec3(0.0883024619f, 0.2817188376f, 0.6299787005f);
const vec3 kOklabLightness = vec3(0.2104542553f, 0.7936177850f, -0.0040720468f);
// And linear Rec. 709 of those responses.
const vec3 kOklabRed = vec3(4.0767416621f, -3.3077115913f, 0.2309699292f);
const vec3 kOklabGreen = vec3(-1.2684380046f, 2.6097574011f, -0.3413193965f);
const vec3 kOklabBlue = vec3(-0.0041960863f, -0.7034186147f, 1.7076147010f);

SHARED_END
#endif
