#include "study_picture.h"
#include "gpu_scene/cameras.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "arguments/cache_arguments.h"
#include "arguments/picture_arguments.h"
#include "base/error.h"
#include "base/one_line.h"
#include "gathered_light.h"
#include "print.h"
#include "render/renderer.h"
#include "scene/placement.h"
#include "scene_notes.h"
#include "shared/photometry.h"
#include "statistics.h"

namespace vesper::commands {
namespace {

/// Renders the scene once.
StudyPicture rendered(const PictureSource& arguments, gpu::Device& device, const render::ToneChainSettings& settings,
                      const std::string& input) {
    const VkExtent2D extent = apps::parse_size(arguments.size);
    scene::LoadedScene loaded = scene::read_scene(input);
    apps::print_notes(apps::notes_of(loaded, input));
    loaded.scene.name = input;
    const gpu_scene::SceneFrame frame{scene::world_transforms(loaded.scene, arguments.start)};
    const gpu_scene::View view = gpu_scene::camera_view(loaded.scene, frame, arguments.camera, extent);
    const std::shared_ptr<Cache> cache = apps::cache_of(arguments.cache);
    render::Renderer renderer(device, loaded.scene, cache);
    render::RenderSettings render;
    static_cast<render::ToneChainSettings&>(render) = settings;
    apps::apply_settings(arguments.light, render);
    apps::give_indirect(renderer, render, loaded.scene, frame.world, scene::animated_nodes(loaded.scene), cache.get());
    render::Frame made = renderer.render(render, view, frame, 0, {.display = false, .scene = true});
    apps::print_cache_note(made.maps.note);
    StudyPicture picture{.name = {}, .extent = extent, .values = std::move(made.scene), .channels = 4};
    picture.vertical_fov = double(std::atan(view.tangent_high.y) - std::atan(view.tangent_low.y));
    picture.angles = gpu_scene::angles_of(view);
    return picture;
}

StudyPicture loaded(const PictureSource& arguments, const std::string& input) {
    io::HdrImage image = io::read_hdr_image(input, {}, arguments.layer);
    apps::PictureMeaning meaning = apps::meaning_of(
        image, {.scale = arguments.scale, .fov = arguments.fov, .angle_matters = arguments.angle_matters});
    if (!meaning.scale_note.empty()) meaning.notes.push_back(meaning.scale_note);
    for (const std::string& note : meaning.notes) apps::print_note(one_line(input) + ": " + note);
    return {.name = {},
            .extent = {image.width, image.height},
            .values = std::move(image.rgb),
            .channels = 3,
            .scale = float(meaning.scale),
            .vertical_fov = meaning.fov * std::numbers::pi / 180,
            .angles = meaning.angles,
            .is_absolute = meaning.fov_known && (meaning.scale_source == "option" || image.white_luminance > 0)};
}

/// Looks for the darkest and the brightest light, and notes pixels without any meaning.
void measure(StudyPicture& picture, const std::string& input) {
    picture.darkest = HUGE_VAL;
    uint64_t damaged = 0;  // pixels
    for (size_t i = 0; i < picture.values.size() / picture.channels; ++i) {
        const double l = picture.luminance(i);
        damaged += apps::is_damaged(l);
        if (!(l > 0) || !std::isfinite(l)) continue;
        picture.darkest = std::min(picture.darkest, l), picture.brightest = std::max(picture.brightest, l);
    }
    if (!(picture.brightest > 0)) throw Error(one_line(input) + ": there is no light in the picture");
    if (damaged > 0) apps::print_note(apps::damaged_text(input, damaged, "taken for no light"));
    picture.darkest = std::max({picture.darkest, 1e-4, picture.brightest * 1e-12});
    picture.brightest = std::max(picture.brightest, picture.darkest);
}

}  // namespace

double StudyPicture::luminance(size_t i) const {
    const float* rgb = &values[i * channels];
    return double(scale * (shared::kRed * rgb[0] + shared::kGreen * rgb[1] + shared::kBlue * rgb[2]));
}

// No frame follows another, luminance is not shown, and pictures have all their pixels.
void add_light_options(apps::Command command, apps::SettingArguments& light, std::string& cache) {
    apps::add_quality_option(command, light);
    apps::add_setting_options(command, light, {"display_average", "scale"});
    apps::add_cache_option(command, cache);
}

void add_source_options(apps::Command command, PictureSource& source) {
    command.add_option("--camera,-c", source.camera, "Of a scene: name of a camera (default: the first)");
    command.add_option("--size,-s", source.size, "Of a scene: WIDTHxHEIGHT, px").shows_default();
    command.add_option("--start", source.start, "Of a scene: its time, s")
        .check(apps::between(0.0, 1e6))
        .shows_default();
    add_light_options(command, source.light, source.cache);
    command.add_allow_outside();
    command.add_option("--layer", source.layer, apps::kLayerHelp);
    apps::add_scale_options(command, source.scale,
                            "cd/m^2 of a picture's 1.0; auto: as its header says, or, where it names no unit, as such "
                            "a scene may have; study fidelity needs a unit");
    command
        .add_option("--fov", source.fov,
                    "Angle a picture covers in height, degrees (default: what the picture says, if Vesper or Radiance "
                    "made it, or 40; study fidelity needs it)")
        .check(apps::between(0.1, 170.0));
}

void check_source(const PictureSource& source, std::span<const std::string> inputs) {
    if (std::ranges::any_of(inputs, [](const std::string& input) { return scene::is_scene_name(input); })) return;
    std::vector<std::string> options{"--camera", "--size", "--start", "--quality", "--cache"};
    for (const render::LightSetting* row : source.light.rows) options.push_back("--" + row->option());
    for (const std::string& option : options)
        if (source.light.command.count(option))
            throw Error(option + ": is of scenes, and " + one_line(inputs.front()) + " is a picture");
}

StudyPicture read_study_picture(const PictureSource& arguments, gpu::Device& device,
                                const render::ToneChainSettings& settings, const std::string& input) {
    StudyPicture picture =
        scene::is_scene_name(input) ? rendered(arguments, device, settings, input) : loaded(arguments, input);
    measure(picture, input);
    return picture;
}

}  // namespace vesper::commands
