// One eye behind several screens: what each of them scatters in it falls on all. SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "channels/channel_link.h"
#include "render/renderer.h"
#include "render/tone_mapper.h"
#include "vision/light_elsewhere.h"

namespace vesper::drive {

/// Scatters the light of several pictures in the one eye that sees them, so that the veil of what one of them shows
/// goes on in the others, whatever processes render them. Its memory of where light falls is made anew when pictures or
/// eye change; with each pair of pictures it takes some megabytes of the host.
class ChannelGlare {
public:
    ChannelGlare(gpu::Device& device, ChannelLink& link)
        : device_(device), link_(link), light_turns_(link, ChannelLink::Kind::Light) {}

    /// A view with as many more pixels on every side as its glare needs.
    static gpu_scene::View guarded(const gpu_scene::View&);

    /// What is the same for all views of a moment.
    struct Moment {
        const render::RenderSettings& settings;
        const std::optional<shared::EyeState>& eye;  ///< the state that the last frame left, if there was one
        float seconds;                               ///< since then
        bool late;                                   ///< light of other views is that of a moment ago
    };
    /// Scatters the light of all guarded views into those of this process. Input: their retinas without scatter; frames
    /// of others are empty. Output: the visible parts, before and after scatter. `turns`: of each view, from its frame
    /// to that of the eye.
    void scatter(const Moment&, std::span<const gpu_scene::View> guarded, std::span<const glm::dmat3> turns,
                 std::vector<render::Frame>& frames);
    /// The next moment has none before it.
    void forget() { light_turns_.forget(); }

private:
    /// A view of this process.
    struct Own {
        size_t view = 0;
        vision::LightSums sums;
        vision::LightElsewhere elsewhere;
        std::vector<std::vector<uint32_t>> wanted;  // nodes that each view takes light of
    };
    /// What all views shed, as far as this process takes it.
    struct Shed {
        std::vector<std::vector<gpu_scene::GlareSource>> lamps;     // by view
        std::vector<std::vector<std::vector<glm::vec3>>> by_taker;  // own view, view: of its nodes, lx
    };
    void prepare(const gpu_scene::ScatterSettings&, std::vector<vision::EyePicture>);
    std::vector<apps::Bytes> shed_by_own(const std::vector<render::Frame>&) const;
    Shed shed_of(const std::vector<apps::Bytes>&) const;

    gpu::Device& device_;
    ChannelLink& link_;
    ChannelTurns light_turns_;
    gpu_scene::ScatterSettings settings_;
    std::vector<vision::EyePicture> pictures_;
    std::vector<Own> own_;
    std::unique_ptr<render::ToneMapper> mapper_;  // for as many views
};

}  // namespace vesper::drive
