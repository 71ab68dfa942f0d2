#include "plots/line_plot.h"

#include <algorithm>
#include <cmath>

#include "plots/canvas.h"

namespace vesper::apps {
namespace {

const CanvasColour kGrid(0.86), kInk(0.15);
const CanvasColour kLines[]{{0.12, 0.36, 0.71}, {0.84, 0.15, 0.16}, {0.17, 0.55, 0.2}, {0.85, 0.5, 0.05},
                            {0.5, 0.25, 0.65},  {0.1, 0.6, 0.65},   {0.55, 0.35, 0.2}, {0.45, 0.45, 0.45}};

struct Axis {
    bool log = false;
    double low = HUGE_VAL, high = -HUGE_VAL;
    bool holds(double v) const { return std::isfinite(v) && (!log || v > 0); }
    void add(double v) {
        if (holds(v)) low = std::min(low, v), high = std::max(high, v);
    }
    void finish() {
        if (!(low <= high)) low = log ? 0.1 : 0, high = 1;
        if (log) {
            low /= 1.05, high *= 1.05;
            if (high < 2 * low) low /= 1.5, high *= 1.5;
        } else {
            const double rim = high > low ? 0.04 * (high - low) : 0.5;
            low = low >= 0 && low < 0.3 * high ? 0 : low - rim, high += rim;
        }
    }
    double part(double v) const { return log ? std::log(v / low) / std::log(high / low) : (v - low) / (high - low); }
    std::vector<double> ticks() const { return log ? log_ticks(low, high) : linear_ticks(low, high, 8); }
};

}  // namespace

void save_plot(const std::string& file, const LinePlot& plot) {
    Canvas canvas(1100, 560);
    const glm::dvec2 corner(90, 50), size(760, 430), end = corner + size;
    Axis x{plot.log_x}, y{plot.log_y};
    for (const PlotLine& line : plot.lines)
        for (const glm::dvec2& point : line.points) x.add(point.x), y.add(point.y);
    if (plot.rule != 0) y.add(plot.rule);
    x.finish(), y.finish();
    const auto at = [&](glm::dvec2 p) { return corner + size * glm::dvec2(x.part(p.x), 1 - y.part(p.y)); };
    canvas.text({corner.x, 24}, plot.title, 16);
    for (const double tick : x.ticks()) {
        const double place = corner.x + size.x * x.part(tick);
        canvas.line({place, corner.y}, {place, end.y + 5}, kGrid);
        canvas.text({place, end.y + 16}, tick_label(tick), 12, Canvas::Align::Centre);
    }
    for (const double tick : y.ticks()) {
        const double place = end.y - size.y * y.part(tick);
        canvas.line({corner.x - 5, place}, {end.x, place}, kGrid);
        canvas.text({corner.x - 9, place}, tick_label(tick), 12, Canvas::Align::Right);
    }
    canvas.rectangle(corner, size, kInk);
    canvas.text({corner.x + size.x / 2, end.y + 40}, plot.x_name, 13, Canvas::Align::Centre);
    canvas.text({20, corner.y + size.y / 2}, plot.y_name, 13, Canvas::Align::Centre, kInk, false, true);
    if (plot.rule != 0)
        canvas.line({corner.x, at({1, plot.rule}).y}, {end.x, at({1, plot.rule}).y}, CanvasColour(0), 1.5, true);
    for (size_t i = 0; i < plot.lines.size(); ++i) {
        const PlotLine& line = plot.lines[i];
        const CanvasColour colour = kLines[line.colour.value_or(i) % std::size(kLines)];
        std::vector<glm::dvec2> run;
        const auto flush = [&] {
            if (run.size() > 1) canvas.line(run, colour, 2, line.dashed);
            run.clear();
        };
        for (const glm::dvec2& point : line.points) {
            if (!x.holds(point.x) || !y.holds(point.y)) {
                flush();
                continue;
            }
            run.push_back(at(point));
            if (line.marks) canvas.disc(run.back(), 3.5, colour);
        }
        flush();
        const glm::dvec2 place(end.x + 16, corner.y + 12 + 20 * double(i));
        canvas.line(place, place + glm::dvec2(26, 0), colour, 2.5, line.dashed);
        canvas.text(place + glm::dvec2(32, 0), line.name, 12);
    }
    canvas.save(file);
}

}  // namespace vesper::apps
