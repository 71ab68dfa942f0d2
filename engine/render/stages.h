// The five stages of a frame: light -> retina -> statistics -> adapt -> show. SPDX-License-Identifier: MIT
// A stage declares passes; what it hands on stays on the device. Light is what declare() renders, or a picture of other
// origin; adapt is add_adaptation (render/passes/adapt.h). The stages of a frame may be in one graph, as add_tone_chain
// declares them, or in several, with pictures kept in between (render/stored_picture.h), as a SharedEye runs them.
#pragma once

#include <optional>

#include "eye/corona.h"
#include "eye/projection.h"
#include "render/passes/adapt.h"
#include "render/passes/bloom.h"
#include "render/passes/eye_scatter.h"

namespace vesper::render {

enum class Glare : uint8_t { None, Ldr, Scatter };

/// Everything between the luminance of a frame and its display codes.
struct ToneChainSettings {
    Operator tone_operator = Operator::Irawan;
    HistogramSettings histogram;
    std::optional<uint32_t> foveal_level;  ///< pyramid level of the histogram; default: 1 degree per texel
    ToneSettings tone;
    vision::Display display;
    Glare glare = Glare::None;
    BloomSettings bloom;
    /// Of Glare::Scatter: light scattered in the eye, in cd/m^2. The eye is of the observer's age.
    eye::ScatterSettings scatter{.eye = {.age = vision::Observer{}.age}};
};

/// Retina: the light, rgba32f, cd/m^2 RGB, as the eye scatters it: with needles and halo of bright lamps where there is
/// a corona, which needs a fit of the scatter. Without either returns `light`.
graph::Resource add_retina(const FrameContext& frame, graph::Resource light, const ScatterInputs& scatter,
                           const eye::Corona* corona);

/// Statistics: what an eye adapts to.
struct Statistics {
    Pyramid luminance;          ///< of the retina
    FovealView fovea{};         ///< the level that has a texel for each degree
    glm::vec2 gaze{0};          ///< where the eye looks, texels of that level from its top left
    graph::Resource histogram;  ///< shared::Histogram
    Colours colours;            ///< of operators that adapt to colour
};
/// Of what falls on the retina, as `frame.view` sees it.
Statistics add_statistics(const FrameContext& frame, graph::Resource retina, const ToneChainSettings& settings);

/// An eye that adapts to one picture (add_adaptation).
Adaptation add_adaptation_to(const FrameContext& frame, const Statistics& statistics, const ToneChainSettings& settings,
                             const EyeState& eye, float seconds);

/// Where codes go.
struct ShowOutputs {
    bool display_light = false;  ///< Shown::display_light
    /// An external image that gets the codes, too, in the order and with the bits of its format (shown_format).
    std::optional<graph::ExternalImage> image = {};
    /// If not null: all codes are of the picture of a projector, with its extent. It is read while the frame is
    /// declared. Its rendered picture must be of the frame's extent.
    const eye::Projection* projection = nullptr;
};
struct Shown {
    graph::Resource codes;          ///< a word a pixel
    graph::Resource display_light;  ///< rgba32f, cd/m^2 RGB, without the display's limits; if it is wanted
};
/// Show: the retina's light as codes of the display, by a curve (shared::ToneCurve).
Shown add_show(const FrameContext& frame, graph::Resource retina, const Statistics& statistics, graph::Resource curve,
               const ToneChainSettings& settings, const ShowOutputs& outputs);

/// How codes lie in an image of a format.
struct ShownFormat {
    uint32_t bits;    ///< of a channel, 8 or 10
    bool blue_first;  ///< blue in the lowest bits of a word
};
/// Of formats that codes can be copied to as they are: RGBA and BGRA of 8 bits, UNORM or SRGB, and of 10 bits. Nothing
/// for others.
std::optional<ShownFormat> shown_format(VkFormat);

}  // namespace vesper::render
