#include "gpu_scene/retro.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/angle.h"

#include "shared/retro.h"

namespace vesper::gpu_scene {
namespace {

static_assert(shared::kRetroRamps == photometry::kMaxRetroNodes);

void append(std::vector<glm::vec4>& texels, const photometry::Retroreflector& r) {
    // A ramp that is not needed starts beyond every angle.
    std::vector<shared::RetroRamp> ramps(shared::kRetroRamps, {4, 0, 0, 0});
    for (size_t i = 0; i < r.observation.size(); ++i) {
        const size_t k = std::min(i, r.observation.size() - 2);  // the last one goes on like the one before
        ramps[i].observation = float(r.observation[i] * kRadiansPerDegree);
        ramps[i].observation_slope = float(std::log2(r.coefficient[k + 1] / r.coefficient[k]) /
                                           ((r.observation[k + 1] - r.observation[k]) * kRadiansPerDegree));
    }
    for (size_t i = 0; i < r.entrance.size(); ++i) {
        const double cosine = std::cos(r.entrance[i] * kRadiansPerDegree);
        ramps[i].entrance = float(cosine);
        if (i + 1 == r.entrance.size())
            ramps[i].entrance_slope = float(r.entrance[i] < 90 ? -r.entrance_factor[i] / cosine : 0.0);
        else
            ramps[i].entrance_slope = float((r.entrance_factor[i + 1] - r.entrance_factor[i]) /
                                            (cosine - std::cos(r.entrance[i + 1] * kRadiansPerDegree)));
    }
    for (const shared::RetroRamp& ramp : ramps)
        texels.emplace_back(ramp.observation, ramp.observation_slope, ramp.entrance, ramp.entrance_slope);
    const double left = std::log2(double(shared::kRetroLeast) / r.coefficient.back()) /
                        ramps[r.observation.size() - 1].observation_slope;
    const double reach = std::min(r.observation.back() * kRadiansPerDegree + std::max(left, 0.0), std::numbers::pi);
    texels.emplace_back(float(std::log2(r.coefficient.front())), float(r.entrance_factor.front()),
                        r.marking ? 0.0f : 1.0f, float(4 * std::pow(std::sin(reach / 2), 2)));
}

}  // namespace

std::vector<glm::vec4> retro_texels(std::span<const photometry::Retroreflector> classes) {
    std::vector<glm::vec4> texels;
    for (const photometry::Retroreflector& r : classes) append(texels, r);
    while (texels.size() < shared::kRetroClasses * shared::kRetroTexels)
        append(texels, photometry::Retroreflector{"none", {0, 1}, {1e-6, 1e-7}, {0}, {0}, false});
    return texels;
}

}  // namespace vesper::gpu_scene
