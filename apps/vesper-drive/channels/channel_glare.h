// One eye behind several screens: what each of them scatters in it falls on all. SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "channels/channel_link.h"
#include "render/renderer.h"
#include "vision/light_elsewhere.h"

namespace vesper::drive {

/// Finds the light that several pictures of one eye scatter into each other, so that the veil of what one of them shows
/// goes on in the others, whatever processes render them. Its memory of where light falls is made anew when pictures or
/// eye change; with each pair of pictures it takes some megabytes of the host.
class ChannelGlare {
public:
    explicit ChannelGlare(ChannelLink& link) : link_(link), light_turns_(link, ChannelLink::Kind::Light) {}

    /// A view with as many more pixels on every side as its glare needs.
    static gpu_scene::View guarded(const gpu_scene::View&);

    /// Input that all views of a moment share.
    struct Moment {
        const render::RenderSettings& settings;
        bool late;  ///< light of other views is that of a moment ago
    };
    /// Light from beside a picture.
    struct Beside {
        vision::OffscreenLight light;           ///< of other pictures, and of lamps that no picture shows
        std::vector<eye::OffscreenLamp> lamps;  ///< beside what is shown, for reports: they are in `light`
    };
    /// Light of nodes of a guarded view of this process, lx (SharedEye::light_of).
    using LightOf = std::function<std::vector<glm::vec3>(size_t view, std::span<const uint32_t> nodes)>;
    /// Tells other processes the light that they take of the views of this one, and hears theirs. Returns, by view,
    /// what falls beside those of this process. `frames`: of the guarded views; those of others are empty. `turns`: of
    /// each view, from its frame to that of the eye.
    std::vector<Beside> exchange(const Moment&, std::span<const gpu_scene::View> guarded,
                                 std::span<const glm::dmat3> turns, const std::vector<render::Frame>& frames,
                                 const LightOf&);
    /// The next moment has none before it.
    void forget() { light_turns_.forget(); }

private:
    /// A view of this process.
    struct Own {
        size_t view = 0;
        vision::LightElsewhere elsewhere;
        std::vector<std::vector<uint32_t>> wanted;  // nodes that each view takes light of
    };
    using Light = std::vector<std::vector<std::vector<glm::vec3>>>;  // by own view, taker: of its nodes, lx
    /// Light of all views, as far as this process takes it.
    struct Shed {
        std::vector<std::vector<gpu_scene::GlareSource>> lamps;     // by view
        std::vector<std::vector<std::vector<glm::vec3>>> by_taker;  // own view, view: of its nodes, lx
    };
    void prepare(const eye::ScatterSettings&, std::vector<vision::EyePicture>);
    Light light_of_own(const LightOf&) const;
    std::vector<apps::Bytes> shed_by_own(const std::vector<render::Frame>&, const Light&) const;
    Shed shed_of(const std::vector<apps::Bytes>&) const;

    ChannelLink& link_;
    ChannelTurns light_turns_;
    eye::ScatterSettings settings_;
    std::vector<vision::EyePicture> pictures_;
    std::vector<Own> own_;
};

}  // namespace vesper::drive
