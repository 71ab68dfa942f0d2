#include "render/passes/composite.h"

#include "eye/encoding.h"
#include "shaders/composite/composite.comp.inc"
#include "shaders/composite/display_light.comp.inc"
#include "shaders/composite/shown_light.comp.inc"
#include "shared/gamut.h"
#include "shared/photometry.h"

namespace vesper::render {
namespace {

using graph::load, graph::sample, graph::store;

constexpr gpu::Shader kComposite{"composite.comp", composite_comp}, kShownLight{"shown_light.comp", shown_light_comp},
    kDisplayLight{"display_light.comp", display_light_comp};

struct Cones {
    glm::mat3 rows;       // of gamut.h, for colours of the display, and 1 to its white
    glm::vec3 luminance;  // of each primary, over that of white
};

Cones cones_of(const io::Primaries& primaries) {
    const glm::dmat3 to709 = io::to_rec709(primaries);
    const glm::dmat3 rows(shared::kOklabLong, shared::kOklabMiddle, shared::kOklabShort);
    glm::dmat3 own = glm::transpose(to709) * rows;  // columns are the rows for the display's colours
    for (int i = 0; i < 3; ++i) own[i] /= own[i].x + own[i].y + own[i].z;
    return {glm::mat3(own), glm::vec3(glm::transpose(to709) * glm::dvec3(shared::kRed, shared::kGreen, shared::kBlue))};
}

struct Shown {
    const gpu::Kernel& kernel;
    shared::CompositePush push;
    graph::Resource bloom;  // a binding that the kernel does not read still has to be bound: the scene stands in
    graph::Groups groups;
};

Shown show(const FrameContext& frame, const CompositeInputs& in, const CompositeSettings& settings,
           const gpu::Shader& shader, bool primaries, bool blue_first) {
    const uint32_t rows_of_one =
        frame.kernels.device().is_cpu() ? 4 : 1;  // pixels of a column that one invocation does
    const gpu::Kernel& kernel =
        frame.kernels.get(shader, {settings.tone, bool(in.bloom), rows_of_one, primaries, blue_first});
    const vision::Display& display = settings.display;
    const auto [width, height] = frame.view.extent;
    const glm::mat3 rows(glm::transpose(glm::inverse(io::to_rec709(display.primaries))));
    const Cones cones = cones_of(display.primaries);
    return {kernel,
            {{width, height},
             display.low(),
             display.high(),
             settings.bloom_gain,
             {},
             rows[0],
             rows[1],
             rows[2],
             cones.luminance,
             cones.rows[0],
             cones.rows[1],
             cones.rows[2]},
            in.bloom ? in.bloom : in.scene,
            graph::cover(width, height, kernel.group[0], kernel.group[1] * rows_of_one)};
}

// Light, and not codes.
graph::Resource add_light(const FrameContext& frame, const CompositeInputs& in, const Shown& shown, const char* name,
                          VkFormat format) {
    const graph::Resource image = frame.graph.transient(name, graph::image_shape(format, frame.view.extent));
    frame.graph.dispatch(name, shown.kernel, {load(in.scene), sample(in.curve), sample(shown.bloom), store(image)},
                         shown.push, shown.groups);
    return image;
}

}  // namespace

graph::Resource add_composite(const FrameContext& frame, const CompositeInputs& in, const CompositeSettings& settings) {
    Shown shown = show(frame, in, settings, kComposite, settings.display.primaries != io::kRec709, settings.blue_first);
    const eye::Encoding encoding = eye::make_encoding(settings.display);
    shown.push.encode = encoding.push;
    const graph::Resource cells = frame.graph.upload("code cells", encoding.cells, VK_FORMAT_R32G32B32A32_SFLOAT);
    const graph::Resource image =
        frame.graph.transient("display", graph::image_shape(kDisplayFormat, frame.view.extent));
    frame.graph.dispatch("composite", shown.kernel,
                         {load(in.scene), sample(in.curve), sample(shown.bloom), sample(cells), store(image)},
                         shown.push, shown.groups);
    return image;
}

graph::Resource add_shown_light(const FrameContext& frame, const CompositeInputs& in,
                                const CompositeSettings& settings) {
    const bool primaries = settings.display.primaries != io::kRec709;
    return add_light(frame, in, show(frame, in, settings, kShownLight, primaries, false), "shown light",
                     kShownLightFormat);
}

graph::Resource add_display_light(const FrameContext& frame, const CompositeInputs& in,
                                  const CompositeSettings& settings, bool wanted) {
    if (!wanted) return {};
    return add_light(frame, in, show(frame, in, settings, kDisplayLight, false, false), "display light",
                     kDisplayLightFormat);
}

}  // namespace vesper::render
