// A wall before the eye that one lamp lights by a map of a few texels. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <glm/gtc/packing.hpp>

#include "passes/shadows/draw_shadow_maps_reference.h"
#include "render/shadows/shadow_maps.h"
#include "support/lit.h"

namespace vesper::test {

/// A wall across the view. The lamp before it sees it, but at texels (x, y) of its map that `hides` says.
struct LitWall {
    static constexpr uint32_t kSide = 64;              ///< of the map, texels
    static constexpr double kAway = 8, kLampAway = 3;  ///< of the wall from the eye, and of the lamp from the wall, m

    gpu_scene::View view;
    Surfaces s;
    gpu_scene::LampList list;
    render::MapFrame turned =
        render::map_frame(glm::mat4_cast(glm::angleAxis(0.5, glm::normalize(glm::dvec3(0.1, 0.2, 1)))));
    reference::HemisphereMap map{kSide, {}};
    double zoom;
    bool flat;

    template <class Hides>
    LitWall(const Hides& hides, double map_zoom, bool map_flat, float fov = 0.4f)
        : view(gpu_scene::View::symmetric({203, 121}, fov, glm::mat4(1))),
          s{view.extent, {}, {}, {}},
          zoom(map_zoom),
          flat(map_flat) {
        for (uint32_t i = 0; i < view.extent.width * view.extent.height; ++i) {
            s.reflectance.emplace_back(0.5f, 0.5f, 0.5f, 0.0f);
            s.surface.emplace_back(glm::vec2(reference::octahedral_encode({0, 0, 1})), float(kAway), 1.0f);
            s.emission.emplace_back(0);
        }
        shared::Lamp lamp{};
        lamp.position = {0.3f, 0.2f, float(kLampAway - kAway)}, lamp.intensity = 1000, lamp.axis = {0, 0, -1};
        lamp.lobe_b = 1, lamp.colour = glm::vec3(1);
        list.lamps = {lamp}, list.indices = {0}, list.counts = {1, 0, 0, 0};
        for (uint32_t y = 0; y < kSide; ++y)
            for (uint32_t x = 0; x < kSide; ++x) map.norms.push_back(hides(x, y) ? 1.0 : wall_at(x, y));
    }
    /// The distance of the wall along the middle of a texel, in the norm of the map; 1e4 where it is not met.
    double wall_at(uint32_t x, uint32_t y) const {
        const glm::dvec3 way =
            glm::transpose(turned.rotation) * reference::map_direction(glm::dvec2(x, y) + 0.5, kSide, zoom, flat);
        return way.z < -1e-3 ? -kLampAway / way.z : 1e4;
    }
    double light(const std::vector<glm::vec4>& pixels, const std::vector<glm::vec4>& whole, size_t i) const {
        return double(pixels[i].x / whole[i].x);
    }
    std::vector<glm::vec4> render(PassRig& rig, bool shadows) const {
        std::vector<uint16_t> texels;
        for (const double norm : map.norms) texels.push_back(glm::packHalf1x16(float(norm)));
        const std::vector maps{render::shadow_map(
            {.side = kSide, .hemispheres = 1, .zoom = float(zoom), .flat = flat, .range = 1, .radius = 0, .first = 0},
            turned, view)};
        graph::FrameGraph graph;
        render::FrameShadowMaps seen;
        if (shadows)
            seen = {graph.upload("maps", maps, VK_FORMAT_R32G32B32A32_SFLOAT),
                    graph.upload("distances", texels, VK_FORMAT_R16_SFLOAT)};
        const LitBlocks lit = test::light(rig.frame(graph, view), upload(graph, s), list, no_tables(graph), {},
                                          {.merge_error = 0, .maps = seen, .shadow_error = 0, .probe_error = 0});
        const graph::Resource picture = keep<glm::vec4>(graph, lit.scene);
        rig.run(graph);
        return rig.got<glm::vec4>(picture);
    }
    glm::dvec3 point(glm::dvec2 pixel) const {
        const glm::dvec2 ray = glm::dvec2(view.ray_scale()) * (pixel + 0.5) + glm::dvec2(view.ray_offset());
        return kAway * glm::dvec3(ray, -1);
    }
    /// Whether the map reaches it; beyond, all is lit.
    bool reached(glm::dvec2 pixel) const {
        const glm::dvec2 at = texel(pixel);
        return std::min(at.x, at.y) > 0.01 && std::max(at.x, at.y) < kSide - 0.01;
    }
    /// Its place in the map, texels.
    glm::dvec2 texel(glm::dvec2 pixel) const {
        const glm::dvec3 way = turned.rotation * (point(pixel) - glm::dvec3(list.lamps[0].position));
        return reference::map_texel(way, kSide, zoom, flat);
    }
};

}  // namespace vesper::test
