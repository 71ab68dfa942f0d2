/** @file
 * C++17 for vesper.h and vision.h: owners of handles, and exceptions for results. SPDX-License-Identifier: MIT
 */
#ifndef VESPER_VESPER_HPP
#define VESPER_VESPER_HPP

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include <vesper/vesper.h>
#include <vesper/vision.h>

/** The C interface with owners and exceptions. */
namespace vesper::cpp {

/** A failed call. */
class Failure : public std::runtime_error {
public:
    /** `kind` is not VESPER_OK. */
    Failure(VesperResult kind, const std::string& message) : std::runtime_error(message), result(kind) {}
    VesperResult result; /**< kind of the failure */
};

/** Deleter of a handle. */
template <auto Destroy>
struct Destroyer {
    /** Destroys the object. */
    template <class T>
    void operator()(T* object) const {
        Destroy(object);
    }
};
using Device = std::unique_ptr<VesperDevice, Destroyer<vesper_device_close>>; /**< owner of a device */
using ToneMapper =
    std::unique_ptr<VesperToneMapper, Destroyer<vesper_tone_mapper_destroy>>;             /**< owner of a tone mapper */
using Scene = std::unique_ptr<VesperScene, Destroyer<vesper_scene_destroy>>;              /**< owner of a scene */
using Renderer = std::unique_ptr<VesperRenderer, Destroyer<vesper_renderer_destroy>>;     /**< owner of a renderer */
using SharedEye = std::unique_ptr<VesperSharedEye, Destroyer<vesper_shared_eye_destroy>>; /**< owner of a shared eye */
using Vision = std::unique_ptr<VesperVision, Destroyer<vesper_vision_destroy>>;           /**< owner of a vision */

/** Calls a function of vesper.h, without its last argument (the error). Throws Failure. Example:
 *     call(vesper_render, renderer.get(), &settings, &view, seconds, &outputs); */
template <class... Parameters, class... Arguments>
void call(VesperResult (*function)(Parameters...), Arguments&&... arguments) {
    VesperError error;
    const VesperResult result = function(std::forward<Arguments>(arguments)..., &error);
    if (result != VESPER_OK) throw Failure(result, error.message);
}

/** Makes an object by a function of vesper.h, without its last two arguments (object and error). Throws Failure.
 * Example:
 *     const auto device = make<Device>(vesper_device_open, nullptr); */
template <class Owner, class... Parameters, class... Arguments>
Owner make(VesperResult (*function)(Parameters...), Arguments&&... arguments) {
    typename Owner::pointer made = nullptr;
    call(function, std::forward<Arguments>(arguments)..., &made);
    return Owner(made);
}

/** A structure of vesper.h with its size set and all other fields zero. */
template <class T>
T sized() {
    return VESPER_INIT(T);
}

/** The settings of vesper_tone_settings_defaults. */
inline VesperToneSettings default_tone_settings() {
    VesperToneSettings made{};
    vesper_tone_settings_defaults(&made, sizeof made);
    return made;
}

}  // namespace vesper::cpp

#endif
