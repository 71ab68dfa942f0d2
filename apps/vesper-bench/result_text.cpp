// Results of benchmarks for people: a terminal, a document. SPDX-License-Identifier: MIT
#include "arguments/arguments.h"
#include "print.h"
#include "result.h"

namespace vesper::bench {
namespace {

using apps::format;

constexpr double kMiB = 1 << 20;

std::string with_spread(const Spread& s, const char* unit) {
    return format("%.1f%s (%.1f to %.1f)", s.median, unit, s.low, s.high);
}

std::string percent(double part) { return part > 0 ? format("%.0f %%", 100 * part) : "-"; }

/// A name in a row of a table.
std::string cell(std::string name) {
    for (size_t at = 0; (at = name.find('|', at)) != std::string::npos; at += 2) name.insert(at, 1, '\\');
    return name;
}

std::string start_text(const RunResult& run) {
    std::string text;
    for (const Start& start : run.starts)
        text += (text.empty() ? "" : ", ") + start.cache + format(" %.1f s", start.seconds);
    return text;
}

}  // namespace

std::string RunSettings::title() const {
    return std::to_string(width) + "x" + std::to_string(height) + " " + scene + " " + tone_operator;
}

std::string RunSettings::details() const {
    std::string text = ", " + std::to_string(lamps) + " lamps, glare " + glare;
    const std::string words = apps::settings_words(light);
    if (words != apps::settings_words(apps::recorded_standard())) text += ", quality " + words;
    if (channels != 1) text += ", " + std::to_string(channels) + " channels";
    return text;
}

double RunResult::passes_ms() const {
    double sum = 0;
    for (const PassResult& pass : passes) sum += pass.ms.median;
    return sum;
}

double BenchResult::copy_fraction(const PassResult& pass) const {
    return copy_bandwidth > 0 && pass.ms.median > 0 ? pass.bytes() / (pass.ms.median * 1e-3) / copy_bandwidth : 0;
}

std::string headline(const BenchResult& result, const RunResult& run) {
    return run.settings.title() + format(": %.1f fps (%.1f ms) on ", run.fps, run.frame.median) + result.device;
}

std::string text_of(const BenchResult& result, const RunResult& run) {
    const RunSettings& s = run.settings;
    std::string text = format(
        "quality %s; %u lamps, %llu triangles, glare %s, %u channel%s; %u lap%s of %u frames, after %u\n",
        apps::settings_words(s.light).c_str(), s.lamps, static_cast<unsigned long long>(s.triangles), s.glare.c_str(),
        s.channels, s.channels == 1 ? "" : "s", s.laps, s.laps == 1 ? "" : "s", s.frames, s.warm_up);
    text += "vesper " + result.version + ", " + result.driver + ", " + std::to_string(result.threads) + " threads of " +
            result.host + "\n\n";
    text += "frame     median " + with_spread(run.frame, " ms") +
            format(" as laps differ; 5 %% %.1f, 95 %% %.1f, 99 %% %.1f ms; 1 %% low %.1f fps\n", run.p5, run.p95,
                   run.p99, run.low_fps);
    if (run.arithmetic.median > 0)
        text += "yardstick " + with_spread(run.arithmetic, " ms") +
                format(" for arithmetic on all threads before each lap; a frame is %.2f of it\n",
                       run.frame.median / run.arithmetic.median);
    if (run.processor.median > 0)
        text += "processor " + with_spread(run.processor, " ms") +
                format(" of all threads for a frame; frames in flight: %.1f fps\n", run.in_flight_fps);
    if (run.listed > 0)
        text +=
            format("lamps     of a block of 8x8 px: %.1f on its list, of which it sees %.1f\n", run.listed, run.kept);
    if (run.parts.in_view > 0)
        text += format("drawn     %.0f parts in view, %.0f of them seen; %.0f triangles, %.0f of them seen\n",
                       run.parts.in_view, run.parts.seen, run.triangles.in_view, run.triangles.seen);
    text += "host, ms ";
    for (size_t i = 0; i < kHostParts.size(); ++i)
        text += format(" %s %.2f", kHostParts[i], run.host[i].median) + (i + 1 < kHostParts.size() ? "," : "\n");
    text += format("memory    %.0f MiB of the host, %.0f MiB of the device, at most\n", run.host_bytes / kMiB,
                   run.device_bytes / kMiB);
    text += format("compiling %u pipelines made in %.0f ms; first frame %.0f ms\n", run.pipelines, run.pipelines_ms,
                   run.first_frame_ms);
    if (!run.starts.empty()) text += "start     to the first frame: " + start_text(run) + "\n";
    if (run.passes.empty()) return text + "\nthe device has no timestamps: nothing is known of passes\n";
    text += "\n" + apps::column("pass", 28) + "      ms            laps   of sum       MiB    GB/s  of copying\n";
    const double sum = run.passes_ms();
    for (const PassResult& pass : run.passes)
        text += apps::column(pass.name, 28) + format(" %7.2f %15s %8s %9.1f %7.1f %11s\n", pass.ms.median,
                                                     format("%.2f-%.2f", pass.ms.low, pass.ms.high).c_str(),
                                                     percent(sum > 0 ? pass.ms.median / sum : 0).c_str(),
                                                     pass.bytes() / kMiB,
                                                     pass.ms.median > 0 ? pass.bytes() / pass.ms.median * 1e-6 : 0.0,
                                                     percent(result.copy_fraction(pass)).c_str());
    text += apps::column("sum", 28) + format(" %7.2f\n", sum);
    return text + format("copying moves %.1f GB/s, read and written\n", result.copy_bandwidth * 1e-9);
}

std::string markdown_of(const BenchResult& result) {
    std::string text = "Measured with `vesper-bench` (docs/benchmark.md), vesper " + result.version +
                       ".\n\nDevice: " + result.device + " (" + result.driver + "), " + std::to_string(result.threads) +
                       " threads of " + result.host +
                       format("; copying moves %.1f GB/s.\n", result.copy_bandwidth * 1e-9);
    for (const RunResult& run : result.runs) {
        text += "\n## " + run.settings.title() + run.settings.details() + "\n\n| | measured |\n| --- | ---: |\n";
        text += "| whole frame, median (medians of the laps) | " + with_spread(run.frame, " ms") + " |\n";
        if (run.arithmetic.median > 0)
            text += "| arithmetic on all threads, before each lap | " + with_spread(run.arithmetic, " ms") + " |\n";
        if (run.processor.median > 0)
            text += "| processor time of a frame, all threads | " + with_spread(run.processor, " ms") +
                    format(" |\n| frames per second in flight | %.1f |\n", run.in_flight_fps);
        if (run.listed > 0)
            text += format("| lamps on the list of a block, seen by it | %.1f, %.1f |\n", run.listed, run.kept);
        if (run.parts.in_view > 0)
            text += format("| parts in view, seen; triangles in view, seen | %.0f, %.0f; %.0f, %.0f |\n",
                           run.parts.in_view, run.parts.seen, run.triangles.in_view, run.triangles.seen);
        text += format("| 5, 95 and 99 %% of the frames | %.1f, %.1f, %.1f ms |\n", run.p5, run.p95, run.p99);
        text += format("| frames per second (slowest 1 %%) | %.1f (%.1f) |\n", run.fps, run.low_fps);
        text += format("| recording and submission on the host | %.2f ms, %.2f ms |\n", run.host[3].median,
                       run.host[4].median);
        text += format("| memory of process and device | %.0f MiB, %.0f MiB |\n", run.host_bytes / kMiB,
                       run.device_bytes / kMiB);
        if (!run.starts.empty()) text += "| start to first frame | " + start_text(run) + " |\n";
        if (run.passes.empty()) continue;
        text += "\n| pass | ms | MiB moved | of copying |\n| --- | ---: | ---: | ---: |\n";
        for (const PassResult& pass : run.passes)
            text += "| " + cell(pass.name) +
                    format(" | %.2f | %.1f | %s |\n", pass.ms.median, pass.bytes() / kMiB,
                           percent(result.copy_fraction(pass)).c_str());
        text += format("| sum | %.2f | | |\n", run.passes_ms());
    }
    if (result.runs.size() < 2) return text;
    text += "\n## Growth\n\n| run | lamps | frame | laps | passes |\n| --- | ---: | ---: | ---: | ---: |\n";
    for (const RunResult& run : result.runs)
        text += "| " + cell(run.settings.title()) +
                format(", glare %s, %u ch. | %u | %.1f ms | %.1f to %.1f | %.1f ms |\n", run.settings.glare.c_str(),
                       run.settings.channels, run.settings.lamps, run.frame.median, run.frame.low, run.frame.high,
                       run.passes_ms());
    return text;
}

}  // namespace vesper::bench
