#include "analysis/saliency_mapper.h"

#include "base/error.h"
#include "render/passes/saliency.h"
#include "render/tone_chain.h"

namespace vesper::analysis {

SaliencyMap SaliencyMapper::map(const render::HostPicture& picture) {
    graph::FrameGraph graph;
    const graph::Resource scene = upload_.add(graph, picture);
    const render::FrameContext frame{graph, kernels_, pipelines_, gpu_scene::View{.extent = picture.extent}};
    const render::Saliency found = render::add_saliency(frame, scene);
    if (!found.map)
        throw Error("saliency compares levels of 4 to 256 px: a picture of " + std::to_string(picture.extent.width) +
                    " x " + std::to_string(picture.extent.height) +
                    " px has none to compare (32 px on a side at least)");
    const uint64_t texels = uint64_t{found.extent.width} * found.extent.height;
    const graph::Resource kept = render::add_readback(graph, "saliency", found.map, texels * sizeof(glm::vec4));
    executor_.run(graph);
    SaliencyMap made{
        .extent = found.extent, .values = {}, .pairs = uint32_t(render::saliency_pairs(picture.extent).size())};
    made.values.reserve(texels);
    for (const glm::vec4& texel : executor_.read_as<glm::vec4>(kept))
        made.values.push_back(texel.x < kLeastSaliency ? 0 : texel.x);
    made.timings = executor_.timings();
    return made;
}

}  // namespace vesper::analysis
