#include "plot.h"

#include <algorithm>
#include <cmath>

#include "arguments/arguments.h"
#include "base/angle.h"
#include "plots/false_colour.h"
#include "print.h"

namespace vesper::commands {
namespace {

using apps::Canvas, apps::CanvasColour, apps::format;
using photometry::Distribution;

const CanvasColour kGrey(0.8), kInk(0.15);
const CanvasColour kCurves[] = {{0.84, 0.15, 0.16}, {0.12, 0.36, 0.71}, {0.17, 0.55, 0.2}};

struct NamedCut {
    std::string name;
    photometry::Cut cut;
    bool dashed = false;
};

/// A rectangle of the canvas with linear axes.
struct PlotFrame {
    glm::dvec2 corner, size;
    double low_x, high_x, low_y, high_y;
    glm::dvec2 at(double x, double y) const {
        return corner + size * glm::dvec2((x - low_x) / (high_x - low_x), (high_y - y) / (high_y - low_y));
    }
};

void draw_axes(Canvas& canvas, const PlotFrame& frame, const std::string& x_name, const std::string& y_name,
               bool grid) {
    const glm::dvec2 end = frame.corner + frame.size;
    for (const double x : apps::linear_ticks(frame.low_x, frame.high_x, 8)) {
        const double at = frame.at(x, frame.low_y).x;
        if (grid) canvas.line({at, frame.corner.y}, {at, end.y}, kGrey);
        canvas.line({at, end.y}, {at, end.y + 5}, kInk);
        canvas.text({at, end.y + 15}, apps::tick_label(x), 12, Canvas::Align::Centre);
    }
    for (const double y :
         apps::linear_ticks(std::min(frame.low_y, frame.high_y), std::max(frame.low_y, frame.high_y), 8)) {
        const double at = frame.at(frame.low_x, y).y;
        if (grid) canvas.line({frame.corner.x, at}, {end.x, at}, kGrey);
        canvas.line({frame.corner.x - 5, at}, {frame.corner.x, at}, kInk);
        canvas.text({frame.corner.x - 9, at}, apps::tick_label(y), 12, Canvas::Align::Right);
    }
    canvas.rectangle(frame.corner, frame.size, kInk);
    canvas.text({frame.corner.x + frame.size.x / 2, end.y + 36}, x_name, 13, Canvas::Align::Centre);
    canvas.text({frame.corner.x - 64, frame.corner.y + frame.size.y / 2}, y_name, 13, Canvas::Align::Centre, kInk,
                false, true);
}

void draw_legend(Canvas& canvas, glm::dvec2 at, const std::vector<NamedCut>& cuts) {
    for (size_t i = 0; i < cuts.size(); ++i) {
        const glm::dvec2 place = at + glm::dvec2(150 * static_cast<double>(i), 0);
        canvas.line(place, place + glm::dvec2(28, 0), kCurves[i], 2.5, cuts[i].dashed);
        canvas.text(place + glm::dvec2(34, 0), cuts[i].name, 12);
    }
}

/// Whether type C has light above the horizontal that a diagram would show.
bool shines_up(const Distribution& d, const photometry::BeamFigures& figures) {
    for (size_t h = 0; h < d.horizontal.size(); ++h)
        for (size_t v = 0; v < d.vertical.size(); ++v)
            if (d.vertical[v] > 91 && d.at(h, v) > 0.005 * figures.largest) return true;
    return false;
}

void draw_polar(Canvas& canvas, const Distribution& d, const photometry::BeamFigures& figures, glm::dvec2 corner,
                glm::dvec2 size) {
    std::vector<NamedCut> cuts{{"C0 \u2013 C180", photometry::plane_cut(d, 0)},
                               {"C90 \u2013 C270", photometry::plane_cut(d, 90)}};
    const double c = figures.largest_h;
    if (figures.symmetry == photometry::BeamSymmetry::Rotational)
        cuts = {{"every plane", photometry::plane_cut(d, 0)}};
    else if (std::fmod(c, 90) != 0)
        cuts.push_back({format("C%g \u2013 C%g (max)", c, std::fmod(c + 180, 360)), photometry::plane_cut(d, c), true});
    const bool up = shines_up(d, figures);
    const double radius = up ? std::min(size.x / 2, size.y / 2) - 30 : std::min(size.x / 2 - 30, size.y - 100);
    const glm::dvec2 centre = corner + glm::dvec2(size.x / 2, up ? size.y / 2 : 90);
    const std::vector<double> rings = apps::linear_ticks(0, figures.largest * 1.08, 5);
    const double full = std::max(figures.largest * 1.05, rings.empty() ? 1 : rings.back());
    const auto place = [&](double gamma, double candela) {
        return centre + radius * candela / full *
                            glm::dvec2(std::sin(gamma * kRadiansPerDegree), std::cos(gamma * kRadiansPerDegree));
    };
    const double end = up ? 180 : 90;
    for (const double ring : rings) {
        std::vector<glm::dvec2> arc;
        for (double gamma = -end; gamma <= end; gamma += 3) arc.push_back(place(gamma, ring));
        canvas.line(arc, kGrey);
    }
    for (double gamma = -end; gamma <= end; gamma += 15) {
        canvas.line(centre, place(gamma, full), kGrey);
        if (gamma > -180)
            canvas.text(place(gamma, full + 16 * full / radius), format("%g\u00b0", std::abs(gamma)), 12,
                        Canvas::Align::Centre);
    }
    for (size_t i = cuts.size(); i-- > 0;) {
        std::vector<glm::dvec2> curve;
        for (size_t k = 0; k < cuts[i].cut.angle.size(); ++k)
            curve.push_back(place(cuts[i].cut.angle[k], cuts[i].cut.candela[k]));
        canvas.line(curve, kCurves[i], 2.5, cuts[i].dashed);
    }
    for (const double ring : rings)
        if (ring > 0)
            canvas.text(place(7, ring), apps::tick_label(ring), 11, Canvas::Align::Centre, CanvasColour(0.3), true);
    canvas.text(corner + glm::dvec2(size.x / 2, -14), "Intensity, cd, over \u03b3", 14, Canvas::Align::Centre);
    draw_legend(canvas, corner + glm::dvec2(10, size.y + 20), cuts);
}

void draw_cuts(Canvas& canvas, const Distribution& d, const photometry::BeamFigures& figures, glm::dvec2 corner,
               glm::dvec2 size) {
    const std::vector<NamedCut> cuts{
        {format("along H at V %g\u00b0", figures.largest_v), photometry::horizontal_cut(d, figures.largest_v)},
        {format("along V at H %g\u00b0", figures.largest_h), photometry::vertical_cut(d, figures.largest_h)}};
    const PlotFrame frame{corner + glm::dvec2(70, 0),
                          size - glm::dvec2(90, 20),
                          std::min(d.horizontal.front(), d.vertical.front()),
                          std::max(d.horizontal.back(), d.vertical.back()),
                          0,
                          std::max(1e-9, figures.largest * 1.05)};
    draw_axes(canvas, frame, "H or V, \u00b0", "Intensity, cd", true);
    for (size_t i = 0; i < cuts.size(); ++i) {
        std::vector<glm::dvec2> curve;
        for (size_t k = 0; k < cuts[i].cut.angle.size(); ++k)
            curve.push_back(frame.at(cuts[i].cut.angle[k], cuts[i].cut.candela[k]));
        canvas.line(curve, kCurves[i], 2.5);
    }
    canvas.text(corner + glm::dvec2(size.x / 2, -14), "Cuts through the greatest intensity", 14, Canvas::Align::Centre);
    draw_legend(canvas, corner + glm::dvec2(90, size.y + 40), cuts);
}

/// Intensities over both angles, pixel by pixel.
apps::ValuePicture sampled(const Distribution& d, const PlotFrame& frame) {
    apps::ValuePicture picture{static_cast<uint32_t>(frame.size.x), static_cast<uint32_t>(frame.size.y), {}};
    for (uint32_t y = 0; y < picture.height; ++y)
        for (uint32_t x = 0; x < picture.width; ++x) {
            const double h = glm::mix(frame.low_x, frame.high_x, (x + 0.5) / picture.width);
            const double v = glm::mix(frame.high_y, frame.low_y, (y + 0.5) / picture.height);
            picture.values.push_back(static_cast<float>(photometry::intensity_at(d, h, v)));
        }
    return picture;
}

void draw_points(Canvas& canvas, const Distribution& d, const PlotFrame& frame) {
    for (const photometry::BeamPoint& point : photometry::passing_beam_points()) {
        const glm::dvec2 at = frame.at(point.h, point.v);
        if (point.h < frame.low_x || point.h > frame.high_x || point.v < frame.low_y || point.v > frame.high_y)
            continue;
        const double candela = photometry::intensity_at(d, point.h, point.v);
        const bool left = point.h < 0, below = point.h == 0;
        const bool holds = candela >= point.least && (point.most == 0 || candela <= point.most);
        canvas.disc(at, 3.5, CanvasColour(1));
        canvas.disc(at, 2.5, holds ? CanvasColour(0) : CanvasColour(0.9, 0.1, 0.1));
        canvas.text(at + glm::dvec2(left    ? -6
                                    : below ? 0
                                            : 6,
                                    below ? 10 : 0),
                    point.name, 10,
                    left    ? Canvas::Align::Right
                    : below ? Canvas::Align::Centre
                            : Canvas::Align::Left,
                    CanvasColour(1), true);
    }
}

/// What of a headlamp's grid is worth showing: where it holds more than 1.5 % of its greatest, and the points of UN
/// R112.
PlotFrame headlamp_frame(const Distribution& d, const photometry::BeamFigures& figures, PlotFrame frame) {
    const glm::dvec2 first(d.horizontal.front(), d.vertical.front()), last(d.horizontal.back(), d.vertical.back());
    glm::dvec2 low(HUGE_VAL), high(-HUGE_VAL);
    const auto add = [&](double h, double v) { low = glm::min(low, {h, v}), high = glm::max(high, {h, v}); };
    for (size_t h = 0; h < d.horizontal.size(); ++h)
        for (size_t v = 0; v < d.vertical.size(); ++v)
            if (d.at(h, v) > 0.015 * figures.largest) add(d.horizontal[h], d.vertical[v]);
    for (const photometry::BeamPoint& point : photometry::passing_beam_points()) add(point.h, point.v);
    low = glm::max(low - 1.0, first), high = glm::min(high + 1.0, last);
    if (!(high.x > low.x) || !(high.y > low.y)) low = first, high = last;
    frame.low_x = low.x, frame.high_x = high.x, frame.low_y = low.y, frame.high_y = high.y;
    return frame;
}

void draw_map(Canvas& canvas, const Distribution& d, const photometry::BeamFigures& figures, glm::dvec2 corner,
              glm::dvec2 size) {
    const bool type_c = d.goniometry == photometry::Goniometry::CGamma;
    // gamma grows downwards on the page, as the light goes up.
    PlotFrame frame{corner + glm::dvec2(70, 0), size - glm::dvec2(90 + apps::kBarWidth, 20), 0, 360, 180,
                    d.vertical.front()};
    if (type_c)
        frame.low_y = shines_up(d, figures) ? d.vertical.back() : std::min(90.0, d.vertical.back());
    else
        frame = headlamp_frame(d, figures, frame);
    const double top = figures.largest > 0 ? figures.largest : 1;
    const apps::ColourScale scale{top / 1000, top};
    const apps::ValuePicture picture = sampled(d, frame);
    canvas.pixels(static_cast<int>(frame.corner.x), static_cast<int>(frame.corner.y), picture.width, picture.height,
                  apps::false_colours(picture, scale));
    std::vector<double> levels;
    for (const double level : apps::log_ticks(scale.low, scale.high)) levels.push_back(level);
    apps::draw_contours(canvas, picture, levels, frame.corner);
    draw_axes(canvas, frame, type_c ? "C, \u00b0" : "H, \u00b0 (right positive)",
              type_c ? "\u03b3, \u00b0" : "V, \u00b0 (up positive)", false);
    const glm::dvec2 peak = frame.at(figures.largest_h, figures.largest_v);
    canvas.line(peak - glm::dvec2(6, 0), peak + glm::dvec2(6, 0), CanvasColour(0.9, 0.1, 0.1), 2);
    canvas.line(peak - glm::dvec2(0, 6), peak + glm::dvec2(0, 6), CanvasColour(0.9, 0.1, 0.1), 2);
    if (!type_c) draw_points(canvas, d, frame);
    apps::draw_colour_bar(canvas, {frame.corner.x + frame.size.x + 20, frame.corner.y + 10}, frame.size.y - 10, scale,
                          "cd");
    canvas.text(
        {frame.corner.x + frame.size.x / 2, corner.y - 14},
        type_c ? "Lines of equal intensity, + greatest" : "Lines of equal intensity, + greatest, points of UN R112", 14,
        Canvas::Align::Centre);
}

}  // namespace

void draw_distribution(Canvas& canvas, const Distribution& d, const photometry::BeamFigures& figures) {
    canvas.text({24, 26}, apps::column(d.name, 80), 17);
    canvas.text({24, 50},
                format("%.0f lm, at most %.4g cd at %s %g\u00b0, %s %g\u00b0", figures.flux, figures.largest,
                       d.goniometry == photometry::Goniometry::CGamma ? "C" : "H", figures.largest_h,
                       d.goniometry == photometry::Goniometry::CGamma ? "\u03b3" : "V", figures.largest_v),
                13);
    const glm::dvec2 size(600, 520);
    if (d.goniometry == photometry::Goniometry::CGamma)
        draw_polar(canvas, d, figures, {24, 100}, size);
    else
        draw_cuts(canvas, d, figures, {24, 100}, size);
    draw_map(canvas, d, figures, {660, 100}, {690, 540});
}

}  // namespace vesper::commands
