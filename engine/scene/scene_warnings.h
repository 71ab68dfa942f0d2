// What a report warns of. SPDX-License-Identifier: MIT
#pragma once

#include "scene/scene_report.h"

namespace vesper {

/// Appends to the warnings of a report that is complete otherwise.
void warn_of(const Scene& scene, SceneReport& report);

}  // namespace vesper
