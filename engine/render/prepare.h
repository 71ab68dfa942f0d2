// The host's part of a frame: lists, what is out of date, how passes are set. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "render/passes/daylight.h"
#include "render/passes/shade.h"
#include "render/renderer.h"
#include "render/resident_scene.h"

namespace vesper::render {

/// A frame as the host has prepared it; declare() brings it into a graph. Refers to the poses of the frame.
struct Prepared {
    gpu_scene::LampList lamps;
    gpu_scene::LuminaireList luminaires;
    gpu_scene::SmallEmitterList small_emitters;
    ClusterSettings clusters;
    ShadeSettings shading;  ///< without its resources
    DaylightSettings daylight;
    float sky_lambert = 0;     ///< as SkyTexels::lambert
    uint32_t edge_points = 0;  ///< 0: pixels at edges show one surface
    bool shadows = false;
    bool outside = false;  ///< light that comes from no lamp: sky and retroreflection
    /// Where the light between surfaces comes from.
    enum class Indirect { None, Cells, Pixels } indirect = Indirect::None;
    transport::RadiosityLight radiosity;       ///< of Indirect::Cells
    std::vector<transport::LitPatch> patches;  ///< likewise, of lamps that move
    ShadowReport maps;                         ///< with shadows
    uint32_t directional_levels = 0;           ///< of maps, to be drawn
};

/// Prepares a frame of `scene` as `view` sees it, with everything at its pose of `poses`: finds which maps and which
/// light are out of date. Makes no call of the device, but for what the first frame with shadows needs for all others.
/// Throws Error.
Prepared prepare(ResidentScene& scene, const gpu::Device& device, Cache* map_cache, const RenderSettings& settings,
                 const gpu_scene::View& view, const gpu_scene::SceneFrame& poses);

}  // namespace vesper::render
