// The engine's face: a scene, a view and settings in, a picture in cd/m^2 and on the display out. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "resident/cameras.h"
#include "resident/lights.h"
#include "resident/resident_scene.h"
#include "resident/sources.h"
#include "tone_chain.h"

namespace vesper {

struct RenderSettings : ToneChainSettings {
    bool paper_lambert = false;            ///< L = E R instead of E R / pi
    bool all_lights = false;               ///< shade without clusters, for comparison
    ClusterSettings clusters;
    std::vector<OutsideLamp> lamps_elsewhere;  ///< on other screens: scattered in the eye, not drawn; directions in the view frame
    float ldr_reference_distance = 6.5f;   ///< m: where an LDR lamp of 1.0 lights with 1.0; the paper's lamp height
};

/// One rendered frame on the host.
struct Frame : ToneMapped {
    shared::ClusterReport clusters{};
    uint32_t lights = 0;            ///< lamps that shine
    uint32_t sources = 0;           ///< of their openings, those in view
    float far = 0;                  ///< m: the far limit of the clusters
    std::vector<GlareSource> glare_sources;  ///< lamps before the eye, as if nothing stood between; none with Operator::Ldr
    std::vector<OutsideLamp> outside;        ///< light from beside the picture: of those, and of lamps elsewhere
};

/// Renders one scene on one device. Not thread-safe; several renderers may share a device in one thread.
class Renderer {
public:
    Renderer(Device& device, const Scene& scene);

    /// Renders the scene as `view` sees it, with everything at its pose of `frame`. `seconds` have passed since the last
    /// frame. Throws Error.
    Frame render(const RenderSettings& settings, const View& view, const SceneFrame& frame, float seconds, Outputs outputs);

    /// The plan of the last frame as text.
    const std::string& plan() const { return plan_; }
    /// Forgets what the eye was adapted to, as at a camera cut.
    void reset_adaptation();
    /// The next frame goes on from this state, such as Frame::eye of an earlier run.
    void set_eye(const shared::EyeState& eye) { eye_ = eye; }
    const ResidentScene& scene() const { return resident_; }
    uint64_t device_bytes() const { return resident_.bytes() + map_arena_.bytes() + executor_.heap_bytes(); }

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
    TexelBuffer upload_texels(const Device& device, const std::vector<glm::vec4>& texels);
    Declared declare(FrameGraph& graph, const RenderSettings& settings, const View& view, const SceneFrame& frame,
                     const LightList& lights, const SourceList& sources, const ChainInputs& given, Outputs outputs) const;

    Kernels kernels_;
    ResidentScene resident_;
    std::vector<PlacedLight> lights_;
    SourceSet sources_;
    LightMaps maps_;              // without its texels, which are uploaded
    Arena map_arena_;
    TexelBuffer map_texels_;
    TexelBuffer sky_, retro_;     // without buffers where the scene has no picture of a sky, nothing retroreflective
    uint32_t sky_sharp_side_ = 0;
    AmbientLight ambient_;        // of the scene
    ScatterCache scatter_;
    CoronaCache corona_;
    Executor executor_;
    std::optional<shared::EyeState> eye_;  // set for the next frame
    shared::EyeState last_eye_{};          // what the last frame left
    std::string plan_;
};

}  // namespace vesper
