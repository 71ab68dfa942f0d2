// What a report warns of. SPDX-License-Identifier: MIT
#pragma once

#include "scene/scene_report.h"

namespace vesper::scene {

/// cd: a glow-worm, and an aircraft's landing light. Lamps beyond are warned of.
inline constexpr double kFaintestLamp = 0.1, kBrightestLamp = 1e6;

/// Appends to the warnings of a report that is complete otherwise.
void warn_of(const Scene& scene, SceneReport& report);

}  // namespace vesper::scene
