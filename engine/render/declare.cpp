#include "render/declare.h"

#include "render/passes/edges.h"
#include "render/passes/indirect.h"
#include "render/passes/luminaires.h"
#include "render/passes/moving_light.h"
#include "render/passes/sky.h"
#include "render/passes/small_emitters.h"

namespace vesper::render {
namespace {

using graph::Resource;

Resource illuminance_image(const FrameContext& frame, const std::vector<glm::vec4>& illuminance) {
    const Resource from = frame.graph.upload("illuminance of pixels", illuminance);
    const Resource to =
        frame.graph.transient("illuminance", graph::image_shape(VK_FORMAT_R32G32B32A32_SFLOAT, frame.view.extent));
    frame.graph.copy("bring illuminance", from, to);
    return to;
}

// Light between surfaces, from where the frame has it.
Resource add_light_between_surfaces(const FrameContext& frame, ResidentScene& scene, const Prepared& prepared,
                                    const gpu_scene::SceneFrame& poses, const gpu_scene::View& view,
                                    const GBuffer& surfaces, Resource luminance) {
    const float lambert = prepared.shading.lambert;
    if (prepared.indirect == Prepared::Indirect::Pixels)
        return add_illuminance(frame, surfaces, luminance, illuminance_image(frame, scene.illuminance), lambert);
    if (prepared.indirect == Prepared::Indirect::None) return luminance;
    const IndirectCells cells = scene.indirect->cells(frame.graph, prepared.radiosity);
    const MovingLight moving = scene.indirect->moving(frame.graph, prepared.patches, poses, view);
    return add_indirect(frame, surfaces, luminance, cells, add_moving_light(frame, surfaces, moving), lambert);
}

}  // namespace

SceneLight declare(const FrameContext& frame, ResidentScene& scene, const Prepared& prepared,
                   const gpu_scene::SceneFrame& poses, const gpu_scene::View& view) {
    graph::FrameGraph& graph = frame.graph;
    const SceneData& data = scene.data;
    const TableTexels tables{data.table_texels.declare(graph, "intensity tables"), data.tables.roads,
                             data.tables.roads != 0};
    ShadeSettings shading = prepared.shading;
    SkyTexels sky;
    if (prepared.outside) {
        shading.retro = data.retro.declare(graph, "retroreflection");
        sky = {data.sky.declare(graph, "sky map"), data.sky_sharp_side, prepared.sky_lambert};
    }

    const GBuffer surfaces = add_gbuffer(frame, data.resident, poses, prepared.small_emitters.parts);
    const Clusters clusters = add_clusters(frame, surfaces.surface, prepared.lamps, tables, prepared.clusters);
    Blocks blocks = add_blocks(frame, surfaces, clusters);
    FrameClipmaps directional;
    if (prepared.shadows) {
        const BlockLists lists{surfaces, clusters, blocks};
        shading.maps = scene.maps->declare(frame, prepared.lamps, poses, &lists);
        if (scene.directional) directional = scene.directional->declare(frame, prepared.lamps, poses, view);
    }
    blocks =
        add_visibility(frame, surfaces, clusters, blocks, shading.maps, {shading.shadow_error, shading.probe_error});
    blocks = add_directional_visibility(frame, surfaces, clusters, blocks, directional);
    blocks = add_merging(frame, surfaces, clusters, blocks, shading.merge_error);
    Resource luminance = add_shading(frame, surfaces, clusters, blocks, shading);
    luminance = add_daylight(frame, surfaces, luminance, prepared.daylight);
    luminance = add_light_between_surfaces(frame, scene, prepared, poses, view, surfaces, luminance);
    luminance = add_sky(frame, surfaces, luminance, sky);
    if (prepared.edge_points > 0) add_edges(frame, surfaces, luminance, prepared.edge_points);
    luminance = add_small_emitters(frame, surfaces, luminance, prepared.small_emitters);
    luminance = add_luminaires(frame, luminance, surfaces.surface, prepared.luminaires);
    return {luminance, clusters, blocks, surfaces};
}

}  // namespace vesper::render
