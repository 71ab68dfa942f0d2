// One eye before several screens. SPDX-License-Identifier: MIT
#include "render/shared_eye.h"
#include "api/handles.h"

struct VesperSharedEye {
    static constexpr const char* kNone = "no shared eye";
    VesperSharedEye(vesper::gpu::Device& of, uint32_t count) : device(of), engine(of, count), views(count) {}
    struct View {
        vesper::render::StoredPicture light, retina;
        std::vector<vesper::eye::OffscreenLamp> outside;
        bool is_new = false;  // since the last adaptation
    };
    vesper::gpu::Device& device;
    vesper::render::SharedEye engine;
    vesper::scene::DisplayFinder displays;
    std::vector<View> views;
    std::optional<vesper::shared::ToneCurve> curve;  // of the last adaptation
};

namespace vesper::api {
namespace {

constexpr uint32_t kMostViews = 16;

VesperSharedEye::View& view_of(VesperSharedEye* eye, uint32_t index) {
    require(eye, VesperSharedEye::kNone);
    require(index < eye->views.size(), "the shared eye has no such view");
    return eye->views[index];
}

render::RenderSettings tone_of(VesperSharedEye& eye, const VesperToneSettings* settings) {
    render::RenderSettings made = settings_of(settings, eye.displays);
    require(made.tone_operator != render::Operator::Ldr, "the ldr operator has no eye that several views could share");
    return made;
}

}  // namespace

extern "C" {

VesperResult vesper_shared_eye_create(VesperDevice* device, uint32_t views, VesperSharedEye** eye, VesperError* error) {
    return guarded(error, [&] {
        require(device && eye, "the device, or the pointer to the shared eye, is null");
        require(views >= 1 && views <= kMostViews, "a shared eye has 1 to 16 views");
        *eye = new VesperSharedEye(device->device, views);
    });
}
void vesper_shared_eye_destroy(VesperSharedEye* eye) { delete eye; }

VesperResult vesper_shared_eye_look(VesperSharedEye* eye, uint32_t index, VesperRenderer* renderer,
                                    const VesperToneSettings* settings, const VesperView* view, VesperError* error) {
    return guarded(error, [&] {
        VesperSharedEye::View& seen = view_of(eye, index);
        require(renderer, VesperRenderer::kNone);
        require(&renderer->device == &eye->device, "the renderer and the shared eye are of two devices");
        tone_of(*eye, settings);
        require(renderer->chosen.get("display_average") == 0, kDisplayAverage);
        seen.is_new = false;
        seen.outside = render_frame(*renderer, settings, view, 0, {.display = false, .light = &seen.light}).outside;
        seen.is_new = true;
    });
}

VesperResult vesper_shared_eye_adapt(VesperSharedEye* eye, const VesperToneSettings* settings, uint32_t looked_at,
                                     float seconds, VesperFrameReport* report, VesperError* error) {
    return guarded(error, [&] {
        view_of(eye, looked_at);
        check_report(report);
        const float passed = seconds_of(seconds);
        render::RenderSettings how = tone_of(*eye, settings);
        for (const VesperSharedEye::View& view : eye->views) {
            require(view.is_new, "a view was not looked at since the last adaptation");
            const VkExtent2D extent = view.light.view().extent;
            how.histogram.electorate += uint64_t{extent.width} * extent.height;
        }
        std::vector<render::ViewStatistics> statistics;
        double milliseconds = 0;
        for (VesperSharedEye::View& view : eye->views) {
            render::SharedEye::Seen seen =
                eye->engine.see(how, view.light, {.lamps = view.outside}, passed, view.light.view(), view.retina);
            statistics.push_back(std::move(seen.statistics)), milliseconds += seen.milliseconds;
        }
        render::ToneMapped adapted = eye->engine.adapt(how, statistics, looked_at, passed);
        adapted.milliseconds += milliseconds;
        eye->curve = adapted.curve;
        for (VesperSharedEye::View& view : eye->views) view.is_new = false;
        if (report) give_known(report_of(adapted), report);
    });
}

VesperResult vesper_shared_eye_show(VesperSharedEye* eye, uint32_t index, const VesperToneSettings* settings,
                                    const VesperOutputs* outputs, VesperError* error) {
    return guarded(error, [&] {
        const VesperSharedEye::View& view = view_of(eye, index);
        const VesperOutputs to = outputs_of(outputs);
        require(!to.luminance && !to.report, "a shared eye shows codes and the light of a display");
        require(eye->curve.has_value(), "the shared eye has not adapted yet");
        give(eye->engine.show(tone_of(*eye, settings), view.retina, *eye->curve, wanted(to)), to);
    });
}

VesperResult vesper_shared_eye_reset(VesperSharedEye* eye, VesperError* error) {
    return guarded(error, [&] {
        require(eye, VesperSharedEye::kNone);
        eye->engine.reset_adaptation();
    });
}

}  // extern "C"

}  // namespace vesper::api
