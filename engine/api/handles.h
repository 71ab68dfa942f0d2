// Behind the handles of vesper.h, and what every call does: arguments checked, exceptions turned into results. SPDX-License-Identifier: MIT
#pragma once

#include <vesper/vulkan.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>

#include "renderer.h"
#include "tone_mapper.h"

struct VesperDevice {
    explicit VesperDevice(const vesper::DeviceOptions& options) : device(options), name(device.name()) {}
    explicit VesperDevice(const vesper::BorrowedDevice& given) : device(given), name(device.name()) {}
    vesper::Device device;
    std::string name;
};

struct VesperToneMapper {
    static constexpr const char* kNone = "no tone mapper";
    explicit VesperToneMapper(vesper::Device& device) : engine(device) {}
    vesper::ToneMapper engine;
    vesper::shared::EyeState eye{};  // what the last picture left
};

struct VesperScene {
    vesper::Scene scene;
    uint64_t version = 0;                           // of what a renderer takes to the device
    std::map<std::string, uint32_t> distributions;  // of the scene, by their files
};

struct VesperRenderer {
    static constexpr const char* kNone = "no renderer";
    VesperRenderer(vesper::Device& device, const VesperScene& drawn) : scene(drawn), version(drawn.version), engine(device, drawn.scene) {}
    const VesperScene& scene;
    uint64_t version;  // of the scene on the device
    vesper::Renderer engine;
    std::map<uint32_t, glm::mat4> places;  // of nodes that were put somewhere: node frame to world
    std::map<uint32_t, float> dimming;     // of lamps at nodes
    vesper::shared::EyeState eye{};        // what the last frame left
};

namespace vesper::api {

/// Thrown for what only a caller can get wrong.
struct BadArgument {
    const char* what;
};

inline void require(bool holds, const char* otherwise) {
    if (!holds) throw BadArgument{otherwise};
}

/// Runs a call that makes its outputs last, and turns what it throws into its result.
VesperResult result_of(VesperError* error, void (*call)(const void*), const void* what) noexcept;
template <class Call>
VesperResult guarded(VesperError* error, const Call& call) noexcept {
    return result_of(error, [](const void* it) { (*static_cast<const Call*>(it))(); }, &call);
}

/// A structure as this library has it. All of them are as in the first version, so none may be smaller; a newer caller's may be larger.
template <class T>
T known(const T* given, const char* otherwise) {
    require(given && given->size >= sizeof(T) && given->size <= 65536, otherwise);
    return *given;
}

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
float seconds_of(float seconds);
RenderSettings settings_of(const VesperToneSettings* given);  ///< null: the defaults

/// Where a frame goes, in arrays.
VesperOutputs outputs_of(const VesperOutputs* given);
Outputs wanted(const VesperOutputs& to);
void give(const ToneMapped& frame, const VesperOutputs& to);
/// A report that may be asked for, checked; what a frame brought is written to it, or zero.
void check_report(const VesperFrameReport* report);
void give(const ToneMapped* frame, VesperFrameReport* report);

/// What the eye remembers, as bytes.
void give_eye(const shared::EyeState& eye, void* bytes);
shared::EyeState eye_of(const void* bytes, size_t size);

/// What the last frame of a tone mapper or renderer left; nothing where it is known already.
template <class Handle>
auto finish(Handle& handle) {
    auto frame = handle.engine.finish();
    if (frame) handle.eye = frame->eye;
    return frame;
}
/// Before a frame that is handed over: where its settings wait for the one before, what that left stays known should this one fail.
template <class Handle>
void look_back(Handle& handle, const ToneChainSettings& settings) {
    if (EyeKeeper::looks_back(settings)) finish(handle);
}
template <class Handle>
VesperResult finish(Handle* handle, VesperFrameReport* report, VesperError* error) {
    return guarded(error, [&] {
        require(handle, Handle::kNone);
        check_report(report);
        const auto frame = finish(*handle);
        give(frame ? &*frame : nullptr, report);
    });
}

/// The eye of a tone mapper or renderer: forgotten, read, replaced.
template <class Handle>
VesperResult reset_eye(Handle* handle, VesperError* error) {
    return guarded(error, [&] {
        require(handle, Handle::kNone);
        handle->engine.finish();
        handle->engine.reset_adaptation();
        handle->eye = {};
    });
}
template <class Handle>
VesperResult read_eye(Handle* handle, void* bytes, VesperError* error) {
    return guarded(error, [&] {
        require(handle, Handle::kNone);
        require(bytes, "no place for what the eye remembers");
        finish(*handle);
        give_eye(handle->eye, bytes);
    });
}
template <class Handle>
VesperResult set_eye(Handle* handle, const void* bytes, size_t size, VesperError* error) {
    return guarded(error, [&] {
        require(handle, Handle::kNone);
        require(bytes, "nothing to remember");
        const shared::EyeState eye = eye_of(bytes, size);
        handle->engine.finish();
        handle->eye = eye;
        handle->engine.set_eye(eye);
    });
}

/// Images of the host's.
ForeignImage picture_image(const VesperImage* given);
ForeignImage shown_image(const VesperImage* given, VkExtent2D extent);
Handover handover_of(const VesperHandover* given);

}  // namespace vesper::api
