// Light of the lamps of a scene with shadows, on the device. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "base/angle.h"
#include "render/passes/gbuffer.h"
#include "render/passes/shade.h"
#include "render/shadows/clipmaps.h"
#include "render/shadows/shadow_maps.h"
#include "scene/scene.h"
#include "support/lamps.h"
#include "support/shading.h"

namespace vesper::test {

/// A scene with its maps on the device.
struct Lit {
    PassRig& rig;
    const scene::Scene& scene;
    gpu_scene::SceneFrame poses;
    gpu_scene::GpuScene resident;
    std::vector<gpu_scene::PlacedLamp> lamps;
    render::ShadowMapPlan plan;
    gpu_scene::IntensityTables tables;
    render::ShadowMaps maps;
    render::Clipmaps directional;

    Lit(PassRig& r, const scene::Scene& s)
        : rig(r),
          scene(s),
          poses{scene::world_transforms(s, 0), {}, {}, {}, {}},
          resident(r.device(), s),
          lamps(gpu_scene::placed_lamps(s)),
          plan(render::shadow_map_plan(s, resident, lamps)),
          tables(gpu_scene::intensity_tables(s)),
          maps(r.device(), resident, lamps, plan),
          directional(r.device(), resident, lamps, render::clipmap_plan(lamps)) {}

    struct Picture {
        gpu_scene::LampList list;
        shared::ClusterGrid grid;
        std::vector<glm::vec4> colours, surfaces, pixels;
        shared::VisibilityReport pairs{};
        uint32_t levels = 0;  // drawn for it
        std::string note;     // of the cache of maps

        /// What pixel `i` of a picture of this width sees, view frame, m.
        glm::dvec3 place(size_t i, uint32_t width) const {
            return reference::view_position(grid, glm::dvec2(i % width, i / width) + 0.5, double(surfaces[i].z));
        }
    };
    /// The light of lamps alone.
    Picture render(const gpu_scene::View& view, bool all_lamps = false) {
        Picture p{.list = gpu_scene::lamp_list(lamps, tables, poses, view)};
        maps.plan(p.list, poses, view, 0);
        p.levels = directional.plan(p.list, poses, view);
        graph::FrameGraph graph;
        const render::FrameContext frame = rig.frame(graph, view);
        const render::FrameShadowMaps distances = maps.declare(frame, p.list, poses);
        const render::FrameClipmaps levels = directional.declare(frame, p.list, poses, view);
        const render::GBuffer g = render::add_gbuffer(frame, resident, poses);
        const graph::Resource reflectance = keep<uint64_t>(graph, g.reflectance),
                              surface = keep<glm::vec4>(graph, g.surface);
        const LitBlocks lit = light(frame, g, p.list, upload(graph, tables), {},
                                    {.emission_limit = 0, .all_lamps = all_lamps, .maps = distances}, levels);
        const graph::Resource picture = keep<glm::vec4>(graph, lit.scene),
                              report = keep<shared::VisibilityReport>(graph, lit.blocks.visibility);
        const render::ShadowCache kept = maps.take_cached();
        rig.run(graph);
        p.note = maps.keep(kept, rig.executor());
        p.grid = lit.clusters.push.grid;
        p.colours = from_halves(rig.got<uint64_t>(reflectance));
        p.surfaces = rig.got<glm::vec4>(surface), p.pixels = rig.got<glm::vec4>(picture);
        p.pairs = rig.got<shared::VisibilityReport>(report).at(0);
        return p;
    }
};

/// From 20 m above, straight down at a square of the ground of `width` metres; right is +x, down is +z.
inline gpu_scene::View view_of_the_ground(uint32_t pixels, double width) {
    return gpu_scene::View::symmetric({pixels, pixels}, float(2 * std::atan(width / 40)),
                                      glm::mat4_cast(glm::angleAxis(kPi / 2, glm::dvec3(1, 0, 0))) *
                                          glm::translate(glm::dmat4(1), glm::dvec3(0, -20, 0)));
}

}  // namespace vesper::test
