#include "render/renderer.h"

#include <deque>
#include <string>
#include <utility>

#include "base/error.h"
#include "graph/times.h"
#include "render/declare.h"
#include "render/display_average.h"
#include "render/frame_queue.h"
#include "render/prepare.h"
#include "render/sample_buffers.h"
#include "render/stored_picture.h"

namespace vesper::render {
namespace {

// `seen`: by an eye; light that is kept is scattered in none, and needs no fit.
ChainInputs chain_inputs_of(FrameQueue& frames, const Prepared& prepared, const RenderSettings& settings,
                            const gpu_scene::View& view, float seconds, bool seen) {
    ChainInputs chain = seen ? frames.inputs(settings, view, seconds) : ChainInputs{};
    chain.scatter.lamps = settings.offscreen_lamps;
    for (const gpu_scene::GlareSource& source : prepared.luminaires.glare_sources)
        if (source.inside < 1)
            chain.scatter.lamps.push_back({source.direction, (1 - source.inside) * source.illuminance});
    return chain;
}

}  // namespace

struct Renderer::State {
    /// The results of a submitted frame, as far as they are known.
    struct Pending {
        Frame frame;
        graph::Resource clusters, visibility;  // to be read
        graph::Resource targets;               // likewise; none without obstacles
        graph::Resource triangles;             // likewise, if pixels of obstacles are wanted
        std::vector<uint32_t> of_instances;    // see obstacles_of_instances()
        ObstaclesInView obstacles;
        gpu_scene::View view;
        std::vector<graph::Timing> earlier;  // of samples before the last
        ShadowCache shadow_cache;            // to be given to the cache
        ChainInputs chain;
    };
    /// A frame that is asked for.
    struct Request {
        const RenderSettings& settings;
        const gpu_scene::View& view;
        const gpu_scene::SceneFrame& poses;
    };

    State(gpu::Device& d, const scene::Scene& s, std::shared_ptr<Cache> cache)
        : device(d),
          scene(std::make_unique<ResidentScene>(d, s, cache.get())),
          map_cache(std::move(cache)),
          frames(d) {}

    Prepared prepare(const Request& of) {
        if (scene->maps && scene->maps->sizes() != map_sizes(of.settings)) {
            frames.wait();  // frames under way use the maps that go
            scene->maps.reset();
        }
        return render::prepare(*scene, device, map_cache.get(), of.settings, of.view, of.poses);
    }
    SceneLight declare(graph::FrameGraph& graph, const Request& of, const Prepared& prepared, glm::dvec2 place) {
        return render::declare(frames.context(graph, of.view.moved(place)), *scene, prepared, of.poses, of.view);
    }
    void keep_maps(Pending& of, ShadowReport& report);
    void keep_pending_maps();
    void add_samples(const Request& of, const Prepared& prepared, std::span<const glm::dvec2> places, Pending& pending);
    void average_display(const Request& of, const ChainInputs& chain, const eye::Projection* projection, Frame& frame);
    void add_obstacles(const FrameContext& frame, const Request& of, const SceneLight& light, const ToneChain& chain,
                       Pending& pending) const;
    void submit(const Request& of, float seconds, const Outputs& outputs, const graph::SubmitSemaphores& semaphores);
    std::optional<Frame> take(std::optional<ToneMapped> shown);
    void forget_lost() {
        while (pending.size() > frames.unfinished()) pending.pop_front();
    }
    // Runs what declares and submits frames: where it fails, the device has not got what the host believes.
    template <class Do>
    auto or_forget(const Do& act) {
        try {
            return act();
        } catch (...) {
            scene->forget();
            throw;
        }
    }

    gpu::Device& device;
    std::unique_ptr<ResidentScene> scene;
    std::shared_ptr<Cache> map_cache;
    SampleBuffers samples;
    std::function<void(uint32_t)> watch_samples;
    FrameQueue frames;            // waits for its frames, which use the rest
    std::deque<Pending> pending;  // the oldest first
};

Renderer::Renderer(gpu::Device& device, const scene::Scene& scene, std::shared_ptr<Cache> cache)
    : state_(std::make_unique<State>(device, scene, std::move(cache))) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

void Renderer::set_scene(const scene::Scene& scene) {
    auto resident = std::make_unique<ResidentScene>(state_->device, scene, state_->map_cache.get());
    state_->keep_pending_maps();
    state_->frames.wait();  // frames under way use the old scene
    state_->scene = std::move(resident);
}

void Renderer::keep_maps(std::shared_ptr<Cache> cache) {
    state_->map_cache = std::move(cache);
    if (state_->scene->maps) state_->scene->maps->use(state_->map_cache.get());
}

void Renderer::set_radiosity(std::shared_ptr<const transport::Radiosity> radiosity) {
    state_->frames.wait();
    state_->scene->indirect =
        radiosity ? std::make_unique<IndirectLight>(state_->device, std::move(radiosity)) : nullptr;
}

void Renderer::set_lamp_reflections(std::shared_ptr<const transport::LampReflections> reflections) {
    state_->scene->lamp_reflections = std::move(reflections);
}

void Renderer::set_illuminance(std::vector<glm::vec4> illuminance) {
    state_->scene->illuminance = std::move(illuminance);
}

void Renderer::watch_samples(std::function<void(uint32_t)> watch) { state_->watch_samples = std::move(watch); }
std::string Renderer::plan() const { return state_->frames.plan(); }
void Renderer::reset_adaptation() { state_->frames.set_eye({}); }
void Renderer::set_eye(const shared::EyeState& eye) { state_->frames.set_eye({eye}); }
const shared::EyeState& Renderer::eye() const { return state_->frames.eye().value; }
const gpu_scene::GpuScene& Renderer::scene() const { return state_->scene->data.resident; }

uint64_t Renderer::device_bytes() const {
    return state_->scene->device_bytes() + state_->frames.executor().heap_bytes() + state_->samples.bytes();
}

RenderSettings ldr_baseline(RenderSettings settings) {
    if (settings.tone_operator != Operator::Ldr) return settings;
    settings.paper_lambert = settings.unit_lamps = settings.lamps_alone = true;
    settings.shadows = false;
    settings.offscreen_lamps.clear();
    if (settings.glare == Glare::Scatter) settings.glare = Glare::None;
    return settings;
}

// Pixels with samples belong to what the last of them saw.
void Renderer::State::add_obstacles(const FrameContext& frame, const Request& of, const SceneLight& light,
                                    const ToneChain& chain, Pending& to) const {
    const RenderSettings& settings = of.settings;
    if (settings.obstacles.empty() || settings.tone_operator == Operator::Ldr || !chain.whole_retina) return;
    to.view = frame.view;
    to.obstacles = obstacles_in_view(settings.obstacles, of.poses, frame.view);
    const std::span<const std::byte> instances = frame.graph.resources()[light.surfaces.instances.index].contents;
    to.of_instances = obstacles_of_instances(settings.obstacles, scene->data.resident, instances);
    const graph::Resource sums =
        add_targets(frame, {light.surfaces.triangle, light.luminance, chain.retina_light, chain.whole_retina},
                    {to.of_instances, to.obstacles.rects});
    to.targets = add_readback(frame.graph, "targets", sums, to.obstacles.rects.size() * sizeof(shared::TargetSums));
    const uint64_t pixels = uint64_t{frame.view.extent.width} * frame.view.extent.height;
    to.triangles = add_readback(frame.graph, "triangle", light.surfaces.triangle, pixels * sizeof(glm::uvec2),
                                settings.obstacle_pixels);
}

// Gives maps that a finished frame has drawn to the cache.
void Renderer::State::keep_maps(Pending& of, ShadowReport& report) {
    if (scene->maps) report.note = scene->maps->keep(of.shadow_cache, frames.executor());
}

// The same of a frame that nobody has finished, before its readbacks are lost; waits for it.
void Renderer::State::keep_pending_maps() {
    if (pending.empty() || !pending.back().shadow_cache.drawn_on_host) return;
    frames.wait();
    keep_maps(pending.back(), pending.back().frame.maps);
    pending.back().shadow_cache = {};
}

// Samples before the last. Lamps, maps and luminaires are those of the view itself, of which samples see other points.
void Renderer::State::add_samples(const Request& of, const Prepared& prepared, std::span<const glm::dvec2> places,
                                  Pending& to) {
    if (places.empty()) return;
    pending.clear();  // a graph that is run leaves nothing of them
    frames.wait();
    samples.resize(device, uint64_t(of.view.extent.width) * of.view.extent.height);
    for (const glm::dvec2& place : places) {
        const bool first = &place == places.data();
        graph::FrameGraph graph;
        const SceneLight light = declare(graph, of, prepared, place);
        add_sample(frames.context(graph, of.view), light.luminance, samples.declare(graph), first);
        if (first && scene->maps) to.shadow_cache = scene->maps->take_cached();
        graph::add_times(to.earlier, frames.run(graph));
        if (first) keep_maps(to, to.frame.maps);
        to.shadow_cache = {};
        if (watch_samples) watch_samples(uint32_t(&place - places.data() + 1));
    }
}

// Samples once more, with the curve that their mean led to.
void Renderer::State::average_display(const Request& of, const ChainInputs& of_mean, const eye::Projection* projection,
                                      Frame& frame) {
    ChainInputs chain = of_mean;
    chain.curve = frame.curve;
    DisplayAverage average(of.settings.display, size_t(frame.shown_extent.width) * frame.shown_extent.height);
    const Prepared prepared = prepare(of);
    uint32_t done = of.settings.samples;
    for (const glm::dvec2& place : sample_places(of.settings.samples)) {
        graph::FrameGraph graph;
        const SceneLight light = declare(graph, of, prepared, place);
        const ToneChain shown = add_tone_chain(frames.context(graph, of.view), light.luminance, of.settings, chain,
                                               {.projection = projection});
        graph::add_times(frame.timings, frames.run(graph));
        average.add(frames.executor().read_as<uint8_t>(shown.display));
        if (watch_samples) watch_samples(++done);
    }
    frame.display = average.codes();
}

void Renderer::State::submit(const Request& of, float seconds, const Outputs& outputs,
                             const graph::SubmitSemaphores& semaphores) {
    const auto& [settings, view, poses] = of;
    keep_pending_maps();
    frames.prepare(settings);
    FrameQueue::Declared frame{.extent = view.extent};
    const Prepared prepared = prepare(of);
    Pending next{};
    next.frame.maps = prepared.maps;
    const std::vector<glm::dvec2> places = sample_places(settings.samples);
    const bool sampled = places.size() > 1;
    add_samples(of, prepared, std::span(places).first(places.size() - 1), next);
    ChainInputs chain = chain_inputs_of(frames, prepared, settings, view, seconds, !outputs.light);
    const FrameContext context = frames.context(frame.graph, view);
    SceneLight light = sampled ? declare(frame.graph, of, prepared, places.back())
                               : render::declare(context, *scene, prepared, poses, view);
    if (scene->maps) next.shadow_cache = scene->maps->take_cached();
    if (sampled) {
        const SampleSums sums = samples.declare(frame.graph);
        add_sample(context, light.luminance, sums, false);
        light.luminance = add_mean_of_samples(context, sums, settings.samples);
    }
    if (outputs.light) {
        outputs.light->store(device, frame.graph, light.luminance, view);
        const uint64_t pixels = uint64_t{view.extent.width} * view.extent.height;
        frame.chain.scene = add_readback(frame.graph, "scene", light.luminance, pixels * 16, outputs.scene);
    } else {
        frame.chain = add_tone_chain(context, light.luminance, settings, chain, outputs);
    }
    add_obstacles(context, of, light, frame.chain, next);
    next.clusters = add_readback(frame.graph, "cluster report", light.clusters.report, sizeof(shared::ClusterReport));
    next.visibility =
        add_readback(frame.graph, "visibility report", light.blocks.visibility, sizeof(shared::VisibilityReport));
    next.frame.far = light.clusters.push.far;
    frames.submit(std::move(frame), chain, semaphores);
    // Nothing fails from here on.
    next.frame.directional_levels = prepared.directional_levels;
    next.frame.lamps = uint32_t(prepared.lamps.lamps.size());
    next.frame.luminaires = uint32_t(prepared.luminaires.luminaires.size());
    next.frame.glare_sources = prepared.luminaires.glare_sources;
    next.frame.outside = chain.scatter.lamps;
    next.chain = std::move(chain);
    pending.push_back(std::move(next));
    forget_lost();
}

// The results of a frame on the host, which can be read: of the oldest that is left, or the last.
std::optional<Frame> Renderer::State::take(std::optional<ToneMapped> shown) {
    if (!shown) {
        forget_lost();
        return std::nullopt;
    }
    while (pending.size() > frames.unfinished() + 1) pending.pop_front();
    Pending done = std::move(pending.front());
    pending.pop_front();
    const graph::Executor& executor = frames.executor();
    Frame frame = std::move(done.frame);
    static_cast<ToneMapped&>(frame) = std::move(*shown);
    frame.clusters = read_one<shared::ClusterReport>(executor, done.clusters);
    frame.visibility = read_one<shared::VisibilityReport>(executor, done.visibility);
    if (done.targets) {
        measure(done.obstacles, executor.read_as<shared::TargetSums>(done.targets), done.view);
        frame.obstacles = std::move(done.obstacles.seen);
    }
    if (done.triangles)
        frame.obstacle_pixels = obstacles_of_pixels(executor.read_as<glm::uvec2>(done.triangles), done.of_instances);
    if (done.shadow_cache.drawn_on_host) keep_maps(done, frame.maps);
    graph::add_times(frame.timings, done.earlier);
    return frame;
}

void Renderer::submit(const RenderSettings& given, const gpu_scene::View& view, const gpu_scene::SceneFrame& poses,
                      float seconds, const Outputs& outputs, const graph::SubmitSemaphores& semaphores) {
    const RenderSettings settings = ldr_baseline(given);
    state_->or_forget([&] { state_->submit({settings, view, poses}, seconds, outputs, semaphores); });
}

std::optional<Frame> Renderer::finish() {
    return state_->or_forget([&] { return state_->take(state_->frames.finish()); });
}

std::optional<Frame> Renderer::finish_oldest(bool waits) {
    return state_->or_forget([&] { return state_->take(state_->frames.finish_oldest(waits)); });
}

size_t Renderer::unfinished() const { return state_->frames.unfinished(); }

Frame Renderer::render(const RenderSettings& given, const gpu_scene::View& view, const gpu_scene::SceneFrame& poses,
                       float seconds, const Outputs& outputs) {
    submit(given, view, poses, seconds, outputs, {});
    const ChainInputs chain = state_->pending.back().chain;
    Frame rendered = *finish();
    if (!given.display_average || given.samples <= 1 || !outputs.display) return rendered;
    const RenderSettings settings = ldr_baseline(given);
    state_->or_forget([&] { state_->average_display({settings, view, poses}, chain, outputs.projection, rendered); });
    return rendered;
}

}  // namespace vesper::render
