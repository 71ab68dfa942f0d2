// Behind the handles of vesper.h, and what every call does: arguments checked, exceptions turned into results.
// SPDX-License-Identifier: MIT
#pragma once

#include <vesper/vulkan.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "base/error.h"
#include "render/renderer.h"
#include "render/settings.h"
#include "render/tone_mapper.h"
#include "scene/display_file.h"
#include "scene/scene.h"

struct VesperDevice {
    explicit VesperDevice(const vesper::gpu::DeviceOptions& options) : device(options), name(device.name()) {}
    explicit VesperDevice(const vesper::gpu::BorrowedDevice& given) : device(given), name(device.name()) {}
    vesper::gpu::Device device;
    std::string name;
};

struct VesperToneMapper {
    static constexpr const char* kNone = "no tone mapper";
    explicit VesperToneMapper(vesper::gpu::Device& of) : device(of), engine(of) {}
    const vesper::gpu::Device& device;
    vesper::render::ToneMapper engine;
    vesper::scene::DisplayFinder displays;
    std::optional<VesperFrameReport> report;  // of the last submitted frame that was finished, until it is asked for
};

struct VesperScene {
    vesper::scene::Scene scene;
    uint64_t version = 0;  // of what a renderer takes to the device
    std::map<std::pair<std::string, std::vector<uint8_t>>, uint32_t>
        distributions;       // of the scene, by their files and what was in those
    std::vector<bool> gone;  // by node; shorter than those, or of as many
};

struct VesperRenderer {
    static constexpr const char* kNone = "no renderer";
    VesperRenderer(vesper::gpu::Device& of, const VesperScene& drawn)
        : device(of), scene(drawn), version(drawn.version), engine(of, drawn.scene) {}
    const vesper::gpu::Device& device;
    const VesperScene& scene;
    uint64_t version;  // of the scene on the device
    vesper::render::Renderer engine;
    vesper::scene::DisplayFinder displays;
    std::map<uint32_t, glm::mat4> places;         // of nodes that were put somewhere: node frame to world
    std::map<uint32_t, float> dimming;            // of lamps and meshes at nodes
    std::optional<std::vector<bool>> reflecting;  // nodes that move, for which the engine has reflections of lamps
    std::shared_ptr<vesper::Cache> cache;         // of what is kept for later runs
    vesper::render::ChosenSettings chosen;        // of its light
    std::optional<VesperFrameReport> report;  // of the last submitted frame that was finished, until it is asked for
};

namespace vesper::api {

/// Why a call that shows nothing, or hands nothing back, refuses the setting.
constexpr const char* kDisplayAverage = "display-average is for pictures of vesper_render";

/// Thrown for what only a caller can get wrong.
struct BadArgument {
    std::string what;
};

inline void require(bool holds, const char* otherwise) {
    if (!holds) throw BadArgument{otherwise};
}

/// The result of a call that reads settings: an Error there is a mistake of the caller.
template <class Call>
decltype(auto) accepted(const Call& call) {
    try {
        return call();
    } catch (const Error& refused) {
        throw BadArgument{refused.what()};
    }
}

/// Runs a call that makes its outputs last, and turns what it throws into its result.
VesperResult result_of(VesperError* error, void (*call)(const void*), const void* what) noexcept;
template <class Call>
VesperResult guarded(VesperError* error, const Call& call) noexcept {
    return result_of(
        error, [](const void* it) { (*static_cast<const Call*>(it))(); }, &call);
}

/// What a structure was in the first version that had it: to be pinned where a field is added (handles.cpp checks).
template <class T>
constexpr size_t kFirstSize = sizeof(T);
template <>
inline constexpr size_t kFirstSize<VesperToneSettings> = offsetof(VesperToneSettings, options);
template <>
inline constexpr size_t kFirstSize<VesperSetting> = offsetof(VesperSetting, interactive);

/// Copies a caller's structure. Fields that an older caller lacks are zero; fields that only a newer caller has are
/// ignored.
template <class T>
T known(const T* given, const char* otherwise) {
    require(given && given->size >= kFirstSize<T> && given->size <= 65536, otherwise);
    T made{};
    std::memcpy(&made, given, std::min(size_t{given->size}, sizeof made));
    return made;
}
/// As much of a structure as the caller's has room for; its size is what it is then.
template <class T>
void give_known(T made, T* to) {
    made.size = uint32_t(std::min(size_t{to->size}, sizeof made));
    std::memcpy(to, &made, made.size);
}

/// Copies values to where a caller wants them; null: nowhere.
template <class T>
void give(const std::vector<T>& values, T* to) {
    if (to) std::copy(values.begin(), values.end(), to);
}

inline bool within(float value, float low, float high) { return value >= low && value <= high; }
template <size_t n>
bool finite(const float (&values)[n]) {
    return std::all_of(values, values + n, [](float v) { return std::isfinite(v); });
}
inline glm::vec3 vector(const float v[3]) { return {v[0], v[1], v[2]}; }
/// The direction of a vector of any length but zero. In double, where no square of a float is too large or too small.
inline glm::dvec3 direction(const float v[3], const char* otherwise) {
    const glm::dvec3 d(vector(v));
    require(d != glm::dvec3(0), otherwise);
    return glm::normalize(d);
}
/// 16 values, column by column. Throws BadArgument unless they are affine and can be inverted.
glm::mat4 place_of(const float* node_to_world);

VkExtent2D extent_of(uint32_t width, uint32_t height);
/// The edges of a picture that has any.
std::optional<vision::ImageAngles> angles_of(const float (&edges)[4], VkExtent2D extent);
/// A picture of the caller's in an array, checked. `angles` holds those of its edges, which the result refers to.
render::HostPicture picture_of(const VesperPicture* given, std::optional<vision::ImageAngles>& angles);
float seconds_of(float seconds);
render::RenderSettings settings_of(const VesperToneSettings* given,
                                   scene::DisplayFinder& displays);  ///< null: the defaults

/// Where a frame goes, in arrays.
VesperOutputs outputs_of(const VesperOutputs* given);
render::Outputs wanted(const VesperOutputs& to);
void give(const render::ToneMapped& frame, const VesperOutputs& to);
/// A report that may be asked for, checked; that of a frame in arrays, and that of a submitted frame.
void check_report(const VesperFrameReport* report);
VesperFrameReport report_of(const render::ToneMapped& frame);
VesperFrameReport report_of_submitted(const render::ToneMapped& frame);

/// What the eye remembers, as bytes.
void give_eye(const shared::EyeState& eye, void* bytes);
shared::EyeState eye_of(const void* bytes, size_t size);

/// Waits for the submitted frames of a tone mapper or renderer. The report of the last one stays known, whatever comes
/// of the call that waits.
template <class Handle>
void finish(Handle& handle) {
    const auto frame = handle.engine.finish();
    if (frame) handle.report = report_of_submitted(*frame);
}
constexpr const char* kBorrowed = "images are those of a host's device (vesper_device_borrow)";
/// Submits a frame. Where its settings need the frame before on the host, that one is finished first.
template <class Handle, class... Arguments>
void submit_frame(Handle& handle, const render::RenderSettings& settings, const Arguments&... arguments) {
    require(handle.device.borrowed(), kBorrowed);
    if (render::FrameQueue::needs_finished_frame(settings)) finish(handle);
    handle.engine.submit(settings, arguments...);
    handle.report.reset();
}
template <class Handle>
VesperResult finish(Handle* handle, VesperFrameReport* report, VesperError* error) {
    return guarded(error, [&] {
        require(handle, Handle::kNone);
        check_report(report);
        finish(*handle);
        if (report) give_known(handle->report.value_or(VesperFrameReport{}), report);
        handle->report.reset();
    });
}

/// The eye of a tone mapper or renderer: forgotten, read, replaced.
template <class Handle>
VesperResult reset_eye(Handle* handle, VesperError* error) {
    return guarded(error, [&] {
        require(handle, Handle::kNone);
        finish(*handle);
        handle->engine.reset_adaptation();
    });
}
template <class Handle>
VesperResult read_eye(Handle* handle, void* bytes, VesperError* error) {
    return guarded(error, [&] {
        require(handle, Handle::kNone);
        require(bytes, "the pointer to the state of the eye is null");
        finish(*handle);
        give_eye(handle->engine.eye(), bytes);
    });
}
template <class Handle>
VesperResult set_eye(Handle* handle, const void* bytes, size_t size, VesperError* error) {
    return guarded(error, [&] {
        require(handle, Handle::kNone);
        require(bytes, "the pointer to the state of the eye is null");
        const shared::EyeState eye = eye_of(bytes, size);
        finish(*handle);
        handle->engine.set_eye(eye);
    });
}

/// A frame of a renderer with all that changed in its scene, waited for. A call that is refused changes nothing.
render::Frame render_frame(VesperRenderer& renderer, const VesperToneSettings* settings, const VesperView* view,
                           float seconds, const render::Outputs& outputs);

/// Images of the host's.
graph::ExternalImage picture_image(const VesperImage* given);
graph::ExternalImage shown_image(const VesperImage* given, VkExtent2D extent);
graph::SubmitSemaphores semaphores_of(const VesperHandover* given);

}  // namespace vesper::api
