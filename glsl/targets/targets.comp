#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

// Luminances of targets and of what surrounds them: a workgroup for each target, which sums in a fixed order.

#include "texels.glsl"
#include "shared/photometry.h"
#include "shared/targets.h"

layout(local_size_x = kTargetGroup) in;

layout(binding = 0, rg32ui) readonly uniform uimage2D triangles;
layout(binding = 1, rgba32f) readonly uniform image2D scene_image;
layout(binding = 2, rgba32f) readonly uniform image2D retina_image;
layout(binding = 3, rgba32f) readonly uniform image2D whole_image;  // the last level of the pyramid
TEXELS(4, uint, targets_of_instances);                              // 1 + number of the target, 0: none
layout(binding = 5, scalar) readonly buffer Rects { TargetRect rects[]; };
layout(binding = 6, scalar) writeonly buffer Sums { TargetSums sums[]; };
layout(push_constant, scalar) uniform Push { TargetsPush push; };

shared vec4 counts[kTargetGroup];  // of the target: pixels, inner ones, solid angle; around: pixels
shared vec4 light[kTargetGroup];   // luminance of the target; around: scene, retina
shared vec2 places[kTargetGroup];

const ivec2 kBeside[4] = ivec2[](ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1));

uint target_at(ivec2 pixel) {
    const uint instance = imageLoad(triangles, pixel).r;
    const uint target = texel_at(targets_of_instances, int(max(instance, 1u) - 1u)).x;
    return instance == 0u ? 0u : target;
}

#define luminance_at(image, pixel) dot(imageLoad(image, pixel).rgb, vec3(kRed, kGreen, kBlue))

void main() {
    const uint target = gl_WorkGroupID.x, mine = gl_LocalInvocationIndex;
    const TargetRect rect = rects[target];
    const uvec2 read = (rect.end - rect.first + rect.stride - 1u) / rect.stride;
    const vec4 whole = imageLoad(whole_image, ivec2(0));
    const float brightest = max(float(kLeastSourceLuminance), float(kGlareContrast) * min(exp(whole.b), whole.r));
    vec4 count = vec4(0.0), sum = vec4(0.0);
    vec2 place = vec2(0.0);
    for (uint k = mine; k < read.x * read.y; k += kTargetGroup) {
        const uvec2 from_first = rect.stride * uvec2(k % read.x, k / read.x);
        const ivec2 pixel = ivec2(rect.first + from_first);
        const uint here = target_at(pixel);
        const float scene = luminance_at(scene_image, pixel), retina = luminance_at(retina_image, pixel);
        bool counts_ = scene <= brightest && abs(scene) <= 3.4e38 && abs(retina) <= 3.4e38;
        [[unroll]] for (int n = 0; n < 4; ++n) {
            const ivec2 beside = clamp(pixel + kBeside[n], ivec2(0), ivec2(push.size) - 1);
            counts_ = counts_ && target_at(beside) == here && !(luminance_at(scene_image, beside) > brightest);
        }
        const bool own = here == target + 1u, inner = own && counts_, around = here == 0u && counts_;
        const vec2 ray = push.ray_scale * (vec2(pixel) + 0.5) + push.ray_offset;
        const float cosine = inversesqrt(1.0 + dot(ray, ray));
        count += vec4(own ? 1.0 : 0.0, inner ? 1.0 : 0.0, own ? cosine * cosine * cosine : 0.0, around ? 1.0 : 0.0);
        sum += vec4(inner ? scene : 0.0, around ? scene : 0.0, around ? retina : 0.0, 0.0);
        place += own ? vec2(from_first) : vec2(0.0);
    }
    counts[mine] = count, light[mine] = sum, places[mine] = place;
    for (uint half_ = kTargetGroup / 2u; half_ > 0u; half_ /= 2u) {
        barrier();
        if (mine < half_) counts[mine] += counts[mine + half_], light[mine] += light[mine + half_], places[mine] += places[mine + half_];
    }
    if (mine != 0u) return;
    const vec4 all = counts[0], shares = 1.0 / max(all, vec4(1.0));
    const float area = float(rect.stride * rect.stride);
    sums[target] = TargetSums(uint(all.x), uint(all.y), uint(all.w), area * all.z, shares.y * light[0].x, shares.w * light[0].y,
                              shares.w * light[0].z, vec2(rect.first) + 0.5 + shares.x * places[0]);
}
