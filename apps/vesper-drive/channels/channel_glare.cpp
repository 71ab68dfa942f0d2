#include "channels/channel_glare.h"

#include <algorithm>
#include <map>

namespace vesper::drive {
namespace {

using glm::dvec2, glm::dvec3;
constexpr int kGuard = vision::LightElsewhere::kGuard;

// Lamps of the scene, but for what any of the pictures has of them. One that several have a part of is taken to be
// wholly in them.
std::vector<vision::UnseenLamp> unseen(const std::vector<std::vector<gpu_scene::GlareSource>>& seen_by,
                                       std::span<const vision::EyePicture> pictures,
                                       const std::vector<eye::OffscreenLamp>& others) {
    struct Seen {
        vision::UnseenLamp lamp;
        double inside = 0;
    };
    std::map<uint32_t, Seen> lamps;  // by their nodes
    for (size_t i = 0; i < pictures.size(); ++i)
        for (const gpu_scene::GlareSource& source : seen_by[i])
            lamps.try_emplace(source.node, Seen{{pictures[i].turn * source.direction, source.illuminance}, 0})
                .first->second.inside += source.inside;
    std::vector<vision::UnseenLamp> left;
    for (const auto& [node, seen] : lamps)
        if (seen.inside < 1) left.push_back({seen.lamp.direction, (1 - seen.inside) * seen.lamp.illuminance});
    for (const eye::OffscreenLamp& lamp : others) left.push_back({glm::normalize(lamp.direction), lamp.illuminance});
    return left;
}

// Of the lamps, what lies beside what is shown; those in the border wholly.
std::vector<eye::OffscreenLamp> beside(const render::Frame& frame, const vision::EyePicture& picture,
                                       const std::vector<eye::OffscreenLamp>& others) {
    std::vector<eye::OffscreenLamp> lamps;
    for (const eye::OffscreenLamp& lamp : others)
        lamps.push_back({glm::transpose(picture.turn) * lamp.direction, lamp.illuminance});
    for (const gpu_scene::GlareSource& source : frame.glare_sources) {
        const dvec2 at = picture.image.pixels_at(dvec2(source.direction) / -source.direction.z),
                    far = glm::abs(at - 0.5 * dvec2(picture.image.width, picture.image.height));
        const bool shown = far.x < 0.5 * picture.image.width - kGuard && far.y < 0.5 * picture.image.height - kGuard;
        if (!shown || source.inside < 1)
            lamps.push_back({source.direction, (shown ? 1 - source.inside : 1) * source.illuminance});
    }
    return lamps;
}

}  // namespace

gpu_scene::View ChannelGlare::guarded(const gpu_scene::View& view) {
    gpu_scene::View wider = view;
    const glm::vec2 border = float(kGuard) * glm::abs(view.ray_scale());
    wider.extent = {view.extent.width + 2 * kGuard, view.extent.height + 2 * kGuard};
    wider.tangent_low -= border, wider.tangent_high += border;
    return wider;
}

// Every process then knows of the nodes of its views whose light others take.
void ChannelGlare::prepare(const eye::ScatterSettings& settings, std::vector<vision::EyePicture> pictures) {
    light_turns_.forget();
    own_.clear(), pictures_.clear();  // before the next ones take their memory
    const vision::EyeScatter psf = eye::eye_scatter(settings);
    apps::PacketWriter wants;
    for (const size_t view : link_.own(pictures.size())) {
        Own& own = own_.emplace_back(Own{.view = view,
                                         .elsewhere = vision::LightElsewhere(psf, pictures, view),
                                         .wanted = std::vector<std::vector<uint32_t>>(pictures.size())});
        wants.value(uint64_t{view});
        for (size_t of = 0; of < pictures.size(); ++of) wants.list(own.elsewhere.nodes(of));
    }
    link_.say(ChannelLink::Kind::Nodes, wants.take());
    for (const apps::Bytes& bytes : link_.hear(ChannelLink::Kind::Nodes))
        for (apps::PacketReader wanted(bytes); !wanted.at_end();) {
            const auto taker = wanted.value<uint64_t>();
            for (size_t of = 0; of < pictures.size(); ++of) {
                const std::vector<uint32_t> nodes = wanted.list<uint32_t>();
                for (Own& own : own_)
                    if (own.view == of) own.wanted.at(taker) = nodes;
            }
        }
    pictures_ = std::move(pictures), settings_ = settings;
}

// Of the views of this process: light of the nodes that each view takes.
ChannelGlare::Light ChannelGlare::light_of_own(const LightOf& light_of) const {
    Light light;
    for (const Own& own : own_) {
        std::vector<uint32_t> nodes;
        for (const std::vector<uint32_t>& wanted : own.wanted) nodes.insert(nodes.end(), wanted.begin(), wanted.end());
        const std::vector<glm::vec3> all = light_of(own.view, nodes);
        std::vector<std::vector<glm::vec3>>& by_taker = light.emplace_back();
        auto from = all.begin();
        for (const std::vector<uint32_t>& wanted : own.wanted) {
            by_taker.emplace_back(from, from + ptrdiff_t(wanted.size()));
            from += ptrdiff_t(wanted.size());
        }
    }
    return light;
}

// What each process takes for its views.
std::vector<apps::Bytes> ChannelGlare::shed_by_own(const std::vector<render::Frame>& frames, const Light& light) const {
    std::vector<apps::Bytes> packets;
    for (const std::vector<size_t>& takers : link_.shares(pictures_.size())) {
        apps::PacketWriter packet;
        for (size_t i = 0; i < own_.size(); ++i) {
            packet.value(uint64_t{own_[i].view});
            packet.list(frames[own_[i].view].glare_sources);
            for (const size_t taker : takers) packet.list(light[i][taker]);
        }
        packets.push_back(packet.take());
    }
    return packets;
}

ChannelGlare::Shed ChannelGlare::shed_of(const std::vector<apps::Bytes>& turn) const {
    const size_t views = pictures_.size();
    Shed shed{.lamps = std::vector<std::vector<gpu_scene::GlareSource>>(views),
              .by_taker = std::vector(own_.size(), std::vector<std::vector<glm::vec3>>(views))};
    for (const apps::Bytes& bytes : turn)
        for (apps::PacketReader packet(bytes); !packet.at_end();) {
            const auto giver = packet.value<uint64_t>();
            shed.lamps.at(giver) = packet.list<gpu_scene::GlareSource>();
            for (std::vector<std::vector<glm::vec3>>& taken : shed.by_taker) taken.at(giver) = packet.list<glm::vec3>();
        }
    return shed;
}

std::vector<ChannelGlare::Beside> ChannelGlare::exchange(const Moment& moment, std::span<const gpu_scene::View> guarded,
                                                         std::span<const glm::dmat3> turns,
                                                         const std::vector<render::Frame>& frames,
                                                         const LightOf& light_of) {
    const render::RenderSettings& settings = moment.settings;
    std::vector<vision::EyePicture> pictures;
    for (size_t i = 0; i < guarded.size(); ++i)
        pictures.push_back({gpu_scene::angles_of(guarded[i]), turns[i], kGuard});
    if (pictures != pictures_ || settings.scatter != settings_) prepare(settings.scatter, std::move(pictures));
    const Light light = light_of_own(light_of);
    Shed shed = shed_of(light_turns_.tell_each(shed_by_own(frames, light), moment.late));
    for (const Own& own : own_) shed.lamps[own.view] = frames[own.view].glare_sources;
    const std::vector<vision::UnseenLamp> lamps = unseen(shed.lamps, pictures_, settings.offscreen_lamps);
    std::vector<Beside> beside_of(pictures_.size());
    for (size_t i = 0; i < own_.size(); ++i) {
        const size_t view = own_[i].view;
        shed.by_taker[i][view] = light[i][view];  // of this moment in any case
        beside_of[view] = {.light = own_[i].elsewhere.of(shed.by_taker[i], lamps),
                           .lamps = beside(frames[view], pictures_[view], settings.offscreen_lamps)};
    }
    return beside_of;
}

}  // namespace vesper::drive
