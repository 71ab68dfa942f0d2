// How time grows, as plots. SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>

#include "plots/line_plot.h"
#include "result.h"

namespace vesper::bench {
namespace {

using apps::PlotLine;

constexpr size_t kColours = 8;  // of a plot

double megapixels(const RunSettings& s) { return double(s.width) * s.height * s.channels * 1e-6; }

/// One line for runs that differ in nothing but what goes along x.
template <class Name, class Along>
std::vector<PlotLine> lines_of(const BenchResult& result, Name name, Along along) {
    std::vector<PlotLine> lines;
    for (const RunResult& run : result.runs) {
        auto line =
            std::find_if(lines.begin(), lines.end(), [&](const PlotLine& l) { return l.name == name(run.settings); });
        if (line == lines.end())
            line = lines.insert(
                line,
                PlotLine{.name = name(run.settings), .points = {}, .dashed = lines.size() >= kColours, .marks = true});
        line->points.push_back({along(run.settings), run.frame.median});
    }
    for (PlotLine& line : lines)
        std::sort(line.points.begin(), line.points.end(),
                  [](const glm::dvec2& p, const glm::dvec2& q) { return p.x < q.x; });
    return lines;
}

template <class Value>
bool differ(const BenchResult& result, Value value) {
    return std::any_of(result.runs.begin(), result.runs.end(), [&](const RunResult& run) {
        return value(run.settings) != value(result.runs.front().settings);
    });
}

/// The passes that take longest, of the runs that are like the one of most pixels in all but lamps.
std::vector<PlotLine> pass_lines(const BenchResult& result) {
    const auto largest = std::max_element(
        result.runs.begin(), result.runs.end(),
        [](const RunResult& a, const RunResult& b) { return megapixels(a.settings) < megapixels(b.settings); });
    std::map<std::string, PlotLine> lines;
    for (const RunResult& run : result.runs) {
        if (run.settings.title() != largest->settings.title() || run.settings.glare != largest->settings.glare ||
            run.settings.channels != largest->settings.channels)
            continue;
        for (const PassResult& pass : run.passes) {
            lines[pass.name].name = pass.name, lines[pass.name].marks = true;
            lines[pass.name].points.push_back({double(run.settings.lamps), pass.ms.median});
        }
    }
    std::vector<PlotLine> shown;
    for (auto& [name, line] : lines) {
        std::sort(line.points.begin(), line.points.end(),
                  [](const glm::dvec2& p, const glm::dvec2& q) { return p.x < q.x; });
        shown.push_back(std::move(line));
    }
    std::sort(shown.begin(), shown.end(),
              [](const PlotLine& a, const PlotLine& b) { return a.points.back().y > b.points.back().y; });
    shown.resize(std::min(shown.size(), kColours));
    return shown;
}

}  // namespace

std::vector<std::string> save_growth(const std::string& folder, const BenchResult& result) {
    std::vector<std::string> files;
    const auto save = [&](const std::string& name, const apps::LinePlot& plot) {
        files.push_back(folder + "/" + name);
        apps::save_plot(files.back(), plot);
    };
    const std::string on = " on " + result.device;
    const auto channels = [](const RunSettings& s) {
        return s.channels == 1 ? std::string() : " x " + std::to_string(s.channels);
    };
    const auto lamps = [](const RunSettings& s) { return double(s.lamps); };
    if (differ(result, lamps)) {
        const auto name = [&](const RunSettings& s) {
            return s.title() + channels(s) + (s.glare == "none" ? "" : " " + s.glare);
        };
        save("lamps.png", {.title = "Whole frame" + on,
                           .x_name = "lamps",
                           .y_name = "ms",
                           .lines = lines_of(result, name, lamps),
                           .log_x = true});
        save("passes.png", {.title = "Passes of the largest frame" + on,
                            .x_name = "lamps",
                            .y_name = "ms",
                            .lines = pass_lines(result),
                            .log_x = true});
    }
    if (differ(result, megapixels)) {
        const auto name = [&](const RunSettings& s) {
            return s.scene + " " + s.tone_operator + ", " + std::to_string(s.lamps) + " lamps" +
                   (s.glare == "none" ? "" : " " + s.glare);
        };
        save("pixels.png", {.title = "Whole frame" + on,
                            .x_name = "millions of pixels, all channels",
                            .y_name = "ms",
                            .lines = lines_of(result, name, megapixels)});
    }
    return files;
}

}  // namespace vesper::bench
