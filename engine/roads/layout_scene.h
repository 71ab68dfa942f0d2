// A road layout as a scene to render. SPDX-License-Identifier: MIT
#pragma once

#include "roads/road_layout.h"
#include "scene/scene.h"

namespace vesper::roads {

/// The frame of a layout (x ahead, y left, z up) in the world (y up): ahead is -Z, left is -X. A camera that is not
/// turned looks along the road.
glm::dvec3 layout_to_world(glm::dvec3 point);

/// The carriageway as a flat surface at Y = 0, from 80 m before the observers to 12H beyond the field, of one material
/// with the reflection table (for renderers without tables a matt surface of reflectance pi Qd); every luminaire that
/// counts for a point of the field, and those above the road from the observers on, as measured lamps of maintained
/// intensity, one node each; a camera "observer lane N" for each observer, 1.5 m up, 60 m before the field, looking
/// along the road and 1 degree down. Black sky, no ambient light.
scene::Scene layout_scene(const LoadedLayout& layout);

/// What dazzles, for TI: luminaires of initial intensity from x = `from`, where the eye is, to kGlareRange beyond, m,
/// each with an opening of 2 cm x 2 cm to be seen by, over a black road. What dazzles is I / d^2, whatever the opening;
/// a small one is on one side of the car's roof.
scene::Scene layout_glare_scene(const LoadedLayout& layout, double from);

/// The luminaires that layout_scene holds.
std::vector<PlacedLuminaire> layout_scene_luminaires(const LoadedLayout& layout);

}  // namespace vesper::roads
