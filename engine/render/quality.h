// Named sets of what frames may leave out. SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "render/renderer.h"

namespace vesper::render {

/// Standard: the defaults. Draft leaves out more, for speed; exact leaves out nothing that has a bound.
enum class Quality : uint8_t { Standard, Draft, Exact };

/// A set of bounds, each a field of RenderSettings.
struct QualityInfo {
    const char* name;
    Quality quality;
    float threshold;              ///< of its clusters, lx
    float merge_error;            ///< as there
    float shadow_error;           ///< as there
    double reflections_left_out;  ///< as there
};
/// All sets, by their values.
std::span<const QualityInfo> qualities();

/// Sets these bounds, lifts that of RenderSettings::shadow_budget, and changes nothing else.
void set_quality(RenderSettings& settings, Quality quality);

}  // namespace vesper::render
