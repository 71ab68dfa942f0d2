#include "measure.h"
#include "gpu_scene/cameras.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "arguments/cache_arguments.h"
#include "base/error.h"
#include "base/stopwatch.h"
#include "gathered_light.h"
#include "graph/times.h"
#include "machine.h"
#include "print.h"
#include "render/seen_triangles.h"
#include "scaled_picture.h"
#include "scene/placement.h"

namespace vesper::bench {
namespace {

constexpr double kStanding = 10;  // s

struct PassSamples {
    std::string name;
    Samples ms, bytes_read, bytes_written;
};

/// What is known of every frame.
struct RunSamples {
    Samples frame, processor;
    std::array<Samples, kHostParts.size()> host;
    std::vector<PassSamples> passes;
    Samples arithmetic;
    double total_ms = 0;
    double blocks = 0, listed = 0, kept = 0;  // of pixels, and lamps on their lists

    void next_lap() {
        frame.next_lap(), processor.next_lap(), arithmetic.next_lap();
        for (Samples& part : host) part.next_lap();
        for (PassSamples& pass : passes) pass.ms.next_lap(), pass.bytes_read.next_lap(), pass.bytes_written.next_lap();
    }
    void add(double ms, double processor_ms, const std::array<double, kHostParts.size()>& parts,
             const std::vector<graph::Timing>& timings) {
        frame.add(ms), processor.add(processor_ms);
        total_ms += ms;
        for (size_t i = 0; i < parts.size(); ++i) host[i].add(parts[i]);
        for (const graph::Timing& timing : timings) {
            auto found = std::find_if(passes.begin(), passes.end(),
                                      [&](const PassSamples& pass) { return pass.name == timing.pass; });
            if (found == passes.end()) found = passes.insert(passes.end(), {timing.pass, {}, {}, {}});
            found->ms.add(timing.milliseconds);
            found->bytes_read.add(double(timing.bytes_read)), found->bytes_written.add(double(timing.bytes_written));
        }
    }
};

/// The renderer on its way.
class Drive {
public:
    Drive(const RunPlan& plan, const scene::Scene& scene, gpu::Device& device)
        : plan_(plan),
          scene_(scene),
          seconds_(scene::animation_length(scene) > 0 ? scene::animation_length(scene) : kStanding),
          scaled_(plan.extent(), plan.render.scale),
          renderer_(device, scene, plan.map_cache) {
        apps::give_indirect(renderer_, plan.render, scene, scene::world_transforms(scene, 0),
                            scene::animated_nodes(scene), plan.map_cache.get());
    }

    /// Renders every channel at a part [0, 1) of the path, `step` s after the frame before.
    void frame(double part, double step, RunSamples* samples) {
        Stopwatch whole, watch;
        const double began = processor_ms();
        const gpu_scene::SceneFrame moment{scene::world_transforms(scene_, part * seconds_)};
        const std::vector<gpu_scene::View> views = views_at(moment);
        std::array<double, kHostParts.size()> host{watch.lap()};
        std::vector<graph::Timing> timings;
        for (const gpu_scene::View& view : views) {
            last_ = renderer_.render(plan_.render, view, moment, float(step / double(views.size())), outputs());
            apps::print_cache_note(last_.maps.note);
            const graph::HostTimes& times = last_.host_times;
            const double parts[]{times.declare, times.plan, times.record, times.submit, times.wait};
            for (size_t i = 0; i < std::size(parts); ++i) host[1 + i] += parts[i];
            host.back() += watch.lap() - (times.declare + times.plan + times.record + times.submit + times.wait);
            graph::add_times(timings, last_.timings);  // channels are counted together
            if (samples) count_lamps(view, *samples);
        }
        if (samples) samples->add(whole.milliseconds(), processor_ms() - began, host, timings);
    }
    /// Frames per second of a lap whose frames are submitted before the frames ahead of them are done.
    double in_flight_fps(uint32_t frames) {
        const Stopwatch watch;
        for (uint32_t i = 0; i < frames; ++i) {
            const double part = double(i) / frames;
            const gpu_scene::SceneFrame moment{scene::world_transforms(scene_, part * seconds_)};
            const std::vector<gpu_scene::View> views = views_at(moment);
            for (const gpu_scene::View& view : views)
                renderer_.submit(plan_.render, view, moment, float(seconds_ / frames / double(views.size())), outputs(),
                                 {});
        }
        renderer_.finish();
        return 1000 * frames / watch.milliseconds();
    }
    /// What all channels draw and see at a part of the path.
    void count_triangles(const render::TriangleCounter& counter, double part, double weight, RunResult& result) {
        const gpu_scene::SceneFrame moment{scene::world_transforms(scene_, part * seconds_)};
        for (const gpu_scene::View& view : views_at(moment)) {
            const render::SeenTriangles counts = counter.count(renderer_.scene(), moment, view);
            result.parts.in_view += weight * double(counts.parts),
                result.parts.seen += weight * double(counts.seen_parts);
            result.triangles.in_view += weight * double(counts.triangles);
            result.triangles.seen += weight * double(counts.seen_triangles);
        }
    }
    double seconds() const { return seconds_; }
    render::Renderer& renderer() { return renderer_; }
    render::Frame& last() { return last_; }

private:
    std::vector<gpu_scene::View> views_at(const gpu_scene::SceneFrame& moment) const {
        const gpu_scene::View camera = gpu_scene::camera_view(scene_, moment, plan_.camera, plan_.extent());
        return channel_views(scaled_.rendered(camera), plan_.settings.channels);
    }
    render::Outputs outputs() const { return {.projection = scaled_.enlargement()}; }
    void count_lamps(const gpu_scene::View& view, RunSamples& samples) const {
        const shared::VisibilityReport& pairs = last_.visibility;
        const graph::Groups blocks =
            graph::cover(view.extent.width, view.extent.height, shared::kBlockSize, shared::kBlockSize);
        samples.blocks += double(blocks.x) * blocks.y;
        const double kept = double(pairs.lit) + pairs.mixed + pairs.faint;
        samples.kept += kept, samples.listed += kept + pairs.dark;
    }

    const RunPlan& plan_;
    const scene::Scene& scene_;
    double seconds_;
    apps::ScaledPicture scaled_;
    render::Renderer renderer_;
    render::Frame last_;
};

void summarize(const RunSamples& samples, RunResult& result) {
    const std::vector<double> frames = samples.frame.ascending();
    result.fps = 1000 * double(frames.size()) / samples.total_ms;
    result.frame = samples.frame.spread();
    result.p5 = percentile(frames, 5), result.p95 = percentile(frames, 95), result.p99 = percentile(frames, 99);
    result.low_fps = one_percent_low(frames);
    result.arithmetic = samples.arithmetic.spread(), result.processor = samples.processor.spread();
    result.listed = samples.listed / samples.blocks, result.kept = samples.kept / samples.blocks;
    for (size_t i = 0; i < result.host.size(); ++i) result.host[i] = samples.host[i].spread();
    for (const PassSamples& pass : samples.passes)
        result.passes.push_back(
            {pass.name, pass.ms.spread(), pass.bytes_read.spread().median, pass.bytes_written.spread().median});
}

// What was measured is kept should this fail.
void count_triangles(gpu::Device& device, Drive& drive, RunResult& result) {
    constexpr int kMoments = 4;  // along the path
    try {
        const render::TriangleCounter counter(device);
        for (int i = 0; i < kMoments; ++i) drive.count_triangles(counter, double(i) / kMoments, 1.0 / kMoments, result);
    } catch (const Error& error) {
        result.parts = result.triangles = {};
        apps::print_note(std::string("triangles are not counted: ") + error.what());
    }
}

}  // namespace

std::vector<gpu_scene::View> channel_views(const gpu_scene::View& camera, uint32_t channels) {
    const float width = std::atan(camera.tangent_high.x) - std::atan(camera.tangent_low.x);  // rad
    std::vector<gpu_scene::View> views(channels, camera);
    for (uint32_t i = 0; i < channels; ++i) {
        const float turn = (float(i) - 0.5f * float(channels - 1)) * width;  // to the right
        views[i].world_to_view = glm::rotate(glm::dmat4(1), double(turn), glm::dvec3(0, 1, 0)) * camera.world_to_view;
    }
    return views;
}

RunResult measure(const RunPlan& plan, const scene::Scene& scene, const std::function<void()>& frame_done,
                  render::Frame* last) {
    forget_peak_host_bytes();
    RunResult result;
    result.settings = plan.settings;
    RunSettings& settings = result.settings;
    gpu::Device device({.select = plan.device});
    Drive drive(plan, scene, device);

    const Stopwatch watch;
    drive.frame(0, 0, nullptr);
    result.first_frame_ms = watch.milliseconds();
    const double step = drive.seconds() / settings.frames;
    for (uint32_t i = 0; i < settings.warm_up; ++i) drive.frame(double(i) / settings.warm_up, step, nullptr);

    RunSamples samples;
    for (uint32_t lap = 0; lap < settings.laps; ++lap) {
        drive.renderer().reset_adaptation();
        if (lap) samples.next_lap();
        samples.arithmetic.add(arithmetic_ms());
        for (uint32_t i = 0; i < settings.frames; ++i) {
            drive.frame(double(i) / settings.frames, i ? step : 0, &samples);
            frame_done();
        }
    }
    summarize(samples, result);
    result.in_flight_fps = drive.in_flight_fps(settings.frames);
    settings.lamps = drive.last().lamps;
    settings.triangles = drive.renderer().scene().triangles();
    result.host_bytes = double(peak_host_bytes()), result.device_bytes = double(device.use().peak_bytes);
    result.pipelines = device.use().pipelines, result.pipelines_ms = device.use().pipeline_ms;
    count_triangles(device, drive, result);
    if (last) *last = std::move(drive.last());
    return result;
}

void first_frame(const RunPlan& plan, const scene::Scene& scene, const std::function<void()>& frame_done) {
    gpu::Device device({.select = plan.device});
    Drive drive(plan, scene, device);
    drive.frame(0, 0, nullptr);
    frame_done();
}

}  // namespace vesper::bench
