// The engine: a scene, a view and settings in, cd/m^2 and display codes out. SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/cache.h"
#include "gpu_scene/cameras.h"
#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/lamps.h"
#include "gpu_scene/luminaires.h"
#include "gpu_scene/small_emitters.h"
#include "render/directional_maps.h"
#include "render/distance_maps.h"
#include "render/frame_queue.h"
#include "render/indirect_light.h"
#include "render/passes/daylight.h"
#include "render/passes/shade.h"
#include "render/passes/sky.h"
#include "render/sample_buffers.h"
#include "render/seen_obstacles.h"

namespace vesper::render {

/// RenderSettings::merge_error of no lamp at all.
constexpr float kMergesNothing = -1;

struct RenderSettings : ToneChainSettings {
    bool paper_lambert = false;                ///< L = E R instead of E R / pi
    bool all_lamps = false;                    ///< shade without clusters, for comparison
    bool shadows = true;                       ///< lamps light only what they see
    uint64_t shadow_budget = kNoShadowBudget;  ///< of tiles of distance maps drawn for a frame, see DistanceMaps
    bool indirect = true;  ///< light of emitting surfaces and of the sky, and reflected light, if the renderer has it
    uint32_t reflections = 100;           ///< of light, at most
    double reflections_left_out = 0.002;  ///< and they end where the rest would add less than this share
    bool anti_aliasing = true;  ///< pixels beside edges are means of the surfaces that fill them; of one sample
    /// Of each pixel, at sample_places(); at least 1. Luminance is their mean, before glare and the eye. With more than
    /// one all shadows are those of the moment, whatever the budget.
    uint32_t samples = 1;
    bool display_average = false;  ///< codes of render() are the mean of what the display shows of each sample, to one
                                   ///< eye, in place of what it shows of their mean
    bool moving_reflections = false;  ///< with it, the first reflection of lamps that move, if the renderer has them
    ClusterSettings clusters;
    float merge_error = ShadeSettings{}.merge_tolerance;  ///< as ShadeSettings::merge_tolerance
    float shadow_error = ShadeSettings{}.faint;           ///< as ShadeSettings::faint
    std::vector<gpu_scene::OffscreenLamp>
        offscreen_lamps;  ///< on other screens: scattered in the eye, not drawn; directions in the view frame
    float ldr_reference_distance = 6.5f;  ///< m: where an LDR lamp of 1.0 gives 1.0; the paper's lamp height
    bool unit_lamps = false;  ///< lamps and luminaires of 1.0 instead of their candela, emission of at most 1.0
    bool lamps_alone =
        false;  ///< without ambient light, daylight, sky, retroreflection and light from outside the picture
    std::vector<scene::Obstacle> obstacles;  ///< of the scene, to be measured in the picture (Frame::obstacles)
    bool obstacle_pixels = false;            ///< Frame::obstacle_pixels, too
};

/// With Operator::Ldr: the settings of the paper's baseline without any HDR. Otherwise the same settings.
RenderSettings ldr_baseline(RenderSettings settings);

/// One rendered frame on the host.
struct Frame : ToneMapped {
    shared::ClusterReport clusters{};
    shared::VisibilityReport visibility{};  ///< with shadows
    MapReport maps;                         ///< with shadows
    uint32_t directional_levels = 0;        ///< of maps of directional lamps, drawn for this frame
    uint32_t lamps = 0;                     ///< lamps that shine
    uint32_t luminaires = 0;                ///< of their openings, those in view
    float far = 0;                          ///< m: the far limit of the clusters
    std::vector<gpu_scene::GlareSource>
        glare_sources;  ///< lamps before the eye, as if nothing stood between; none with Operator::Ldr
    std::vector<gpu_scene::OffscreenLamp>
        outside;  ///< light from beside the picture: of those, and of RenderSettings::offscreen_lamps
    std::vector<SeenObstacle> obstacles;   ///< those of the settings; none with Operator::Ldr, Outputs::retina and
                                           ///< Outputs::statistics
    std::vector<uint8_t> obstacle_pixels;  ///< 1 + number of the obstacle that each pixel belongs to, 0: none; row by
                                           ///< row, if the settings ask for them and there are obstacles
};

/// Renders one scene on one device. Not thread-safe; several renderers may share a device in one thread.
class Renderer {
public:
    Renderer(gpu::Device& device, const scene::Scene& scene);

    /// Renders the scene as `view` sees it, with everything at its pose of `frame`. `seconds` have passed since the
    /// last frame. Throws Error.
    Frame render(const RenderSettings& settings, const gpu_scene::View& view, const gpu_scene::SceneFrame& frame,
                 float seconds, const Outputs& outputs);

    /// The same, submitted between semaphores and without waiting; best with Outputs::shown.
    void submit(const RenderSettings& settings, const gpu_scene::View& view, const gpu_scene::SceneFrame& frame,
                float seconds, const Outputs& outputs, const graph::SubmitSemaphores& semaphores);
    /// Waits for all submitted frames. Returns the results of the last one, once.
    std::optional<Frame> finish();
    /// Where maps of what stands still are kept from run to run; null, as at first: nowhere. Pictures do not depend on
    /// it. Throws nothing.
    void keep_maps(std::shared_ptr<Cache> cache);
    /// What light surfaces of this scene send each other, for RenderSettings::indirect; null, as at first and after
    /// set_scene(): nothing is known of it.
    void set_radiosity(std::shared_ptr<const transport::Radiosity> radiosity);
    /// What surfaces of this scene reflect of lamps that move, for RenderSettings::moving_reflections; null, as at
    /// first and after set_scene(): nothing is known of it.
    void set_lamp_reflections(std::shared_ptr<const transport::LampReflections> reflections) {
        lamp_reflections_ = std::move(reflections);
    }
    /// That light of each pixel in frames to come, RGB lx, for RenderSettings::indirect: in place of what is known by
    /// set_radiosity(), as long as it is set. Empty, as at first and after set_scene(): it is not known.
    void set_illuminance(std::vector<glm::vec4> illuminance) { illuminance_ = std::move(illuminance); }
    /// What is called after each sample of a frame but the last with how many are done, and may throw to end the frame;
    /// null, as at first: nothing. Samples of a mean of what the display shows count again.
    void watch_samples(std::function<void(uint32_t)> watch) { watch_samples_ = std::move(watch); }
    /// Takes another scene, or the same after a change. The eye goes on.
    void set_scene(const scene::Scene& scene);

    /// The plan of the last frame as text.
    std::string plan() const { return frames_.plan(); }
    /// Forgets what the eye was adapted to, as at a camera cut.
    void reset_adaptation() { frames_.set_eye({}); }
    /// The next frame goes on from this state, such as Frame::eye of an earlier run.
    void set_eye(const shared::EyeState& eye) { frames_.set_eye({eye}); }
    /// The state that the last finished frame left, or that was set since.
    const shared::EyeState& eye() const { return frames_.eye().value; }
    const gpu_scene::GpuScene& scene() const { return scene_->resident; }
    uint64_t device_bytes() const {
        return scene_->resident.bytes() + scene_->table_arena.bytes() + frames_.executor().heap_bytes() +
               samples_.bytes() + (maps_ ? maps_->report().bytes : 0) +
               (directional_maps_ ? directional_maps_->bytes() : 0) + (indirect_ ? indirect_->device_bytes() : 0);
    }

private:
    /// A texel buffer of the scene, rgba32f.
    struct TexelBuffer {
        gpu::OwnedBuffer buffer;
        uint64_t bytes = 0;  // 0: there is none
    };
    /// A scene on the device, and the parts of it that the host needs.
    struct SceneData {
        gpu_scene::GpuScene resident;
        std::vector<gpu_scene::PlacedLamp> lamps;
        gpu_scene::MapPlan maps;
        gpu_scene::DirectionalPlan directional;
        gpu_scene::LuminaireSet luminaires;
        std::vector<gpu_scene::EmittingPart> emitting;  // by part
        gpu_scene::IntensityTables tables;              // without its texels, which are uploaded
        gpu::Arena table_arena;
        TexelBuffer table_texels;
        TexelBuffer sky, retro;
        uint32_t sky_sharp_side = 0;
        gpu_scene::AmbientLight ambient;
        std::optional<photometry::Irradiance9> sky_on;  // surfaces, of a sky that is a picture

        SceneData(const gpu::Device& device, const scene::Scene& scene);
        TexelBuffer upload(const gpu::Device& device, const std::vector<glm::vec4>& texels);
    };
    /// The light and the eye of one frame, as its passes take them.
    struct FrameInputs {
        gpu_scene::LampList lamps;
        gpu_scene::LuminaireList luminaires;
        gpu_scene::SmallEmitterList small_emitters;
        TableTexels tables;
        ClusterSettings clusters;
        bool edges = false;
        ShadeSettings shading;
        DaylightSettings daylight;
        SkyTexels sky;
        IndirectCells indirect;
        MovingLight moving;
        graph::Resource illuminance;  // or that
        DirectionalMapsOfFrame directional;
        uint32_t directional_levels = 0;  // drawn for it
    };
    /// What a frame shows before glare and the eye.
    struct SceneLight {
        graph::Resource luminance;  // cd/m^2
        Clusters clusters;
        Blocks blocks;
        GBuffer surfaces;
    };
    /// The results of a submitted frame, as far as they are known.
    struct Pending {
        Frame frame;
        graph::Resource clusters, visibility;  // to be read
        graph::Resource targets;               // likewise; none without obstacles
        graph::Resource triangles;             // likewise, if pixels of obstacles are wanted
        std::vector<uint32_t> of_instances;    // see obstacles_of_instances()
        ObstaclesInView obstacles;
        gpu_scene::View view;
        std::vector<graph::Timing> earlier;  // of samples before the last
        ChainInputs chain;
    };

    void add_maps(graph::FrameGraph& graph, FrameInputs& in, const gpu_scene::SceneFrame& poses,
                  const gpu_scene::View& view, uint64_t budget);
    void add_indirect_light(graph::FrameGraph& graph, FrameInputs& in, const RenderSettings& settings,
                            const gpu_scene::View& view, const gpu_scene::SceneFrame& poses,
                            const gpu_scene::AmbientLight& ambient);
    graph::Resource illuminance_image(graph::FrameGraph& graph, VkExtent2D extent) const;
    FrameInputs inputs_of(graph::FrameGraph& graph, const RenderSettings& settings, const gpu_scene::View& view,
                          const gpu_scene::SceneFrame& poses);
    void average_display(const RenderSettings& settings, const gpu_scene::View& view,
                         const gpu_scene::SceneFrame& poses, const ChainInputs& chain,
                         const gpu_scene::Projection* projection, Frame& frame);
    ChainInputs chain_inputs_of(const FrameInputs& in, const RenderSettings& settings, const gpu_scene::View& view,
                                float seconds);
    SceneLight declare(const FrameContext& frame, const gpu_scene::SceneFrame& poses, const FrameInputs& inputs) const;
    void add_obstacles(const FrameContext& frame, const RenderSettings& settings, const gpu_scene::SceneFrame& poses,
                       const SceneLight& light, const ToneChain& chain, Pending& pending) const;
    Pending add_samples(const RenderSettings& settings, const gpu_scene::View& view, const gpu_scene::SceneFrame& poses,
                        std::span<const glm::dvec2> places);

    gpu::Device& device_;
    std::unique_ptr<const SceneData> scene_;
    std::shared_ptr<Cache> map_cache_;
    std::unique_ptr<DistanceMaps> maps_;  // of scene_; none before a frame has shadows
    std::unique_ptr<DirectionalMaps> directional_maps_;
    std::unique_ptr<IndirectLight> indirect_;
    std::shared_ptr<const transport::LampReflections> lamp_reflections_;
    std::vector<glm::vec4> illuminance_;  // pixels
    SampleBuffers samples_;
    std::function<void(uint32_t)> watch_samples_;
    FrameQueue frames_;  // waits for its frames, which use the rest
    std::optional<Pending> pending_;
};

}  // namespace vesper::render
