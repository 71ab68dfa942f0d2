// A scene on the device, with what is kept of its light from frame to frame. SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "gpu_scene/cameras.h"
#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/intensity_tables.h"
#include "gpu_scene/lamps.h"
#include "gpu_scene/luminaires.h"
#include "gpu_scene/small_emitters.h"
#include "render/indirect_light.h"
#include "render/shadows/clipmap_layout.h"
#include "render/shadows/clipmaps.h"
#include "render/shadows/shadow_map_layout.h"
#include "render/shadows/shadow_maps.h"
#include "transport/lamp_reflections.h"

namespace vesper::render {

/// A texel buffer of the scene, rgba32f.
struct SceneTexels {
    gpu::OwnedBuffer buffer;
    uint64_t bytes = 0;  ///< 0: there is none

    graph::Resource declare(graph::FrameGraph& graph, const char* name) const;
};

/// The parts of a scene that do not change: on the device, and of those that the host needs.
struct SceneData {
    /// `cache`: see GpuScene.
    SceneData(const gpu::Device& device, const scene::Scene& scene, Cache* cache);

    gpu_scene::GpuScene resident;
    std::vector<gpu_scene::PlacedLamp> lamps;
    ShadowMapPlan maps;
    ClipmapPlan directional;
    gpu_scene::LuminaireSet luminaires;
    std::vector<gpu_scene::EmittingPart> emitting;  ///< by part
    gpu_scene::IntensityTables tables;              ///< without its texels, which are uploaded
    gpu::Arena texel_arena;
    SceneTexels table_texels, sky, retro;
    uint32_t sky_sharp_side = 0;
    gpu_scene::AmbientLight ambient;
    std::optional<photometry::Irradiance9> sky_on;  ///< surfaces, of a sky that is a picture

private:
    SceneTexels upload(const gpu::Device& device, const std::vector<glm::vec4>& texels);
};

/// A scene and its light. What is null is not known, or not yet needed by a frame.
struct ResidentScene {
    ResidentScene(const gpu::Device& device, const scene::Scene& scene, Cache* cache) : data(device, scene, cache) {}

    const SceneData data;
    std::unique_ptr<ShadowMaps> maps;
    std::unique_ptr<Clipmaps> directional;
    std::unique_ptr<IndirectLight> indirect;
    std::shared_ptr<const transport::LampReflections> lamp_reflections;
    std::vector<glm::vec4> illuminance;  ///< of pixels, RGB lx; empty: not known

    /// A frame that was declared has failed: the next one brings the device up to date.
    void forget();
    uint64_t device_bytes() const;
};

}  // namespace vesper::render
