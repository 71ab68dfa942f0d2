#include "render/passes/passes.h"
#include "gpu_scene/encoding.h"
#include "shared/gamut.h"
#include "shared/photometry.h"

namespace vesper {
namespace {

struct Cones {
    glm::mat3 rows;       // of gamut.h, for colours of the display, and 1 to its white
    glm::vec3 luminance;  // of each primary, over that of white
};

Cones cones_of(const Primaries& primaries) {
    const glm::dmat3 to709 = to_rec709(primaries);
    const glm::dmat3 rows(shared::kOklabLong, shared::kOklabMiddle, shared::kOklabShort);
    glm::dmat3 own = glm::transpose(to709) * rows;  // columns are the rows for the display's colours
    for (int i = 0; i < 3; ++i) own[i] /= own[i].x + own[i].y + own[i].z;
    return {glm::mat3(own), glm::vec3(glm::transpose(to709) * glm::dvec3(shared::kRed, shared::kGreen, shared::kBlue))};
}

struct Show {
    const Kernel& kernel;
    shared::CompositePush push;
    Resource bloom;  // a binding that the variant does not read still has to be bound: the scene stands in
    Groups groups;
};

Show show(const Kernels& kernels, const CompositeInputs& in, uint32_t tone, const View& view, const Display& display, float ldr_glare_gain, bool light) {
    const bool primaries = !light && display.primaries != kRec709;
    const Kernel& kernel = kernels.composite({tone, bool(in.bloom), primaries, light, !light && in.blue_first});
    const auto [width, height] = view.extent;
    const glm::mat3 rows(glm::transpose(glm::inverse(to_rec709(display.primaries))));
    const Cones cones = cones_of(display.primaries);
    return {kernel,
            {{width, height}, display.low(), display.high(), ldr_glare_gain, {}, rows[0], rows[1], rows[2],
             cones.luminance, cones.rows[0], cones.rows[1], cones.rows[2]},
            in.bloom ? in.bloom : in.scene,
            cover(width, height, kernel.group[0], kernel.group[1] * kernels.composite_rows)};
}

}  // namespace

Resource add_composite(FrameGraph& graph, const Kernels& kernels, const CompositeInputs& in, uint32_t tone, const View& view, const Display& display, float ldr_glare_gain) {
    Show s = show(kernels, in, tone, view, display, ldr_glare_gain, false);
    const Encoding encoding = make_encoding(display);
    s.push.encode = encoding.push;
    const Resource cells = graph.upload("code cells", encoding.cells, VK_FORMAT_R32G32B32A32_SFLOAT);
    const Resource image = graph.transient("display", image_shape(kDisplayFormat, view.extent));
    graph.dispatch("composite", s.kernel, {load(in.scene), sample(in.curve), sample(s.bloom), sample(cells), store(image)}, s.push, s.groups);
    return image;
}

Resource add_display_light(FrameGraph& graph, const Kernels& kernels, const CompositeInputs& in, uint32_t tone, const View& view, const Display& display, float ldr_glare_gain) {
    const Show s = show(kernels, in, tone, view, display, ldr_glare_gain, true);
    const Resource image = graph.transient("display light", image_shape(kDisplayLightFormat, view.extent));
    graph.dispatch("display light", s.kernel, {load(in.scene), sample(in.curve), sample(s.bloom), store(image)}, s.push, s.groups);
    return image;
}

}  // namespace vesper
