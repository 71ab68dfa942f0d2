#include "record/detection.h"

#include <algorithm>
#include <cmath>

#include "arguments/arguments.h"
#include "print.h"

namespace vesper::drive {
namespace {

using apps::format;

std::optional<double> absolute(const std::optional<double>& level) {
    return level ? std::optional(std::abs(*level)) : std::nullopt;
}

}  // namespace

std::optional<bool> is_visible(const render::SeenObstacle& seen, double age, double visible_from) {
    const std::optional<double> level = absolute(render::visibility_of(seen, age).level);
    return level ? std::optional(*level >= visible_from) : std::nullopt;
}

Detections::Detections(const std::vector<scene::Obstacle>& obstacles, double visible_from)
    : visible_from_(visible_from) {
    for (const scene::Obstacle& obstacle : obstacles) tracks_.push_back({obstacle.name, {}});
}

void Detections::add(std::span<const render::SeenObstacle> seen, double age, bool glare) {
    glare_ |= glare;
    for (size_t i = 0; i < tracks_.size(); ++i) {
        Moment moment{NAN, {}, {}};
        if (i < seen.size()) {
            const render::ObstacleVisibility visible = render::visibility_of(seen[i], age);
            moment = {seen[i].distance, glare ? absolute(visible.level) : std::nullopt, absolute(visible.without_veil)};
        }
        tracks_[i].moments.push_back(moment);
    }
}

double Detections::Track::nearest() const {
    double nearest = HUGE_VAL;
    for (const Moment& moment : moments)
        if (moment.with || moment.without) nearest = std::min(nearest, moment.distance);
    return nearest;
}

std::string Detections::first_of(const Track& track, std::optional<double> Moment::*level) const {
    for (const Moment& moment : track.moments)
        if ((moment.*level).value_or(0) >= visible_from_)
            return format("%.1f", moment.distance) + (&moment == track.moments.data() ? "+" : "");
    return "-";
}

std::string Detections::table() const {
    std::string text =
        apps::column(format("level %g first at, m", visible_from_), 32) + "  with glare  without glare  nearest\n";
    bool at_once = false;
    for (const Track& track : tracks_) {
        const std::string with = first_of(track, &Moment::with), without = first_of(track, &Moment::without);
        const std::string nearest = std::isfinite(track.nearest()) ? format("%.1f", track.nearest()) : "-";
        at_once |= with.ends_with('+') || without.ends_with('+');
        text += apps::column(track.name, 32) +
                format("  %10s  %13s  %7s\n", with.c_str(), without.c_str(), nearest.c_str());
    }
    if (at_once) text += "+: in the first frame, so from farther away\n";
    if (!glare_) text += "no light was scattered in the eye: --glare cie tells what is seen with glare\n";
    return text;
}

apps::LinePlot Detections::plot() const {
    std::vector<const Track*> drawn;
    for (const Track& track : tracks_)
        if (std::isfinite(track.nearest())) drawn.push_back(&track);
    std::stable_sort(drawn.begin(), drawn.end(),
                     [](const Track* a, const Track* b) { return a->nearest() < b->nearest(); });
    if (drawn.size() > kMostDrawn) drawn.resize(kMostDrawn);
    apps::LinePlot plot{.title = "Visibility of obstacles (Adrian 1989)",
                        .x_name = "distance, m",
                        .y_name = "visibility level",
                        .lines = {},
                        .log_y = true,
                        .rule = visible_from_};
    for (size_t i = 0; i < drawn.size(); ++i)
        for (const bool glare : {true, false}) {
            if (glare && !glare_) continue;
            apps::PlotLine& line = plot.lines.emplace_back();
            line.name = drawn[i]->name + (glare ? "" : ", no glare"), line.dashed = !glare, line.colour = i;
            for (const Moment& moment : drawn[i]->moments) {
                const std::optional<double>& level = glare ? moment.with : moment.without;
                // What is not known breaks a line.
                line.points.push_back(level ? glm::dvec2(moment.distance, *level) : glm::dvec2(NAN));
            }
        }
    return plot;
}

}  // namespace vesper::drive
