// A wall before the eye that one lamp lights by a map of a few texels. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <glm/gtc/packing.hpp>
#include <glm/gtc/quaternion.hpp>

#include "passes/shadows/draw_shadow_maps_reference.h"
#include "render/shadows/shadow_maps.h"
#include "shared/gbuffer.h"
#include "support/lit.h"

namespace vesper::test {

/// A lamp before a wall, and its map.
struct WallLamp {
    double zoom = 0.8;
    bool flat = true;
    float fov = 0.4f;  ///< of the view, rad
    glm::dquat turn =
        glm::angleAxis(0.5, glm::normalize(glm::dvec3(0.1, 0.2, 1)));  ///< of the map, whose axis is -z without
    double away = 3;                                                   ///< from the wall, m
    uint32_t hemispheres = 1;
};

/// A wall across the view. The lamp sees it, but at texels (x, y) of its first hemisphere that `hides` says, where
/// something is before it after 0.9 of the way.
struct LitWall {
    static constexpr uint32_t kSide = 64;  ///< of the map, texels
    static constexpr double kAway = 8;     ///< of the wall from the eye, m

    WallLamp lamp;
    gpu_scene::View view;
    Surfaces s;
    gpu_scene::LampList list;
    render::MapFrame turned;
    reference::HemisphereMap map{kSide, {}};  ///< the first hemisphere
    std::vector<double> second;               ///< likewise, m

    template <class Hides>
    explicit LitWall(const Hides& hides, const WallLamp& of = {})
        : lamp(of),
          view(gpu_scene::View::symmetric({203, 121}, of.fov, glm::mat4(1))),
          s{view.extent, {}, {}, {}},
          turned(render::map_frame(glm::mat4_cast(glm::normalize(of.turn)))) {
        for (uint32_t i = 0; i < view.extent.width * view.extent.height; ++i) {
            s.reflectance.emplace_back(0.5f, 0.5f, 0.5f, 0.0f);
            s.surface.emplace_back(glm::vec2(reference::octahedral_encode({0, 0, 1})), float(kAway), 1.0f);
            s.emission.emplace_back(0);
        }
        shared::Lamp shining{};
        shining.position = {0.3f, 0.2f, float(lamp.away - kAway)}, shining.intensity = 1000, shining.axis = {0, 0, -1};
        shining.lobe_b = 1, shining.colour = glm::vec3(1);
        list.lamps = {shining}, list.indices = {0}, list.counts = {1, 0, 0, 0};
        for (uint32_t y = 0; y < kSide; ++y)
            for (uint32_t x = 0; x < kSide; ++x) {
                map.norms.push_back(hides(x, y) ? 0.9 * wall_at(x, y, 1) : wall_at(x, y, 1));
                second.push_back(wall_at(x, y, -1));
            }
    }
    /// The distance of the wall along the middle of a texel, in the norm of the map; 1e4 where it is not met.
    double wall_at(uint32_t x, uint32_t y, double hemisphere) const {
        const glm::dvec3 along = reference::map_direction(glm::dvec2(x, y) + 0.5, kSide, lamp.zoom, lamp.flat);
        const glm::dvec3 way = glm::transpose(turned.rotation) * (along * glm::dvec3(1, 1, hemisphere));
        return way.z < -1e-3 ? -lamp.away / way.z : 1e4;
    }
    bool sees(int x, int y) const {
        const int last = int(kSide) - 1, i = std::clamp(x, 0, last), j = std::clamp(y, 0, last);
        return map.at(i, j) > 0.95 * wall_at(uint32_t(i), uint32_t(j), 1);
    }
    double light(const std::vector<glm::vec4>& pixels, const std::vector<glm::vec4>& whole, size_t i) const {
        return double(pixels[i].x / whole[i].x);
    }
    std::vector<glm::vec4> render(PassRig& rig, bool shadows) const {
        std::vector<uint16_t> texels;
        for (const double norm : map.norms) texels.push_back(glm::packHalf1x16(float(norm)));
        for (const double norm : second) texels.push_back(glm::packHalf1x16(float(norm)));
        const std::vector maps{render::shadow_map({.side = kSide,
                                                   .hemispheres = lamp.hemispheres,
                                                   .zoom = float(lamp.zoom),
                                                   .flat = lamp.flat,
                                                   .range = 1,
                                                   .radius = 0,
                                                   .first = 0},
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
        return reference::map_texel(way, kSide, lamp.zoom, lamp.flat);
    }
};

}  // namespace vesper::test
