#include "sightings.h"

#include <algorithm>
#include <cmath>

#include "print.h"

namespace vesper::commands {

std::vector<Sighting> sightings(std::span<const LevelAt> way, double level) {
    std::vector<Sighting> found;
    bool seen = false;
    const auto turn = [&](bool now, double distance, bool open) {
        if (now == seen) return;
        seen = now;
        if (now)
            found.push_back({.from = distance, .to = distance, .open_before = open});
        else
            found.back().to = distance, found.back().open_after = open;
    };
    for (size_t i = 0; i < way.size(); ++i) {
        const LevelAt& here = way[i];
        if (!here.level) {
            if (i > 0) turn(false, way[i - 1].distance, true);
            continue;
        }
        if (i == 0 || !way[i - 1].level) {
            turn(std::abs(*here.level) >= level, here.distance, true);
            continue;
        }
        // The line from the level before to this one, cut where it goes through the level sought and its negative.
        const double before = *way[i - 1].level, change = *here.level - before;
        double cuts[4] = {0, 1, 1, 1};
        if (change != 0)
            cuts[1] = std::clamp((level - before) / change, 0.0, 1.0),
            cuts[2] = std::clamp((-level - before) / change, 0.0, 1.0);
        std::ranges::sort(cuts);
        for (size_t k = 0; k < 3; ++k) {
            if (cuts[k] == cuts[k + 1]) continue;
            const double middle = std::lerp(before, *here.level, (cuts[k] + cuts[k + 1]) / 2);
            turn(std::abs(middle) >= level, std::lerp(way[i - 1].distance, here.distance, cuts[k]), false);
        }
    }
    if (seen) found.back().to = way.back().distance, found.back().to_end = true;
    return found;
}

std::string words_of(std::span<const LevelAt> way, double level) {
    const auto metres = [](double distance) { return apps::format("%g", std::round(10 * distance) / 10); };
    std::string words;
    for (const Sighting& part : sightings(way, level)) {
        words += words.empty() ? "" : ", ";
        words += part.open_before ? "beyond " : part.to_end ? "from " : "";
        words += metres(part.from) + (part.to_end ? "" : " to " + metres(part.to)) + " m";
        words += part.open_after ? " at least" : "";
    }
    if (!words.empty()) return words;
    const auto measured = std::ranges::count_if(way, [](const LevelAt& at) { return at.level.has_value(); });
    return measured == 0 ? kNotMeasured : measured == std::ssize(way) ? "never" : "never where it is measured";
}

std::vector<glm::dvec2> level_line(std::span<const LevelAt> way, double least) {
    constexpr int kSteps = 32;
    std::vector<glm::dvec2> line;
    for (size_t i = 0; i < way.size(); ++i) {
        const LevelAt& here = way[i];
        if (here.level && i > 0 && way[i - 1].level)
            for (int k = 1; k < kSteps; ++k) {
                const double part = double(k) / kSteps;
                line.emplace_back(std::lerp(way[i - 1].distance, here.distance, part),
                                  std::max(std::abs(std::lerp(*way[i - 1].level, *here.level, part)), least));
            }
        line.emplace_back(here.distance, here.level ? std::max(std::abs(*here.level), least) : NAN);
    }
    return line;
}

}  // namespace vesper::commands
