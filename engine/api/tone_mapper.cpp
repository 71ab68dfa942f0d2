// Tone mapping of arrays and of images of the host's. SPDX-License-Identifier: MIT
#include "api/handles.h"

namespace vesper::api {
namespace {

void check_picture(float scale, float vertical_fov, bool edges) {
    require(scale > 0 && std::isfinite(scale), "the scale of a picture is more than 0 cd/m^2");
    require(edges || (vertical_fov > 0 && vertical_fov < 3.1f), "a picture covers 0 to 3.1 rad in height");
}

}  // namespace

render::HostPicture picture_of(const VesperPicture* given, std::optional<vision::ImageAngles>& angles) {
    const VesperPicture p = known(given, "a picture without its size");
    const VkExtent2D extent = extent_of(p.width, p.height);
    require(p.values && (p.channels == 3 || p.channels == 4), "a picture has values, of 3 or 4 channels");
    angles = angles_of(p.edges, extent);
    check_picture(p.scale, p.vertical_fov, angles.has_value());
    return {.extent = extent,
            .values = {p.values, size_t{p.width} * p.height * p.channels},
            .channels = p.channels,
            .scale = p.scale,
            .vertical_fov = double(p.vertical_fov),
            .angles = angles ? &*angles : nullptr};
}

extern "C" {

VesperResult vesper_tone_mapper_create(VesperDevice* device, VesperToneMapper** mapper, VesperError* error) {
    return guarded(error, [&] {
        require(device && mapper, "the device, or the pointer to the tone mapper, is null");
        *mapper = new VesperToneMapper(device->device);
    });
}
void vesper_tone_mapper_destroy(VesperToneMapper* mapper) { delete mapper; }

VesperResult vesper_tone_map(VesperToneMapper* mapper, const VesperToneSettings* settings, const VesperPicture* picture,
                             float seconds, const VesperOutputs* outputs, VesperError* error) {
    return guarded(error, [&] {
        require(mapper, VesperToneMapper::kNone);
        const VesperOutputs to = outputs_of(outputs);
        std::optional<vision::ImageAngles> angles;
        const render::HostPicture host = picture_of(picture, angles);
        const render::RenderSettings how = settings_of(settings, mapper->displays);
        const float passed = seconds_of(seconds);
        finish(*mapper);  // what it left stays should this picture fail
        const render::ToneMapped shown = mapper->engine.map(how, host, passed, wanted(to));
        give(shown, to);
    });
}

VesperResult vesper_tone_map_image(VesperToneMapper* mapper, const VesperToneSettings* settings,
                                   const VesperImagePicture* picture, float seconds, const VesperImage* shown,
                                   const VesperHandover* handover, VesperError* error) {
    return guarded(error, [&] {
        require(mapper, VesperToneMapper::kNone);
        const VesperImagePicture p = known(picture, "a picture without its size");
        const graph::ExternalImage from = picture_image(p.image);
        const auto angles = angles_of(p.edges, from.extent);
        check_picture(p.scale, p.vertical_fov, angles.has_value());
        const render::DevicePicture given{from, p.scale, double(p.vertical_fov), angles ? &*angles : nullptr};
        const graph::ExternalImage to = shown_image(shown, given.image.extent);
        require(to.image != given.image.image, "a picture is shown in another image");
        submit_frame(*mapper, settings_of(settings, mapper->displays), given, to, seconds_of(seconds),
                     semaphores_of(handover));
    });
}

VesperResult vesper_tone_mapper_finish(VesperToneMapper* mapper, VesperFrameReport* report, VesperError* error) {
    return finish(mapper, report, error);
}
VesperResult vesper_tone_mapper_reset(VesperToneMapper* mapper, VesperError* error) { return reset_eye(mapper, error); }
VesperResult vesper_tone_mapper_eye(VesperToneMapper* mapper, void* bytes, VesperError* error) {
    return read_eye(mapper, bytes, error);
}
VesperResult vesper_tone_mapper_set_eye(VesperToneMapper* mapper, const void* bytes, size_t size, VesperError* error) {
    return set_eye(mapper, bytes, size, error);
}

}  // extern "C"

}  // namespace vesper::api
