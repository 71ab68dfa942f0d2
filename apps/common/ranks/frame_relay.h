// Frames of a film on several ranks. SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "ranks/ranks.h"
#include "render/renderer.h"
#include "render/shared_eye.h"

namespace vesper::apps {

/// Each rank renders every size-th frame, from that of its number on, and hands the state of the eye to the rank of the
/// next one: the frames are those of one process, to the bit. What is made of them comes to the first rank, in order.
/// Not for means of what the display shows. A single rank renders as the renderer does.
class FrameRelay {
public:
    FrameRelay(gpu::Device& device, Ranks& ranks, unsigned frames) : ranks_(ranks), eye_(device), frames_(frames) {}

    bool has(unsigned frame) const { return int(frame % unsigned(ranks_.size())) == ranks_.rank(); }
    /// The eye that frames find.
    struct Finds {
        bool fresh = false;  ///< one that has seen nothing, in place of what the frame before has left
        std::optional<shared::EyeState> eye = {};  ///< this one
        bool all_known = false;                    ///< every frame has one, so that none is handed on
    };
    /// A frame that this rank has, as Renderer::render().
    render::Frame render(render::Renderer&, const render::RenderSettings&, const gpu_scene::View&,
                         const gpu_scene::SceneFrame&, float seconds, const render::Outputs&, unsigned frame,
                         const Finds&);

    /// What was made of a frame that this rank has. The first rank hands all up to it to `take`.
    using Take = std::function<void(unsigned frame, const Bytes&)>;
    void deliver(unsigned frame, Bytes made, const Take& take);
    /// After the last frame: the rest.
    void finish(const Take& take);

private:
    int rank_of(unsigned frame) const { return int(frame % unsigned(ranks_.size())); }
    void take_until(unsigned frame, const Take& take);

    Ranks& ranks_;
    render::SharedEye eye_;
    render::StoredPicture light_, retina_;  // of the frame that is made
    unsigned frames_, taken_ = 0;
};

}  // namespace vesper::apps
