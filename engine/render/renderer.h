// The engine: a scene, a view and settings in, cd/m^2 and display codes out. SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/cache.h"
#include "gpu_scene/luminaires.h"
#include "render/passes/cluster.h"
#include "render/passes/shade.h"
#include "render/seen_obstacles.h"
#include "render/settings.h"
#include "render/shadows/shadow_report.h"
#include "transport/lamp_reflections.h"
#include "transport/radiosity.h"

namespace vesper::render {

/// With Operator::Ldr: the settings of the paper's baseline without any HDR. Otherwise the same settings.
RenderSettings ldr_baseline(RenderSettings settings);

/// One rendered frame on the host.
struct Frame : ToneMapped {
    shared::ClusterReport clusters{};
    shared::VisibilityReport visibility{};  ///< with shadows
    ShadowReport maps;                      ///< with shadows
    uint32_t directional_levels = 0;        ///< of maps of directional lamps, drawn for this frame
    uint32_t lamps = 0;                     ///< lamps that shine
    uint32_t luminaires = 0;                ///< of their openings, those in view
    float far = 0;                          ///< m: the far limit of the clusters
    std::vector<gpu_scene::GlareSource>
        glare_sources;  ///< lamps before the eye, as if nothing stood between; none with Operator::Ldr
    std::vector<eye::OffscreenLamp>
        outside;  ///< light from beside the picture: of those, and of RenderSettings::offscreen_lamps
    std::vector<SeenObstacle> obstacles;   ///< those of the settings; none with Operator::Ldr, Outputs::retina and
                                           ///< Outputs::statistics
    std::vector<uint8_t> obstacle_pixels;  ///< 1 + number of the obstacle that each pixel belongs to, 0: none; row by
                                           ///< row, if the settings ask for them and there are obstacles
};

/// Renders one scene on one device. Not thread-safe; several renderers may share a device in one thread.
class Renderer {
public:
    /// `cache`: as keep_maps() takes it; cells of casters are kept there, too.
    Renderer(gpu::Device& device, const scene::Scene& scene, std::shared_ptr<Cache> cache = nullptr);
    ~Renderer();
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;

    /// Renders the scene as `view` sees it, with everything at its pose of `frame`. `seconds` have passed since the
    /// last frame. Throws Error.
    Frame render(const RenderSettings& settings, const gpu_scene::View& view, const gpu_scene::SceneFrame& frame,
                 float seconds, const Outputs& outputs);

    /// The same, submitted between semaphores and without waiting; best with Outputs::shown.
    void submit(const RenderSettings& settings, const gpu_scene::View& view, const gpu_scene::SceneFrame& frame,
                float seconds, const Outputs& outputs, const graph::SubmitSemaphores& semaphores);
    /// Waits for all submitted frames. Returns the results of the last one, once.
    std::optional<Frame> finish();
    /// Results of the oldest submitted frame whose results were not returned; those of frames before the last
    /// graph::Executor::kFramesUnderWay are lost, and with temporal glare those of all but the last. Without `waits`
    /// there are none while it is under way.
    std::optional<Frame> finish_oldest(bool waits);
    /// Submitted frames whose results are left.
    size_t unfinished() const;
    /// Where maps of what stands still are kept from run to run; null, as at first: nowhere. Pictures do not depend on
    /// it. Throws nothing.
    void keep_maps(std::shared_ptr<Cache> cache);
    /// What light surfaces of this scene send each other, for RenderSettings::indirect; null, as at first and after
    /// set_scene(): nothing is known of it.
    void set_radiosity(std::shared_ptr<const transport::Radiosity> radiosity);
    /// What surfaces of this scene reflect of lamps that move, for RenderSettings::moving_reflections; null, as at
    /// first and after set_scene(): nothing is known of it.
    void set_lamp_reflections(std::shared_ptr<const transport::LampReflections> reflections);
    /// That light of each pixel in frames to come, RGB lx, for RenderSettings::indirect: in place of what is known by
    /// set_radiosity(), as long as it is set. Empty, as at first and after set_scene(): it is not known.
    void set_illuminance(std::vector<glm::vec4> illuminance);
    /// What is called after each sample of a frame but the last with how many are done, and may throw to end the frame;
    /// null, as at first: nothing. Samples of a mean of what the display shows count again.
    void watch_samples(std::function<void(uint32_t)> watch);
    /// Takes another scene, or the same after a change. The eye goes on.
    void set_scene(const scene::Scene& scene);

    /// The plan of the last frame as text.
    std::string plan() const;
    /// Forgets what the eye was adapted to, as at a camera cut.
    void reset_adaptation();
    /// The next frame goes on from this state, such as Frame::eye of an earlier run.
    void set_eye(const shared::EyeState& eye);
    /// The state that the last finished frame left, or that was set since.
    const shared::EyeState& eye() const;
    const gpu_scene::GpuScene& scene() const;
    uint64_t device_bytes() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace vesper::render
