#include "render/shared_eye.h"

#include <algorithm>

#include "render/passes/light_sums.h"

namespace vesper::render {
namespace {

constexpr size_t kRowOfTiles = 256;  // of the image that has the colours of all pictures

graph::Resource image_of(graph::FrameGraph& graph, const std::string& name, const std::vector<glm::vec4>& texels,
                         VkExtent2D extent) {
    const graph::Resource image = graph.transient(name, graph::image_shape(kSceneFormat, extent));
    graph.copy(name, graph.upload(name + " of the host", texels), image);
    return image;
}

// Tiles without pixels, which have no say, fill the last row.
Colours colours_of(graph::FrameGraph& graph, std::span<const ViewStatistics> pictures) {
    std::vector<glm::vec4> tiles;
    for (const ViewStatistics& picture : pictures)
        tiles.insert(tiles.end(), picture.colours.begin(), picture.colours.end());
    if (tiles.empty()) return {};
    const size_t columns = std::min(tiles.size(), kRowOfTiles), rows = (tiles.size() + columns - 1) / columns;
    tiles.resize(rows * columns, glm::vec4(0));
    const VkExtent2D extent{uint32_t(columns), uint32_t(rows)};
    return {image_of(graph, "colours", tiles, extent), extent};
}

// Copies on the host that statistics are read from.
struct StatisticsReadbacks {
    graph::Resource histogram, whole, fovea, colours;
};

StatisticsReadbacks read_back(graph::FrameGraph& graph, const Statistics& statistics) {
    const auto texels = [&](const char* name, graph::Resource image, VkExtent2D size) {
        return add_readback(graph, name, image, uint64_t(size.width) * size.height * sizeof(glm::vec4), bool(image));
    };
    const auto& [luminance, fovea, gaze, histogram, colours] = statistics;
    return {add_readback(graph, "histogram", histogram, sizeof(shared::Histogram)),
            texels("all of the picture", luminance.levels.back(), {1, 1}),
            texels("fovea", luminance.levels[fovea.level - 1], fovea.texels),
            texels("colours", colours.tiles, colours.extent)};
}

ViewStatistics statistics_of(const graph::Executor& executor, const StatisticsReadbacks& from,
                             const Statistics& measured) {
    const VkExtent2D texels = measured.fovea.texels;
    ViewStatistics statistics{
        .histogram = read_one<shared::Histogram>(executor, from.histogram),
        .whole = read_one<glm::vec4>(executor, from.whole),
        .fovea = texels_about(executor.read_as<glm::vec4>(from.fovea), {texels.width, texels.height}, measured.gaze),
        .colours = {},
    };
    if (from.colours) {
        const auto colours = executor.read_as<glm::vec4>(from.colours);
        statistics.colours.assign(colours.begin(), colours.end());
    }
    return statistics;
}

}  // namespace

SharedEye::SharedEye(gpu::Device& device, size_t pictures)
    : device_(device),
      upload_(device),
      summing_(device),
      seeing_(device, pictures),
      adapting_(device),
      showing_(device) {}

void SharedEye::upload(const HostPicture& picture, StoredPicture& light) {
    graph::FrameGraph graph;
    const graph::Resource image = upload_.add(graph, picture);
    light.store(device_, graph, image, view_of(picture.extent, picture.vertical_fov, picture.angles));
    seeing_.run(graph);
}

std::vector<float> SharedEye::read(const StoredPicture& picture) {
    graph::FrameGraph graph;
    const VkExtent2D extent = picture.view().extent;
    const graph::Resource read =
        add_readback(graph, "picture", picture.load(graph, "picture"), uint64_t{16} * extent.width * extent.height);
    summing_.run(graph);
    const auto values = summing_.executor().read_as<float>(read);
    return {values.begin(), values.end()};
}

std::vector<glm::vec3> SharedEye::light_of(const StoredPicture& light, std::span<const uint32_t> nodes) {
    if (nodes.empty()) return {};
    graph::FrameGraph graph;
    const graph::Resource image = light.load(graph, "light");
    const graph::Resource sums = add_light_sums(summing_.context(graph, light.view()), image, nodes);
    const graph::Resource read = add_readback(graph, "light of nodes", sums, nodes.size() * sizeof(glm::vec4));
    summing_.run(graph);
    const auto found = summing_.executor().read_as<glm::vec4>(read);
    return {found.begin(), found.end()};
}

SharedEye::Seen SharedEye::see(const ToneChainSettings& settings, const StoredPicture& light,
                               const ScatterInputs& beside, float seconds, const gpu_scene::View& shown,
                               StoredPicture& retina) {
    FrameQueue::Declared frame{.extent = light.view().extent};
    graph::FrameGraph& graph = frame.graph;
    seeing_.set_eye({eye()});
    ChainInputs inputs = seeing_.inputs(settings, light.view(), seconds);
    inputs.scatter.lamps = beside.lamps, inputs.scatter.pictures = beside.pictures;
    const FrameContext whole = seeing_.context(graph, light.view()), inner = seeing_.context(graph, shown);
    const graph::Resource seen = add_retina(whole, light.load(graph, "light"), inputs.scatter, inputs.corona);
    const graph::Resource middle = retina.store_middle(device_, graph, seen, light.view().extent, shown);
    const Statistics statistics = add_statistics(inner, middle, settings);
    const StatisticsReadbacks readbacks = read_back(graph, statistics);
    seeing_.submit(std::move(frame), inputs, {});
    ToneMapped done = *seeing_.finish();
    return {.statistics = statistics_of(seeing_.executor(), readbacks, statistics),
            .timings = std::move(done.timings),
            .pupil = done.pupil,
            .pattern_milliseconds = done.pattern_milliseconds,
            .milliseconds = done.milliseconds};
}

ToneMapped SharedEye::show(const ToneChainSettings& settings, const StoredPicture& retina,
                           const shared::ToneCurve& curve, const Outputs& outputs) {
    FrameQueue::Declared frame{.extent = retina.view().extent};
    const FrameContext context = showing_.context(frame.graph, retina.view());
    const ChainInputs inputs{.curve = curve};
    frame.chain = add_tone_chain(context, retina.load(frame.graph, "retina"), settings, inputs, outputs);
    showing_.submit(std::move(frame), inputs, {});
    return *showing_.finish();
}

ToneMapped SharedEye::adapt(const ToneChainSettings& settings, std::span<const ViewStatistics> pictures,
                            size_t looked_at, float seconds) {
    const OperatorInfo& op = operator_info(settings.tone_operator);
    const FovealTexels& fovea = pictures[looked_at].fovea;
    FrameQueue::Declared frame{.extent = {1, 1}};
    graph::FrameGraph& graph = frame.graph;
    const gpu_scene::View view = gpu_scene::View::symmetric({1, 1}, 1, glm::mat4(1));
    const ChainInputs inputs{.seconds = seconds, .eye = adapting_.eye()};
    shared::ToneParameters parameters = tone_parameters(op, settings.histogram, settings.tone, settings.display,
                                                        {1, {fovea.size.x, fovea.size.y}, {1, 1}}, seconds);
    parameters.gaze = fovea.gaze;
    const graph::Resource histogram = graph.upload("histogram", std::vector{sum_of_histograms(pictures)});
    const auto [curve, eye] = add_adaptation(adapting_.context(graph, view),
                                             {image_of(graph, "all pictures", {whole_of(pictures)}, {1, 1}),
                                              image_of(graph, "fovea", fovea.texels, {fovea.size.x, fovea.size.y}),
                                              histogram, colours_of(graph, pictures), inputs.eye},
                                             op, parameters);
    frame.chain.curve = add_readback(graph, "tone curve", curve, sizeof(shared::ToneCurve));
    frame.chain.histogram = add_readback(graph, "histogram", histogram, sizeof(shared::Histogram));
    frame.chain.eye = add_readback(graph, "eye", eye, sizeof(shared::EyeState));
    adapting_.submit(std::move(frame), inputs, {});
    return *adapting_.finish();
}

}  // namespace vesper::render
