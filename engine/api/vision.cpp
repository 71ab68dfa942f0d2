// Figures of pictures for an observer. SPDX-License-Identifier: MIT
#include <vesper/vision.h>

#include "analysis/contrast_fidelity.h"
#include "analysis/display_light.h"
#include "analysis/saliency_mapper.h"
#include "analysis/visible_differences.h"
#include "api/handles.h"
#include "base/angle.h"
#include "render/passes/saliency.h"
#include "render/retina.h"
#include "vision/visibility.h"

struct VesperVision {
    explicit VesperVision(vesper::gpu::Device& device) : eye(device), saliency(device) {}
    vesper::render::ToneMapper eye;  // scatters light
    vesper::analysis::SaliencyMapper saliency;
};

namespace vesper::api {
namespace {

// A field that is added changes one of these: then kFirstSize of that structure is what stands here.
static_assert(sizeof(VesperObserver) == 16 && sizeof(VesperDifferences) == 28 && sizeof(VesperTarget) == 20 &&
              (sizeof(void*) != 8 || sizeof(VesperFidelity) == 40));

constexpr float kMostLuminance = 1e9f, kLeastBackground = 1e-6f;  // cd/m^2
constexpr const char* kNoVision = "no vision";

double density_of(const render::HostPicture& picture) {
    if (picture.angles) {
        const glm::dvec2 pixel = picture.angles->pixel();
        require(std::abs(pixel.x - pixel.y) <= 0.01 * pixel.y, "pixels of pictures that are compared are square");
    }
    const double density = render::pixels_per_degree(picture),
                 tangents = kRadiansPerDegree * picture.extent.height / density;
    require(tangents >= 1.745e-3 && tangents <= 22.87, "pictures that are compared cover 0.1 to 170 degrees in height");
    return density;
}

// Two pictures on the retina.
struct SeenPair {
    VkExtent2D extent;
    double pixels_per_degree;
    analysis::ContrastEye eye;
    std::vector<float> first, second;

    analysis::PicturePair pictures() const { return {extent.width, extent.height, pixels_per_degree, first, second}; }
};

SeenPair see(VesperVision* by, const VesperObserver* observer, const VesperPicture* first,
             const VesperPicture* second) {
    require(by, kNoVision);
    const analysis::ContrastEye usual;
    const VesperObserver o = observer ? known(observer, "an observer without its size")
                                      : VesperObserver{.size = sizeof o,
                                                       .age = float(usual.age),
                                                       .pigmentation = float(vision::ScatteringEye{}.pigmentation),
                                                       .scattered = 0};
    require(within(o.age, 1, 120) && within(o.pigmentation, 0, 1.5f),
            "an observer is 1 to 120 years old, with a pigmentation of 0 to 1.5");
    std::optional<vision::ImageAngles> first_angles, second_angles;
    const render::HostPicture a = picture_of(first, first_angles), b = picture_of(second, second_angles);
    require(a.extent.width == b.extent.width && a.extent.height == b.extent.height,
            "pictures that are compared have one size");
    static_assert(analysis::kMostChannelPixels == 16777216);
    require(uint64_t{a.extent.width} * a.extent.height <= analysis::kMostChannelPixels,
            "pictures of at most 16777216 pixels are compared");
    const double density = density_of(a);
    require(std::abs(density_of(b) - density) <= 1e-3 * density, "pictures that are compared cover one angle");
    const vision::ScatteringEye eye{double(o.age), double(o.pigmentation)};
    std::optional<eye::ScatterSettings> scatter;
    if (!o.scattered) scatter = {.eye = eye};
    return {a.extent,
            density,
            {.age = eye.age, .scatters = eye},
            render::retinal_luminance(by->eye, a, scatter),
            render::retinal_luminance(by->eye, b, scatter)};
}

}  // namespace

extern "C" {

VesperResult vesper_vision_create(VesperDevice* device, VesperVision** vision, VesperError* error) {
    return guarded(error, [&] {
        require(device && vision, "the device, or the pointer to the vision, is null");
        *vision = new VesperVision(device->device);
    });
}
void vesper_vision_destroy(VesperVision* vision) { delete vision; }

VesperResult vesper_visible_differences(VesperVision* by, const VesperObserver* observer, const VesperPicture* first,
                                        const VesperPicture* second, float* probability, VesperDifferences* found,
                                        VesperError* error) {
    return guarded(error, [&] {
        if (found) known(found, "differences without their size");
        const SeenPair pair = see(by, observer, first, second);
        const analysis::VisibleDifferences seen = analysis::visible_differences(pair.pictures(), pair.eye);
        give(seen.probability, probability);
        if (!found) return;
        give_known(VesperDifferences{.size = sizeof(VesperDifferences),
                                     .x = seen.x,
                                     .y = seen.y,
                                     .largest = float(seen.largest),
                                     .above_half = float(seen.above_half),
                                     .above_75 = float(seen.above_75),
                                     .above_95 = float(seen.above_95)},
                   found);
    });
}

VesperResult vesper_contrast_fidelity(VesperVision* by, const VesperObserver* observer, const VesperPicture* scene,
                                      const VesperPicture* shown, const VesperFidelity* maps, VesperError* error) {
    return guarded(error, [&] {
        const VesperFidelity to = known(maps, "maps of fidelity without their size");
        const SeenPair pair = see(by, observer, scene, shown);
        const analysis::ContrastFidelity kept = analysis::contrast_fidelity(pair.pictures(), pair.eye);
        give(kept.seen, to.seen), give(kept.lost, to.lost);
        give(kept.invented, to.invented), give(kept.amplified, to.amplified);
    });
}

VesperResult vesper_saliency(VesperVision* by, const VesperPicture* picture, float* map, VesperError* error) {
    return guarded(error, [&] {
        require(by, kNoVision);
        require(map, "the pointer to the map of saliency is null");
        std::optional<vision::ImageAngles> angles;
        const render::HostPicture host = picture_of(picture, angles);
        require(!render::saliency_pairs(host.extent).empty(), "a picture with saliency has 32 px or more on a side");
        give(by->saliency.map(host).values, map);
    });
}

VesperResult vesper_light_of_codes(const VesperToneSettings* settings, uint32_t width, uint32_t height,
                                   const uint8_t* codes, float* light, VesperError* error) {
    return guarded(error, [&] {
        require(codes && light, "the pointer to the codes, or to their light, is null");
        const VkExtent2D extent = extent_of(width, height);
        scene::DisplayFinder displays;
        const analysis::DisplayLight of_display(settings_of(settings, displays).display);
        give(of_display.of_words({codes, size_t{extent.width} * extent.height * 4}), light);
    });
}

VesperResult vesper_visibility_levels(const VesperTarget* target, size_t count, const float* luminance,
                                      const float* background, float* levels, VesperError* error) {
    return guarded(error, [&] {
        const vision::Target usual;
        const VesperTarget t = target ? known(target, "a target without its size")
                                      : VesperTarget{.size = sizeof t,
                                                     .arc_minutes = float(usual.size),
                                                     .seconds = float(usual.seconds),
                                                     .age = float(usual.age),
                                                     .veil = 0};
        require(within(t.arc_minutes, 1, 60) && within(t.seconds, 0.01f, 1e6f) && within(t.age, 1, 120),
                "a target of 1 to 60 arc minutes is seen for 0.01 to 1e6 s, at 1 to 120 years");
        require(within(t.veil, 0, kMostLuminance), "a veil is 0 to 1e9 cd/m^2");
        require(count == 0 || (luminance && background && levels),
                "the luminances of targets, of backgrounds, or the levels are missing");
        for (size_t i = 0; i < count; ++i)
            require(within(luminance[i], 0, kMostLuminance) && within(background[i], 0, kMostLuminance) &&
                        background[i] + t.veil >= kLeastBackground,
                    "luminances are 0 to 1e9 cd/m^2, of a background with its veil at least 1e-6");
        const vision::Target seen{.size = double(t.arc_minutes), .seconds = double(t.seconds), .age = double(t.age)};
        for (size_t i = 0; i < count; ++i)
            levels[i] = float(vision::visibility_level(double(luminance[i]) + double(t.veil),
                                                       double(background[i]) + double(t.veil), seen));
    });
}

}  // extern "C"

}  // namespace vesper::api
