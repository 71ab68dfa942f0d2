// Rendering a scene into arrays and into images of the host's. SPDX-License-Identifier: MIT
#include <glm/gtc/matrix_transform.hpp>

#include "api/handles.h"
#include "gpu_scene/cameras.h"
#include "io/cache_folder.h"
#include "render/passes/samples.h"
#include "scene/placement.h"
#include "transport/kept_radiosity.h"

namespace vesper::api {
namespace {

// Everything where it stands at a time, but for what was put elsewhere, and what hangs on that.
gpu_scene::SceneFrame frame_of(const VesperRenderer& renderer, double seconds) {
    const scene::Scene& scene = renderer.scene.scene;
    gpu_scene::SceneFrame frame{scene::placed_transforms(scene, seconds, renderer.places)};
    if (!renderer.places.empty()) {
        frame.moving.assign(scene.nodes.size(), false);
        for (const auto& [node, place] : renderer.places) frame.moving[node] = true;
        frame.moving = scene::at_and_below(scene, std::move(frame.moving));
    }
    if (renderer.dimming.empty()) return frame;
    frame.dimming.assign(scene.nodes.size(), 1);
    for (const auto& [node, factor] : renderer.dimming) frame.dimming[node] = factor;
    return frame;
}

gpu_scene::View view_of(const VesperView& v, const scene::Scene& scene, const gpu_scene::SceneFrame& frame) {
    const VkExtent2D extent = extent_of(v.width, v.height);
    if (v.camera) return gpu_scene::camera_view(scene, frame, v.camera, extent);
    const auto angles = angles_of(v.edges, extent);
    require(finite(v.eye) && finite(v.forward) && finite(v.up) &&
                (angles || (v.vertical_fov > 0 && v.vertical_fov < 3.1f)) && v.near_plane > 0 && v.near_plane < 1e6f,
            "a view has an eye, a vertical angle of 0 to 3.1 rad and a near plane beyond 0 m");
    constexpr const char* kTwo = "a view's forward and up are two directions";
    const glm::dvec3 eye(vector(v.eye)), forward = direction(v.forward, kTwo), up = direction(v.up, kTwo);
    require(glm::length(glm::cross(forward, up)) > 1e-6, kTwo);
    const glm::dmat4 world_to_view(glm::lookAt(eye, eye + forward, up));
    if (angles) return gpu_scene::View::of(*angles, world_to_view, v.near_plane);
    return gpu_scene::View::symmetric(extent, v.vertical_fov, world_to_view, v.near_plane);
}

/// The request for a frame: what is drawn, from where, and how.
struct FrameRequest {
    gpu_scene::SceneFrame frame;
    gpu_scene::View view;
    render::RenderSettings settings;
};
FrameRequest request_of(VesperRenderer& renderer, const VesperToneSettings* tone, const VesperView* view) {
    FrameRequest request{.frame = {}, .view = {}, .settings = settings_of(tone, renderer.displays)};
    renderer.chosen.apply(request.settings);
    accepted([&] { render::check_light(request.settings); });
    const VesperView v = known(view, "a view without its size");
    require(v.scene_seconds >= 0 && v.scene_seconds <= 1e9, "the scene's time is 0 to 1e9 s");
    request.frame = frame_of(renderer, v.scene_seconds);
    request.view = view_of(v, renderer.scene.scene, request.frame);
    return request;
}

/// With all that changed in it. After everything a call is given has been checked: a call that is refused changes
/// nothing.
void take_over_scene(VesperRenderer& renderer) {
    if (renderer.version == renderer.scene.version) return;
    renderer.engine.set_scene(renderer.scene.scene);
    renderer.reflecting.reset();
    const auto is_gone = [&](const auto& of_node) {
        return of_node.first < renderer.scene.gone.size() && renderer.scene.gone[of_node.first];
    };
    std::erase_if(renderer.places, is_gone);
    std::erase_if(renderer.dimming, is_gone);
    renderer.version = renderer.scene.version;
}

// What is placed, and what animations move.
std::vector<bool> all_moving(const scene::Scene& scene, const gpu_scene::SceneFrame& frame) {
    std::vector<bool> moving = scene::animated_nodes(scene);
    for (size_t node = 0; node < frame.moving.size(); ++node) moving[node] = moving[node] || frame.moving[node];
    return moving;
}

void find_lamp_reflections(VesperRenderer& renderer, const FrameRequest& request) {
    if (!request.settings.moving_reflections) return;
    const scene::Scene& scene = renderer.scene.scene;
    std::vector<bool> moving = all_moving(scene, request.frame);
    if (renderer.reflecting == moving) return;
    renderer.engine.set_lamp_reflections(
        std::make_shared<const transport::LampReflections>(scene, request.frame.world, moving));
    renderer.reflecting = std::move(moving);
}

void require_node(const VesperRenderer& renderer, uint32_t node) {
    require(node < renderer.scene.scene.nodes.size(), "the scene has no such node");
}

}  // namespace

render::Frame render_frame(VesperRenderer& renderer, const VesperToneSettings* settings, const VesperView* view,
                           float seconds, const render::Outputs& outputs) {
    const float passed = seconds_of(seconds);
    const FrameRequest request = request_of(renderer, settings, view);
    finish(renderer);  // what it left stays should this frame fail
    take_over_scene(renderer);
    find_lamp_reflections(renderer, request);
    return renderer.engine.render(request.settings, request.view, request.frame, passed, outputs);
}

extern "C" {

VesperResult vesper_renderer_create(VesperDevice* device, const VesperScene* scene, VesperRenderer** renderer,
                                    VesperError* error) {
    return guarded(error, [&] {
        require(device && scene && renderer, "the device, the scene, or the pointer to the renderer is null");
        *renderer = new VesperRenderer(device->device, *scene);
    });
}
void vesper_renderer_destroy(VesperRenderer* renderer) { delete renderer; }

VesperResult vesper_renderer_place(VesperRenderer* renderer, uint32_t node, const float node_to_world[16],
                                   VesperError* error) {
    return guarded(error, [&] {
        require(renderer && node_to_world, "no renderer, or no place");
        require_node(*renderer, node);
        renderer->places[node] = place_of(node_to_world);
    });
}

VesperResult vesper_renderer_dim(VesperRenderer* renderer, uint32_t node, float factor, VesperError* error) {
    return guarded(error, [&] {
        require(renderer, VesperRenderer::kNone);
        require_node(*renderer, node);
        require(factor >= 0 && factor <= 1e6f, "light is dimmed by a factor of 0 to 1e6");
        const scene::Node& at = renderer->scene.scene.nodes[node];
        require(at.lamp != scene::kNone || at.mesh != scene::kNone, "there is no lamp and no mesh at this node");
        renderer->dimming[node] = factor;
    });
}

VesperResult vesper_renderer_set_cache(VesperRenderer* renderer, const char* folder, VesperError* error) {
    return guarded(error, [&] {
        require(renderer, VesperRenderer::kNone);
        require(!folder || *folder, "the name of the folder is empty");
        std::shared_ptr<io::CacheFolder> cache;
        if (folder) {
            cache = std::make_shared<io::CacheFolder>(std::filesystem::absolute(folder));
            cache->make();
        }
        renderer->cache = cache;
        renderer->engine.keep_maps(std::move(cache));
    });
}

VesperResult vesper_renderer_gather_light(VesperRenderer* renderer, VesperProgress progress, void* user,
                                          VesperError* error) {
    return guarded(error, [&] {
        require(renderer, VesperRenderer::kNone);
        finish(*renderer);
        take_over_scene(*renderer);
        const gpu_scene::SceneFrame rest = frame_of(*renderer, 0);
        const scene::Scene& scene = renderer->scene.scene;
        const std::vector<bool> moving = all_moving(scene, rest);
        renderer->engine.set_lamp_reflections(nullptr), renderer->reflecting.reset();
        auto radiosity =
            transport::kept_or_gathered(scene, rest.world, moving, {}, renderer->cache.get(),
                                        [&](double share) { return !progress || progress(share, user) != 0; });
        if (!radiosity) throw Error("the work on light between surfaces was ended");
        renderer->engine.set_radiosity(std::make_shared<const transport::Radiosity>(std::move(*radiosity)));
    });
}

VesperResult vesper_render(VesperRenderer* renderer, const VesperToneSettings* settings, const VesperView* view,
                           float seconds, const VesperOutputs* outputs, VesperError* error) {
    return guarded(error, [&] {
        require(renderer, VesperRenderer::kNone);
        const VesperOutputs to = outputs_of(outputs);
        give(render_frame(*renderer, settings, view, seconds, wanted(to)), to);
    });
}

VesperResult vesper_render_image(VesperRenderer* renderer, const VesperToneSettings* settings, const VesperView* view,
                                 float seconds, const VesperImage* shown, const VesperHandover* handover,
                                 VesperError* error) {
    return guarded(error, [&] {
        require(renderer, VesperRenderer::kNone);
        const float passed = seconds_of(seconds);
        const graph::SubmitSemaphores semaphores = semaphores_of(handover);
        const FrameRequest request = request_of(*renderer, settings, view);
        require(renderer->device.borrowed(), kBorrowed);
        require(!request.settings.display_average, kDisplayAverage);
        const render::Outputs to{.display = false, .shown = shown_image(shown, request.view.extent)};
        take_over_scene(*renderer);
        find_lamp_reflections(*renderer, request);
        submit_frame(*renderer, request.settings, request.view, request.frame, passed, to, semaphores);
    });
}

VesperResult vesper_renderer_finish(VesperRenderer* renderer, VesperFrameReport* report, VesperError* error) {
    return finish(renderer, report, error);
}
VesperResult vesper_renderer_reset(VesperRenderer* renderer, VesperError* error) { return reset_eye(renderer, error); }
VesperResult vesper_renderer_eye(VesperRenderer* renderer, void* bytes, VesperError* error) {
    return read_eye(renderer, bytes, error);
}
VesperResult vesper_renderer_set_eye(VesperRenderer* renderer, const void* bytes, size_t size, VesperError* error) {
    return set_eye(renderer, bytes, size, error);
}

}  // extern "C"

}  // namespace vesper::api
