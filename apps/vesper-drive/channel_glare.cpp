#include "channel_glare.h"

#include <algorithm>
#include <map>

namespace vesper::drive {
namespace {

using glm::dvec2, glm::dvec3;
constexpr int kGuard = vision::LightElsewhere::kGuard;

// Lamps of the scene, but for what any of the pictures has of them. One that several have a part of is taken to be
// wholly in them.
std::vector<vision::UnseenLamp> unseen(const std::vector<render::Frame>& frames,
                                       std::span<const vision::EyePicture> pictures,
                                       const std::vector<gpu_scene::OffscreenLamp>& others) {
    struct Seen {
        vision::UnseenLamp lamp;
        double inside = 0;
    };
    std::map<uint32_t, Seen> lamps;  // by their nodes
    for (size_t i = 0; i < frames.size(); ++i)
        for (const gpu_scene::GlareSource& source : frames[i].glare_sources)
            lamps.try_emplace(source.node, Seen{{pictures[i].turn * source.direction, source.illuminance}, 0})
                .first->second.inside += source.inside;
    std::vector<vision::UnseenLamp> left;
    for (const auto& [node, seen] : lamps)
        if (seen.inside < 1) left.push_back({seen.lamp.direction, (1 - seen.inside) * seen.lamp.illuminance});
    for (const gpu_scene::OffscreenLamp& lamp : others)
        left.push_back({glm::normalize(lamp.direction), lamp.illuminance});
    return left;
}

// Of the lamps, what lies beside what is shown; those in the border wholly.
std::vector<gpu_scene::OffscreenLamp> beside(const render::Frame& frame, const vision::EyePicture& picture,
                                             const std::vector<gpu_scene::OffscreenLamp>& others) {
    std::vector<gpu_scene::OffscreenLamp> lamps;
    for (const gpu_scene::OffscreenLamp& lamp : others)
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

std::vector<float> without_border(const std::vector<float>& rgba, VkExtent2D extent) {
    const size_t width = extent.width - 2 * kGuard, height = extent.height - 2 * kGuard;
    std::vector<float> inner;
    inner.reserve(4 * width * height);
    for (size_t y = 0; y < height; ++y) {
        const auto row = rgba.begin() + ptrdiff_t(4 * ((y + kGuard) * extent.width + kGuard));
        inner.insert(inner.end(), row, row + ptrdiff_t(4 * width));
    }
    return inner;
}

}  // namespace

gpu_scene::View ChannelGlare::guarded(const gpu_scene::View& view) {
    gpu_scene::View wider = view;
    const glm::vec2 border = float(kGuard) * glm::abs(view.ray_scale());
    wider.extent = {view.extent.width + 2 * kGuard, view.extent.height + 2 * kGuard};
    wider.tangent_low -= border, wider.tangent_high += border;
    return wider;
}

void ChannelGlare::scatter(const render::RenderSettings& settings, std::span<const gpu_scene::View> guarded,
                           std::span<const glm::dmat3> turns, const std::optional<shared::EyeState>& eye, float seconds,
                           std::vector<render::Frame>& frames) {
    std::vector<vision::EyePicture> pictures;
    for (size_t i = 0; i < guarded.size(); ++i)
        pictures.push_back({gpu_scene::angles_of(guarded[i]), turns[i], kGuard});
    if (pictures != pictures_ || settings.scatter != settings_) {
        if (pictures.size() != pictures_.size())
            mapper_ = std::make_unique<render::ToneMapper>(device_, pictures.size());
        sums_.clear(), elsewhere_.clear(), pictures_.clear();  // before the next ones take their memory
        const vision::EyeScatter psf = gpu_scene::eye_scatter(settings.scatter);
        for (size_t i = 0; i < pictures.size(); ++i) {
            sums_.emplace_back(pictures[i].image);
            elsewhere_.emplace_back(psf, pictures, i);
        }
        pictures_ = pictures, settings_ = settings.scatter;
    }
    for (size_t i = 0; i < frames.size(); ++i) sums_[i].take(frames[i].retina);
    const std::vector<vision::UnseenLamp> lamps = unseen(frames, pictures_, settings.offscreen_lamps);
    std::vector<vision::OffscreenLight> beyond;
    for (const vision::LightElsewhere& elsewhere : elsewhere_) beyond.push_back(elsewhere.of(sums_, lamps));
    for (size_t i = 0; i < frames.size(); ++i) {
        render::Frame& frame = frames[i];
        mapper_->set_eye(eye.value_or(shared::EyeState{}));
        const VkExtent2D extent = guarded[i].extent;
        render::ToneMapped seen = mapper_->map(settings,
                                               {.extent = extent,
                                                .values = frame.retina,
                                                .channels = 4,
                                                .angles = &pictures_[i].image,
                                                .beyond = &beyond[i]},
                                               seconds, {.display = false, .retina = true});
        frame.scene = without_border(frame.retina, extent);
        frame.retina = without_border(seen.retina, extent);
        frame.extent = {extent.width - 2 * kGuard, extent.height - 2 * kGuard};
        frame.outside = beside(frame, pictures_[i], settings.offscreen_lamps);
        frame.timings.insert(frame.timings.end(), seen.timings.begin(), seen.timings.end());
        frame.pupil = seen.pupil, frame.pattern_milliseconds = seen.pattern_milliseconds;
        frame.milliseconds += seen.milliseconds;
    }
}

}  // namespace vesper::drive
