#include "arguments/obstacle_arguments.h"

#include <algorithm>
#include <iterator>

#include "base/error.h"
#include "print.h"

namespace vesper::apps {
namespace {

using render::SeenObstacle;

constexpr const char* kColumns[]{
    "distance", "size", "target", "around", "target_veil", "visibility", "visibility_without_veil"};

std::string value(double number) { return format(",%.6g", number); }
std::string value(const std::optional<double>& number) { return number ? value(*number) : ","; }

}  // namespace

void add_obstacle_option(Command command, std::vector<std::string>& patterns) {
    command
        .add_option(
            "--obstacle", patterns,
            "Watch a node of the scene, by a pattern such as 'pedestrian_*': visibility level (Adrian 1989) with "
            "and without glare; may be repeated")
        .repeats();
}

std::vector<scene::Obstacle> obstacles_of(const scene::Scene& scene, const std::vector<std::string>& patterns,
                                          const render::ToneChainSettings& settings) {
    if (!patterns.empty() && settings.tone_operator == render::Operator::Ldr)
        throw Error("--obstacle: the ldr operator has no luminances to measure");
    return scene::find_obstacles(scene, patterns, "--obstacle");
}

std::string csv_name(std::string name) {
    for (char& c : name)
        if (c == ',' || c == ';' || c == '"' || static_cast<unsigned char>(c) < 0x20) c = '_';
    return name;
}

std::string obstacle_columns(std::span<const scene::Obstacle> obstacles) {
    std::string columns;
    for (const scene::Obstacle& obstacle : obstacles)
        for (const char* column : kColumns) columns += std::string(",") + column + ":" + csv_name(obstacle.name);
    return columns;
}

bool are_obstacle_columns(const std::string& text) {
    return text.empty() || text.starts_with(std::string(",") + kColumns[0] + ":");
}

std::string obstacle_values(std::span<const scene::Obstacle> obstacles, std::span<const SeenObstacle> frame,
                            const render::ToneChainSettings& settings) {
    if (frame.empty()) return std::string(std::size(kColumns) * obstacles.size(), ',');
    std::string values;
    for (const SeenObstacle& seen : frame) {
        values += value(seen.distance);
        const render::ObstacleVisibility visible = render::visibility_of(seen, settings.tone.observer.age);
        if (seen.state == SeenObstacle::State::Measured)
            values += value(visible.size) + value(seen.luminance) + value(seen.around) + value(seen.veil) +
                      value(visible.level) + value(visible.without_veil);
        else
            values += std::string(std::size(kColumns) - 1, ',');
    }
    return values;
}

std::string obstacle_lines(std::span<const scene::Obstacle> obstacles, std::span<const SeenObstacle> seen,
                           const render::ToneChainSettings& settings) {
    const auto level = [](const std::optional<double>& l) { return l ? format("%.3g", *l) : std::string("unknown"); };
    std::string lines;
    for (size_t i = 0; i < obstacles.size() && i < seen.size(); ++i) {
        const SeenObstacle& s = seen[i];
        lines += format("obstacle %s, %.1f m: ", obstacles[i].name.c_str(), s.distance);
        const render::ObstacleVisibility visible = render::visibility_of(s, settings.tone.observer.age);
        if (s.state == SeenObstacle::State::Measured)
            lines += format("%.3g arc minutes, %.4g cd/m^2 on %.4g cd/m^2, ", visible.size, s.luminance, s.around) +
                     (settings.glare == render::Glare::Scatter
                          ? format("veil %.4g cd/m^2, visibility level %s, ", s.veil, level(visible.level).c_str())
                          : std::string("visibility level ")) +
                     format("without glare %s\n", level(visible.without_veil).c_str());
        else
            lines += std::string(render::words_of(s.state)) + "\n";
    }
    return lines;
}

}  // namespace vesper::apps
