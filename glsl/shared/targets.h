// What is measured of targets in a picture. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_TARGETS_H
#define VESPER_SHARED_TARGETS_H
#include "types.h"
SHARED_BEGIN

const uint kMostTargets = 64u;
const uint kTargetGroup = 256u;         // invocations for each target
const uint kMostTargetSamples = 4096u;  // pixels that are read for each; of larger rectangles every stride-th of a row and row
// A glare source is brighter than both: kSourceContrast of vision/glare_report.h, over the log average; and cd/m^2. What
// headlamps light is no source, however dark the rest is: 100,000 cd give white clothes at 10 m some 250 cd/m^2, about
// as much as shop windows have. Lamps and signs have more.
const uint kGlareContrast = 100u, kLeastSourceLuminance = 300u;

// Pixels that are read for a target: itself and its surroundings; the end is beyond them.
struct TargetRect {
    uvec2 first, end;
    uint stride;  // px between those that are read, at least 1
};
SHARED_SIZE(TargetRect, 20)

// A pixel belongs to a target by the surface at its middle. Its luminance counts if the four pixels beside it belong to
// the same, so that none that an edge crosses does; surroundings are likewise apart from all targets. Glare sources do
// not count, nor the pixels beside them: lamps are drawn over the surfaces at their pixels and smooth at their edges.
struct TargetSums {
    uint pixels;         // of the target, of those that were read
    uint inner;          // of them, whose luminance counts
    uint around;         // pixels of its surroundings that count
    float solid_angle;   // sr over that of a pixel at the axis of the view: sum over `pixels` of (1 + tan^2)^(-3/2)
    float luminance;     // mean of `inner`, cd/m^2, of the scene
    float around_scene;  // mean of `around`, likewise
    float around_retina; // the same of the retina
    vec2 centre;         // mean place of `pixels`, px from the top left corner
};
SHARED_SIZE(TargetSums, 36)

struct TargetsPush {
    uvec2 size;     // px
    vec2 ray_scale; // as in ClusterGrid
    vec2 ray_offset;
};
SHARED_SIZE(TargetsPush, 24)

SHARED_END
#endif
