#include "render_records.h"

#include <algorithm>

#include "arguments/arguments.h"
#include "arguments/picture_arguments.h"
#include "base/parallel.h"
#include "print.h"
#include "statistics.h"

namespace vesper::commands {

using apps::format, apps::print;

apps::RecordedSettings recorded_of(const RenderArguments& arguments) {
    return apps::recorded_settings(arguments.light.quality, arguments.settings);
}

io::Header describe_frame(const RenderArguments& arguments, const gpu::Device& device, const gpu_scene::View& view,
                          const render::Frame& frame, const vision::GlareReport& glare, double seconds) {
    std::string pose;
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r) pose += (pose.empty() ? "" : " ") + format("%.15g", view.world_to_view[c][r]);
    io::Header header{{"vesper:version", VESPER_VERSION},
                      {"vesper:scene", arguments.scene},
                      {"vesper:options", arguments.options},
                      {"vesper:unit", "cd/m^2, linear Rec. 709 RGB"},
                      {"vesper:camera", arguments.camera},
                      {"vesper:worldToView", pose},
                      {"vesper:tangents",
                       apps::digits(double(view.tangent_low.x)) + " " + apps::digits(double(view.tangent_low.y)) + " " +
                           apps::digits(double(view.tangent_high.x)) + " " + apps::digits(double(view.tangent_high.y))},
                      {"vesper:seconds", apps::digits(seconds)},
                      {"vesper:lights", std::to_string(frame.lamps)},
                      {"vesper:device", device.name() + ", " + device.driver()}};
    render::RenderSettings luminance = arguments.settings;
    luminance.display_average = false;  // of codes
    for (const io::Header& part : {apps::describe_settings(apps::recorded_settings(arguments.light.quality, luminance)),
                                   apps::describe_tone(arguments.settings, frame), apps::describe_glare(glare)})
        header.insert(header.end(), part.begin(), part.end());
    return header;
}

std::string statistics_json(const RenderArguments& arguments, const render::Frame& frame) {
    return "{" + apps::settings_json(recorded_of(arguments)) + ", " + apps::tone_json(arguments.settings) +
           ", \"threads\": " + std::to_string(parallel_threads()) + ", " +
           apps::json_of(apps::luminance_statistics(frame.scene)).substr(1);
}

void print_statistics(const RenderArguments& arguments, const gpu::Device& device, const render::Renderer& renderer,
                      const render::Frame& frame, std::vector<double> milliseconds) {
    print("%s on %s (%s), %u threads of the host\n", arguments.scene.c_str(), device.name().c_str(),
          device.driver().c_str(), parallel_threads());
    print("%ux%u, %s, quality %s, %llu triangles, %u lamps, %.0f MiB on the device\n", frame.extent.width,
          frame.extent.height, apps::name_of(arguments.settings.tone_operator).c_str(),
          apps::settings_words(recorded_of(arguments)).c_str(),
          static_cast<unsigned long long>(renderer.scene().triangles()), frame.lamps,
          double(renderer.device_bytes()) / (1 << 20));
    print("clusters: to %.0f m, at most %u lamps in a froxel, %u froxels overflowed (and looked at every lamp)\n",
          double(frame.far), frame.clusters.longest, frame.clusters.overflowed);
    const auto& [lit, dark, mixed, faint, unshadowed, unshadowed_light] = frame.visibility;
    if (lit + dark + mixed + faint > 0)
        print(
            "shadows: of pairs of a block of pixels and a lamp, %u lit, %u dark, %u mixed, %u mixed of little light\n",
            lit, dark, mixed, faint);
    if (unshadowed > 0)
        print("shadows: %u lamps that move cast none; together they give %.3g %% of the light\n", unshadowed,
              1e-4 * unshadowed_light);
    if (arguments.settings.shadows)
        print(
            "shadow maps: %u, %.0f MiB; for this frame %u were drawn anew, %u taken from the cache, and bodies "
            "that move drawn %u times over others\n",
            frame.maps.lamps, double(frame.maps.bytes) / (1 << 20), frame.maps.maps, frame.maps.cached,
            frame.maps.bodies);
    if (frame.directional_levels > 0)
        print("maps of directional lights: %u levels were drawn for this frame\n", frame.directional_levels);
    print("adaptation luminance %.4g cd/m^2, foveal level %u, %u of %u pixels not finite\n",
          double(frame.curve.adaptation), frame.foveal_level, frame.histogram.non_finite,
          frame.histogram.finite + frame.histogram.non_finite);
    const bool ldr = arguments.settings.tone_operator == render::Operator::Ldr;
    apps::print_text(apps::text_of(apps::luminance_statistics(frame.scene),
                                   ldr ? "LDR values, relative to white" : "luminance, cd/m^2"));
    double total = 0;
    print("device time, ms\n");
    for (const graph::Timing& timing : frame.timings) {
        print("  %-24s %8.3f\n", timing.pass.c_str(), timing.milliseconds);
        total += timing.milliseconds;
    }
    print("  %-24s %8.3f\n", "sum", total);
    const graph::HostTimes& host = frame.host_times;
    print("host's time, ms\n  %-24s %8.3f\n  %-24s %8.3f\n  %-24s %8.3f\n  %-24s %8.3f\n", "prepare and declare",
          host.declare, "plan", host.plan, "record", host.record, "submit", host.submit);
    const double explained = total + host.declare + host.plan + host.record + host.submit;
    print("device and host: %.1f of %.1f ms of this frame\n", explained, frame.milliseconds);
    if (frame.pupil > 0)
        print("pupil %.2f mm, its needles and halo made on the host in %.1f ms\n", frame.pupil,
              frame.pattern_milliseconds);
    // The first frame makes the driver compile its shaders.
    if (milliseconds.size() > 1) milliseconds.erase(milliseconds.begin());
    std::sort(milliseconds.begin(), milliseconds.end());
    print("frame on the host's clock, ms: median %.1f of %zu, least %.1f\n", milliseconds[milliseconds.size() / 2],
          milliseconds.size(), milliseconds.front());
}

}  // namespace vesper::commands
