// Shading of made-up surfaces on the device, and what the reference says of them. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "gpu_scene/intensity_tables.h"
#include "gpu_scene/retro.h"
#include "passes/shade_reference.h"
#include "render/passes/shade.h"
#include "render/shadows/directional_visibility.h"
#include "support/compare.h"
#include "support/texels.h"

namespace vesper::test {

/// What the G-buffer pass would have left.
struct Surfaces {
    VkExtent2D extent;
    std::vector<glm::vec4> reflectance, surface, emission;
    std::vector<uint32_t> slope = {};  ///< see GBuffer::slope; without, triangles are as bent as their normals

    glm::uvec2 pixel(size_t i) const { return {i % extent.width, i / extent.width}; }
    reference::SurfaceTexel texel(size_t i) const {
        return {glm::dvec4(reflectance[i]), glm::dvec4(surface[i]),
                emission.empty() ? glm::dvec3(0) : glm::dvec3(emission[i])};
    }
};

/// As images of a frame; without emission for a pass that reads none.
inline render::GBuffer upload(graph::FrameGraph& graph, const Surfaces& s) {
    render::GBuffer g{};
    g.reflectance =
        PassRig::image(graph, "reflectance", render::kReflectanceFormat, s.extent, to_halves(s.reflectance));
    g.surface = PassRig::image(graph, "surface", render::kSurfaceFormat, s.extent, s.surface);
    if (!s.emission.empty())
        g.emission = PassRig::image(graph, "emission", render::kEmissionFormat, s.extent, s.emission);
    const std::vector<uint32_t> none(s.surface.size(), 0x7fff7fff);  // NaN
    g.slope = PassRig::image(graph, "slope", render::kSlopeFormat, s.extent, s.slope.empty() ? none : s.slope);
    return g;
}

inline render::TableTexels upload(graph::FrameGraph& graph, const gpu_scene::IntensityTables& tables) {
    return {graph.upload("tables", tables.texels, VK_FORMAT_R32G32B32A32_SFLOAT), tables.roads, tables.roads != 0};
}

struct Shot {
    std::vector<glm::vec4> pixels;
    shared::ClusterPush cluster;
    shared::ClusterReport report;
};

/// All passes from lists of lamps to light.
struct LitBlocks {
    render::Clusters clusters;
    render::Blocks blocks;
    graph::Resource scene;
};
inline LitBlocks light(const render::FrameContext& frame, const render::GBuffer& g, const gpu_scene::LampList& list,
                       const render::TableTexels& tables, const render::ClusterSettings& clusters,
                       const render::ShadeSettings& settings, const render::FrameClipmaps& directional = {}) {
    LitBlocks lit{
        .clusters = render::add_clusters(frame, g.surface, list, tables, clusters), .blocks = {}, .scene = {}};
    lit.blocks = render::add_blocks(frame, g, lit.clusters);
    lit.blocks = render::add_visibility(frame, g, lit.clusters, lit.blocks, settings.maps,
                                        {settings.shadow_error, settings.probe_error});
    lit.blocks = render::add_directional_visibility(frame, g, lit.clusters, lit.blocks, directional);
    lit.blocks = render::add_merging(frame, g, lit.clusters, lit.blocks, settings.all_lamps ? 0 : settings.merge_error);
    lit.scene = render::add_shading(frame, g, lit.clusters, lit.blocks, settings);
    return lit;
}

/// Clusters and shades, seen from the origin along -Z. `sheets`: classes of retroreflection, if there are any.
inline Shot shade(PassRig& rig, const Surfaces& s, const gpu_scene::LampList& list,
                  const render::ClusterSettings& clusters, render::ShadeSettings settings,
                  const gpu_scene::IntensityTables& tables = {},
                  const std::vector<photometry::Retroreflector>& sheets = {}) {
    graph::FrameGraph graph;
    const render::FrameContext frame = rig.frame(graph, gpu_scene::View::symmetric(s.extent, 0.7f, glm::mat4(1)));
    const render::GBuffer g = upload(graph, s);
    if (!sheets.empty())
        settings.retro = graph.upload("retro", gpu_scene::retro_texels(sheets), VK_FORMAT_R32G32B32A32_SFLOAT);
    const LitBlocks lit = light(frame, g, list, upload(graph, tables), clusters, settings);
    const graph::Resource scene = keep<glm::vec4>(graph, lit.scene),
                          report = keep<shared::ClusterReport>(graph, lit.clusters.report);
    rig.run(graph);
    return {rig.got<glm::vec4>(scene), lit.clusters.push, rig.got<shared::ClusterReport>(report).at(0)};
}

/// What the shader was told, for the reference.
inline shared::ShadePush push_of(const Surfaces& s, const Shot& shot, const render::ShadeSettings& settings) {
    shared::ShadePush p{};
    p.size = {s.extent.width, s.extent.height};
    p.grid = shot.cluster.grid, p.lamps = shot.cluster.lamps, p.threshold = shot.cluster.threshold;
    p.lambert = settings.lambert, p.emission_limit = settings.emission_limit, p.ambient = settings.ambient,
    p.sky = settings.sky;
    return p;
}

inline Picture picture(VkExtent2D extent, const std::vector<glm::vec4>& pixels) {
    Picture p(extent.width, extent.height, 3);
    for (size_t i = 0; i < pixels.size(); ++i)
        for (int c = 0; c < 3; ++c) p.values[3 * i + size_t(c)] = pixels[i][c];
    return p;
}

/// Compares opaque pixels with `shaded(i)`, the reference::Shaded of each.
template <class OfPixel>
void expect_light(const std::string& name, VkExtent2D extent, const std::vector<glm::vec4>& pixels, Tolerance tolerance,
                  const OfPixel& shaded) {
    Picture want(extent.width, extent.height, 3), rounding = want;
    for (size_t i = 0; i < pixels.size(); ++i) {
        const reference::Shaded pixel = shaded(i);
        for (int c = 0; c < 3; ++c)
            want.values[3 * i + size_t(c)] = pixel.luminance[c], rounding.values[3 * i + size_t(c)] = pixel.rounding[c];
        EXPECT_EQ(pixels[i].w, 1.0f);
    }
    EXPECT_TRUE(same_light(name, picture(extent, pixels), want, tolerance, rounding));
}

/// Compares a shot with the reference. 2e-5 for sums of positive terms in float with exp2 and log2 of cosines; the
/// reference's rounding holds what cancels: dot products near a threshold, a cone's edge or a mirror's highlight. 1e-12
/// cd/m^2 is nothing. `on_roads`: relative error besides, on surfaces with a table.
inline void expect_reference(const Shot& shot, const Surfaces& s, const gpu_scene::LampList& list,
                             const render::ShadeSettings& settings, const reference::Measurements& measurements = {},
                             Tolerance tolerance = {2e-5, 1e-7}, double on_roads = 0) {
    const shared::ShadePush p = push_of(s, shot, settings);
    expect_light("scene", s.extent, shot.pixels, tolerance, [&](size_t i) {
        reference::Shaded shaded = reference::shade(s.texel(i), s.pixel(i), list.lamps, p, measurements);
        if (s.reflectance[i].w < 0) shaded.rounding += on_roads * shaded.luminance;
        return shaded;
    });
}

/// Pixels 3, 10, 17, ... held what is not finite: all others are as without that.
inline void expect_others_equal(const std::vector<glm::vec4>& got, const std::vector<glm::vec4>& want) {
    ASSERT_EQ(got.size(), want.size());
    for (size_t i = 0; i < got.size(); ++i)
        if (i % 7 != 3) {
            EXPECT_EQ(got[i], want[i]) << "pixel " << i;
        }
}

/// `add(frame, scene)` has nothing to add: the scene is what it was, by no pass.
template <class Add>
void expect_no_pass(const Add& add) {
    PassRig rig;
    graph::FrameGraph graph;
    const render::FrameContext frame = rig.frame(graph, VkExtent2D{8, 8});
    const graph::Resource scene = graph.transient("scene", graph::image_shape(render::kSceneFormat, {8, 8}));
    EXPECT_EQ(add(frame, scene), scene);
    EXPECT_TRUE(graph.passes().empty());
}

}  // namespace vesper::test
