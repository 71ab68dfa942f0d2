// The C interface: include/vesper/vesper.h over Device, ToneMapper and Renderer. SPDX-License-Identifier: MIT
#include <vesper/vesper.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <map>
#include <memory>
#include <new>

#include <glm/gtc/matrix_access.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "base/luminance.h"
#include "renderer.h"
#include "scene/display_file.h"
#include "scene/gltf.h"
#include "tone_mapper.h"

using namespace vesper;

struct VesperDevice {
    explicit VesperDevice(const DeviceOptions& options) : device(options) {}
    Device device;
    std::string name;
};

struct VesperToneMapper {
    explicit VesperToneMapper(Device& device) : mapper(device) {}
    ToneMapper mapper;
    shared::EyeState eye{};
};

struct VesperScene {
    Scene scene;
};

struct VesperRenderer {
    VesperRenderer(Device& device, const Scene& drawn) : scene(drawn), renderer(device, drawn) {}
    const Scene& scene;
    Renderer renderer;
    std::map<uint32_t, glm::mat4> places;  // of nodes that were put somewhere: node frame to world
};

namespace {

/// Thrown for what only a caller can get wrong.
struct BadArgument {
    const char* what;
};

void say(VesperError* error, const char* message) {
    if (!error) return;
    std::strncpy(error->message, message, sizeof error->message - 1);
    error->message[sizeof error->message - 1] = 0;
}

/// Runs a call, and turns what it throws into its result.
template <class Call>
VesperResult guarded(VesperError* error, const Call& call) noexcept {
    say(error, "");
    try {
        call();
        return VESPER_OK;
    } catch (const BadArgument& bad) {
        say(error, bad.what);
        return VESPER_BAD_ARGUMENT;
    } catch (const std::bad_alloc&) {
        say(error, "out of memory");
        return VESPER_OUT_OF_MEMORY;
    } catch (const std::exception& failure) {
        say(error, failure.what());
        return VESPER_FAILED;
    } catch (...) {
        say(error, "an unknown error");
        return VESPER_FAILED;
    }
}

void require(bool holds, const char* otherwise) {
    if (!holds) throw BadArgument{otherwise};
}

/// A structure as this library has it. All of them are as in the first version, so none may be smaller; a newer caller's may be larger.
template <class T>
T known(const T* given, const char* otherwise) {
    require(given && given->size >= sizeof(T) && given->size <= 65536, otherwise);
    return *given;
}

constexpr uint32_t kMostPixels = 16384;  // in width or height

VkExtent2D extent_of(uint32_t width, uint32_t height) {
    require(width > 0 && height > 0 && width <= kMostPixels && height <= kMostPixels, "an image is 1 to 16384 pixels wide and high");
    return {width, height};
}

VesperToneSettings default_settings() {
    const ToneChainSettings settings;
    const ScatteringEye eye;
    VesperToneSettings made{sizeof made};
    made.tone_operator = VESPER_IRAWAN, made.glare = VESPER_GLARE_NONE, made.bins = settings.histogram.bins;
    made.age = float(settings.tone.observer.age), made.pigmentation = float(eye.pigmentation);
    made.gaze[0] = settings.tone.gaze.x, made.gaze[1] = settings.tone.gaze.y;
    const Display& display = known_displays().front().display;
    made.display_peak = display.peak, made.display_black = display.black, made.display_ambient = display.ambient;
    return made;
}

RenderSettings settings_of(const VesperToneSettings* given) {
    const VesperToneSettings s = given ? known(given, "tone settings without their size") : default_settings();
    const auto is_operator = [&](const OperatorInfo& info) { return info.tone_operator != Operator::Ldr && uint32_t(info.tone_operator) == s.tone_operator; };
    require(std::any_of(operators().begin(), operators().end(), is_operator), "there is no such tone operator");
    require(s.glare <= VESPER_GLARE_LDR, "there is no such glare");
    require(s.bins >= 1 && s.bins <= shared::kMaxBins, "a histogram has 1 to 256 bins");
    require(s.age >= 1 && s.age <= 120 && s.pigmentation >= 0 && s.pigmentation <= 1.5f, "an observer is 1 to 120 years old, with a pigmentation of 0 to 1.5");
    require(s.gaze[0] >= 0 && s.gaze[0] <= 1 && s.gaze[1] >= 0 && s.gaze[1] <= 1, "the gaze is a part of the image, 0 to 1");
    RenderSettings settings;
    settings.tone_operator = Operator(s.tone_operator);
    settings.glare = s.glare == VESPER_GLARE_CIE ? Glare::Scatter : s.glare == VESPER_GLARE_LDR ? Glare::Ldr : Glare::None;
    settings.scatter.eye = {double(s.age), double(s.pigmentation)};
    settings.histogram.bins = s.bins;
    settings.tone.observer.age = s.age;
    settings.tone.gaze = {s.gaze[0], s.gaze[1]};
    settings.tone.colour_loss = s.colour_loss, settings.tone.acuity_loss = s.acuity_loss, settings.tone.purkinje = s.purkinje;
    if (s.display) {
        settings.display = find_display(s.display);
    } else {
        settings.display = known_displays().front().display;
        settings.display.peak = s.display_peak, settings.display.black = s.display_black, settings.display.ambient = s.display_ambient;
    }
    check_display(settings.display);
    return settings;
}

Outputs wanted(const VesperOutputs& to) { return {.display = to.codes != nullptr, .scene = to.luminance != nullptr, .light = to.display_light != nullptr}; }

template <class T>
void give(const std::vector<T>& values, T* to) {
    if (to) std::copy(values.begin(), values.end(), to);
}

void give(const ToneMapped& frame, const VesperOutputs& to) {
    give(frame.display, to.codes), give(frame.scene, to.luminance), give(frame.light, to.display_light);
    if (!to.report) return;
    VesperFrameReport report{sizeof report};
    report.adaptation = frame.curve.adaptation, report.log_average = frame.curve.log_average;
    report.not_finite = frame.histogram.non_finite;
    report.milliseconds = frame.milliseconds;
    *to.report = report;
}

VesperOutputs outputs_of(const VesperOutputs* given) {
    const VesperOutputs to = known(given, "outputs without their size");
    require(!to.report || to.report->size >= sizeof(VesperFrameReport), "a report without its size");
    return to;
}

glm::vec3 vector(const float v[3]) { return {v[0], v[1], v[2]}; }

template <size_t n>
bool finite(const float (&values)[n]) {
    return std::all_of(values, values + n, [](float v) { return std::isfinite(v); });
}

// Everything where it stands at a time, but for what was put elsewhere, and what hangs on that.
SceneFrame frame_of(const Scene& scene, double seconds, const std::map<uint32_t, glm::mat4>& places) {
    SceneFrame frame{world_transforms(scene, seconds)};
    std::vector<glm::mat4> moved(places.empty() ? 0 : scene.nodes.size(), glm::mat4(1));
    for (uint32_t i = 0; i < moved.size(); ++i) {
        if (scene.nodes[i].parent != kNone) moved[i] = moved[scene.nodes[i].parent];
        if (const auto place = places.find(i); place != places.end()) moved[i] = place->second * glm::inverse(frame.world[i]);
        frame.world[i] = moved[i] * frame.world[i];
    }
    return frame;
}

View view_of(const VesperView& v, const Scene& scene, const SceneFrame& frame) {
    const VkExtent2D extent = extent_of(v.width, v.height);
    if (v.camera) return camera_view(scene, frame, v.camera, extent);
    require(finite(v.eye) && finite(v.forward) && finite(v.up) && v.vertical_fov > 0 && v.vertical_fov < 3.1f && v.near_plane > 0 && v.near_plane < 1e6f,
            "a view has an eye, a vertical angle of 0 to 3.1 rad and a near plane beyond 0 m");
    const glm::vec3 forward = vector(v.forward), side = glm::cross(forward, vector(v.up));
    require(glm::length(side) > 1e-6f * glm::length(forward) * glm::length(vector(v.up)), "a view's forward and up are two directions");
    return View::symmetric(extent, v.vertical_fov, glm::lookAt(vector(v.eye), vector(v.eye) + glm::normalize(forward), glm::normalize(vector(v.up))), v.near_plane);
}

}  // namespace

void vesper_version(uint32_t version[3]) {
    unsigned parts[3]{};
    std::sscanf(VESPER_VERSION, "%u.%u.%u", &parts[0], &parts[1], &parts[2]);
    std::copy(parts, parts + 3, version);
}

VesperResult vesper_device_open(const VesperDeviceOptions* options, VesperDevice** device, VesperError* error) {
    return guarded(error, [&] {
        require(device, "no place for the device");
        const VesperDeviceOptions o = options ? known(options, "device options without their size") : VesperDeviceOptions{};
        DeviceOptions opened{.select = o.select ? o.select : "", .validation = o.validation != 0, .on_message = {}};
        if (o.on_message) opened.on_message = [call = o.on_message, user = o.user](const std::string& message) { call(message.c_str(), user); };
        std::unique_ptr<VesperDevice> made(new VesperDevice(opened));
        made->name = made->device.name();
        *device = made.release();
    });
}
void vesper_device_close(VesperDevice* device) { delete device; }
const char* vesper_device_name(const VesperDevice* device) { return device ? device->name.c_str() : ""; }

void vesper_tone_settings_defaults(VesperToneSettings* settings) {
    if (settings) *settings = default_settings();
}

VesperResult vesper_tone_mapper_create(VesperDevice* device, VesperToneMapper** mapper, VesperError* error) {
    return guarded(error, [&] {
        require(device && mapper, "no device, or no place for the tone mapper");
        *mapper = new VesperToneMapper(device->device);
    });
}
void vesper_tone_mapper_destroy(VesperToneMapper* mapper) { delete mapper; }
void vesper_tone_mapper_reset(VesperToneMapper* mapper) {
    if (mapper) mapper->mapper.reset_adaptation(), mapper->eye = {};
}

VesperResult vesper_tone_map(VesperToneMapper* mapper, const VesperToneSettings* settings, const VesperPicture* picture, float seconds, const VesperOutputs* outputs,
                             VesperError* error) {
    return guarded(error, [&] {
        require(mapper, "no tone mapper");
        require(seconds >= 0 && seconds <= 1e6f, "time passes by 0 to 1e6 s");
        const VesperPicture p = known(picture, "a picture without its size");
        const VesperOutputs to = outputs_of(outputs);
        const VkExtent2D extent = extent_of(p.width, p.height);
        require(p.values && (p.channels == 3 || p.channels == 4), "a picture has values, of 3 or 4 channels");
        require(p.scale > 0 && std::isfinite(p.scale), "the scale of a picture is more than 0 cd/m^2");
        require(p.vertical_fov > 0 && p.vertical_fov < 3.1f, "a picture covers 0 to 3.1 rad in height");
        const HostPicture host{.extent = extent, .values = {p.values, size_t{p.width} * p.height * p.channels}, .channels = p.channels, .scale = p.scale, .vertical_fov = double(p.vertical_fov)};
        const ToneMapped shown = mapper->mapper.map(settings_of(settings), host, seconds, wanted(to));
        mapper->eye = shown.eye;
        give(shown, to);
    });
}

size_t vesper_eye_size() { return sizeof(shared::EyeState); }

VesperResult vesper_tone_mapper_eye(const VesperToneMapper* mapper, void* bytes, VesperError* error) {
    return guarded(error, [&] {
        require(mapper && bytes, "no tone mapper, or no place for what its eye remembers");
        std::memcpy(bytes, &mapper->eye, sizeof mapper->eye);
    });
}

VesperResult vesper_tone_mapper_set_eye(VesperToneMapper* mapper, const void* bytes, size_t size, VesperError* error) {
    return guarded(error, [&] {
        require(mapper && bytes, "no tone mapper, or nothing to remember");
        require(size == sizeof(shared::EyeState), "what an eye of another version remembers");
        float values[sizeof(shared::EyeState) / sizeof(float)];
        std::memcpy(values, bytes, size);
        require(std::all_of(std::begin(values), std::end(values), [](float v) { return std::abs(v) <= 1e9f; }), "no eye remembers that");
        std::memcpy(&mapper->eye, bytes, size);
        mapper->mapper.set_eye(mapper->eye);
    });
}

VesperResult vesper_scene_read(const char* file, VesperScene** scene, VesperError* error) {
    return guarded(error, [&] {
        require(file && scene, "no file, or no place for the scene");
        *scene = new VesperScene{read_gltf(file).scene};
    });
}
void vesper_scene_destroy(VesperScene* scene) { delete scene; }
uint32_t vesper_scene_node_count(const VesperScene* scene) { return scene ? uint32_t(scene->scene.nodes.size()) : 0; }
const char* vesper_scene_node_name(const VesperScene* scene, uint32_t node) {
    return scene && node < scene->scene.nodes.size() ? scene->scene.nodes[node].name.c_str() : nullptr;
}

VesperResult vesper_scene_add_lamp(VesperScene* scene, const VesperLamp* lamp, uint32_t* node, VesperError* error) {
    return guarded(error, [&] {
        require(scene, "no scene");
        const VesperLamp l = known(lamp, "a lamp without its size");
        const glm::vec3 colour = vector(l.colour), axis = vector(l.axis);
        require(finite(l.position) && finite(l.axis) && finite(l.colour) && l.intensity >= 0 && std::isfinite(l.intensity), "a lamp has a place, an axis, at least 0 cd and a colour");
        require(glm::all(glm::greaterThanEqual(colour, glm::vec3(0))) && luminance(colour) > 0, "a lamp's colour has luminance and no negative part");
        require(l.inner_cone >= 0 && l.outer_cone >= l.inner_cone && l.outer_cone <= 1.5707964f, "a lamp's cones are 0 <= inner <= outer <= pi / 2");
        Light light;
        light.kind = l.outer_cone > 0 ? Light::Kind::Spot : Light::Kind::Point;
        light.intensity = l.intensity, light.colour = colour / float(luminance(colour));
        light.inner_cone = l.inner_cone, light.outer_cone = l.outer_cone;
        Node placed;
        placed.name = "lamp", placed.light = uint32_t(scene->scene.lights.size());
        placed.translation = vector(l.position);
        if (light.kind == Light::Kind::Spot) {
            require(glm::length(axis) > 1e-6f, "a lamp's axis has a direction");
            placed.rotation = glm::quat(glm::vec3(0, 0, -1), glm::normalize(axis));
        }
        scene->scene.nodes.reserve(scene->scene.nodes.size() + 1);
        scene->scene.lights.push_back(light);
        scene->scene.nodes.push_back(placed);
        if (node) *node = uint32_t(scene->scene.nodes.size() - 1);
    });
}

VesperResult vesper_renderer_create(VesperDevice* device, const VesperScene* scene, VesperRenderer** renderer, VesperError* error) {
    return guarded(error, [&] {
        require(device && scene && renderer, "no device, no scene, or no place for the renderer");
        *renderer = new VesperRenderer(device->device, scene->scene);
    });
}
void vesper_renderer_destroy(VesperRenderer* renderer) { delete renderer; }
void vesper_renderer_reset(VesperRenderer* renderer) {
    if (renderer) renderer->renderer.reset_adaptation();
}

VesperResult vesper_renderer_place(VesperRenderer* renderer, uint32_t node, const float node_to_world[16], VesperError* error) {
    return guarded(error, [&] {
        require(renderer && node_to_world, "no renderer, or no place");
        require(node < renderer->scene.nodes.size(), "the scene has no such node");
        const glm::mat4 place = glm::make_mat4(node_to_world);
        const float size = std::abs(glm::determinant(place));
        require(std::isnormal(size) && glm::row(place, 3) == glm::vec4(0, 0, 0, 1), "a place is an affine matrix that can be inverted, column by column");
        renderer->places[node] = place;
    });
}

VesperResult vesper_render(VesperRenderer* renderer, const VesperToneSettings* settings, const VesperView* view, float seconds, const VesperOutputs* outputs, VesperError* error) {
    return guarded(error, [&] {
        require(renderer, "no renderer");
        require(seconds >= 0 && seconds <= 1e6f, "time passes by 0 to 1e6 s");
        const VesperView v = known(view, "a view without its size");
        const VesperOutputs to = outputs_of(outputs);
        require(v.scene_seconds >= 0 && v.scene_seconds <= 1e9, "the scene's time is 0 to 1e9 s");
        const SceneFrame frame = frame_of(renderer->scene, v.scene_seconds, renderer->places);
        give(renderer->renderer.render(settings_of(settings), view_of(v, renderer->scene, frame), frame, seconds, wanted(to)), to);
    });
}
