// The engine's face: a scene, a view and settings in, a picture in cd/m^2 and on the display out. SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/stopwatch.h"
#include "gpu_scene/cameras.h"
#include "gpu_scene/lamps.h"
#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/luminaires.h"
#include "render/tone_chain.h"

namespace vesper {

struct RenderSettings : ToneChainSettings {
    bool paper_lambert = false;            ///< L = E R instead of E R / pi
    bool all_lamps = false;               ///< shade without clusters, for comparison
    ClusterSettings clusters;
    std::vector<OffscreenLamp> offscreen_lamps;  ///< on other screens: scattered in the eye, not drawn; directions in the view frame
    float ldr_reference_distance = 6.5f;   ///< m: where an LDR lamp of 1.0 lamps with 1.0; the paper's lamp height
};

/// One rendered frame on the host.
struct Frame : ToneMapped {
    shared::ClusterReport clusters{};
    uint32_t lamps = 0;            ///< lamps that shine
    uint32_t luminaires = 0;           ///< of their openings, those in view
    float far = 0;                  ///< m: the far limit of the clusters
    std::vector<GlareSource> glare_sources;  ///< lamps before the eye, as if nothing stood between; none with Operator::Ldr
    std::vector<OffscreenLamp> outside;        ///< light from beside the picture: of those, and of lamps elsewhere
};

/// Renders one scene on one device. Not thread-safe; several renderers may share a device in one thread.
class Renderer {
public:
    Renderer(Device& device, const Scene& scene);

    /// Renders the scene as `view` sees it, with everything at its pose of `frame`. `seconds` have passed since the last
    /// frame. Throws Error.
    Frame render(const RenderSettings& settings, const View& view, const SceneFrame& frame, float seconds, const Outputs& outputs);

    /// The same, handed to the queue between semaphores of others, without waiting; best with Outputs::shown.
    void submit(const RenderSettings& settings, const View& view, const SceneFrame& frame, float seconds, const Outputs& outputs, const SubmitSemaphores& semaphores);
    /// Waits for all of them, and gives what the last one left; nothing where there was none.
    std::optional<Frame> finish();
    /// Takes another scene, or the same after a change. The eye goes on.
    void set_scene(const Scene& scene);

    /// The plan of the last frame as text.
    std::string plan() const { return graph_.describe(executor_.plan()); }
    /// Forgets what the eye was adapted to, as at a camera cut.
    void reset_adaptation() { eye_.reset(executor_); }
    /// The next frame goes on from this state, such as Frame::eye of an earlier run.
    void set_eye(const shared::EyeState& eye) { eye_.set(eye); }
    const GpuScene& scene() const { return scene_->resident; }
    uint64_t device_bytes() const { return scene_->resident.bytes() + scene_->table_arena.bytes() + executor_.heap_bytes(); }

private:
    /// The frame's resources that the host reads.
    struct Declared {
        ToneChain chain;
        Resource clusters;
        float far;
    };
    /// A texel buffer of the scene, rgba32f.
    struct TexelBuffer {
        OwnedBuffer buffer;
        uint64_t bytes = 0;
        explicit operator bool() const { return bytes != 0; }
        Resource in(FrameGraph& graph, const std::string& name) const;
    };
    /// What is kept of a scene.
    struct Drawn {
        GpuScene resident;
        std::vector<PlacedLamp> lamps;
        LuminaireSet luminaires;
        IntensityTables tables;               // without its texels, which are uploaded
        Arena table_arena;
        TexelBuffer table_texels;
        TexelBuffer sky, retro;       // without buffers where the scene has no picture of a sky, nothing retroreflective
        uint32_t sky_sharp_side = 0;
        AmbientLight ambient;         // of the scene

        Drawn(const Device& device, const Scene& scene);
        TexelBuffer upload(const Device& device, const std::vector<glm::vec4>& texels);
    };
    /// A frame that was handed to the queue.
    struct Pending {
        Stopwatch watch;
        Frame frame;
        Declared declared;
    };
    Declared declare(FrameGraph& graph, const RenderSettings& settings, const View& view, const SceneFrame& frame,
                     const LampList& lamps, const LuminaireList& luminaires, const ChainInputs& given, const Outputs& outputs) const;

    const Device& device_;
    Kernels kernels_;
    std::unique_ptr<const Drawn> scene_;
    EyeKeeper eye_;
    FrameGraph graph_;  // of the last one
    Executor executor_;  // waits for its frames, which use the rest
    std::optional<Pending> pending_;
};

}  // namespace vesper
