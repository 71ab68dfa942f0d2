#include "road_targets.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "arguments/arguments.h"
#include "plots/canvas.h"
#include "print.h"

namespace vesper::commands {
namespace {

using apps::format, apps::CanvasColour;

/// Least and greatest level of targets, how many are darker than the road, and how many have no level.
struct LevelRange {
    std::optional<double> least, greatest;
    size_t darker = 0, unknown = 0;
};

std::string value(const char* pattern, const std::optional<double>& number) {
    return number ? format(pattern, *number) : "-";
}

nlohmann::ordered_json json_of(const std::optional<double>& number) {
    return number ? nlohmann::ordered_json(*number) : nlohmann::ordered_json();
}

LevelRange range_of(const roads::SmallTargetVisibility& visibility) {
    LevelRange range;
    for (const roads::SmallTarget& target : visibility.targets) {
        if (!target.visibility_level) {
            ++range.unknown;
            continue;
        }
        const double level = *target.visibility_level;
        range.least = std::min(range.least.value_or(level), level);
        range.greatest = std::max(range.greatest.value_or(level), level);
        range.darker += level < 0;
    }
    return range;
}

std::string levels_of(const roads::SmallTargetVisibility& visibility) {
    const LevelRange range = range_of(visibility);
    const std::string levels = value("%.1f", range.least), most = value("%.1f", range.greatest);
    return "VL from " + levels + " to " + most +
           format(", %zu of %zu targets darker than the road", range.darker, visibility.targets.size()) +
           (range.unknown > 0 ? format(", %zu too dark to tell", range.unknown) : "");
}

// Of the map.
const CanvasColour kUnknown(0.8);
constexpr double kMargin = 70, kTop = 76, kFoot = 110, kCellHeight = 34, kStrongest = 10;

/// White where a target cannot be seen, to orange for bright ones and to blue for dark ones.
CanvasColour level_colour(double level) {
    const CanvasColour strong = level < 0 ? CanvasColour(0.16, 0.38, 0.74) : CanvasColour(0.90, 0.45, 0.08);
    return glm::mix(CanvasColour(1), strong, std::min(std::abs(level) / kStrongest, 1.0));
}

void draw_scale(apps::Canvas& canvas, glm::dvec2 corner) {
    constexpr int kSteps = 40;
    constexpr double kStep = 8;
    for (int i = 0; i < kSteps; ++i)
        canvas.fill(corner + glm::dvec2(i * kStep, 0), {kStep, 14},
                    level_colour(kStrongest * (2 * (i + 0.5) / kSteps - 1)));
    for (const double level : {-10.0, -5.0, 0.0, 5.0, 10.0})
        canvas.text(corner + glm::dvec2((level / kStrongest + 1) / 2 * kSteps * kStep, 24), format("%g", level), 11,
                    apps::Canvas::Align::Centre);
    canvas.text(corner + glm::dvec2(kSteps * kStep + 24, 7),
                "visibility level: blue darker than the road, orange brighter; dots: luminaires", 12);
}

}  // namespace

RoadTargets road_targets(const roads::LoadedLayout& layout, double reflectance) {
    RoadTargets made{roads::small_target_visibility(layout, reflectance), {}};
    if (!layout.hiding) return made;
    roads::LoadedLayout without = layout;
    without.hiding = nullptr;
    made.standard = roads::small_target_visibility(without, reflectance);
    return made;
}

std::string text_of(const RoadTargets& targets) {
    const roads::SmallTargetVisibility& counted = targets.counted;
    std::string text = format("\nSmall targets (IES RP-8-00): %g cm, reflectance %g, from %g m at %g years\n",
                              100 * roads::kTargetSide, counted.reflectance, roads::kTargetDistance, roads::kTargetAge);
    text += format("  STV         %10s   ", value("%.2f", counted.stv).c_str()) + levels_of(counted) + "\n";
    if (targets.standard)
        text += format("  unoccluded  %10s   ", value("%.2f", targets.standard->stv).c_str()) +
                levels_of(*targets.standard) + "\n";
    return text;
}

std::string grid_text_of(const roads::CalculationField& field, const RoadTargets& targets) {
    std::string text = "\nVisibility level of small targets\n   y \\ x";
    for (const double x : field.x) text += format(" %7.2f", x);
    for (size_t row = field.y.size(); row-- > 0;) {
        text += format("\n %7.3f", field.y[row]);
        for (size_t i = 0; i < field.x.size(); ++i)
            text += format(" %7s",
                           value("%+.2f", targets.counted.targets[row * field.x.size() + i].visibility_level).c_str());
    }
    return text + "\n";
}

nlohmann::ordered_json json_of(const RoadTargets& targets) {
    const roads::SmallTargetVisibility& counted = targets.counted;
    const LevelRange range = range_of(counted);
    nlohmann::ordered_json json = {{"stv", json_of(counted.stv)},
                                   {"reflectance", counted.reflectance},
                                   {"side_m", roads::kTargetSide},
                                   {"distance_m", roads::kTargetDistance},
                                   {"observer_age", roads::kTargetAge},
                                   {"least_visibility_level", json_of(range.least)},
                                   {"greatest_visibility_level", json_of(range.greatest)},
                                   {"darker_targets", range.darker},
                                   {"too_dark_targets", range.unknown}};
    if (targets.standard) json["stv_without_occluders"] = json_of(targets.standard->stv);
    for (const roads::SmallTarget& t : counted.targets)
        json["targets"].push_back({{"x_m", t.x},
                                   {"y_m", t.y},
                                   {"vertical_illuminance_lx", t.vertical_illuminance},
                                   {"luminance_cd_m2", t.luminance},
                                   {"background_cd_m2", t.background},
                                   {"veiling_luminance_cd_m2", t.veil},
                                   {"visibility_level", json_of(t.visibility_level)}});
    return json;
}

void write_target_map(const std::string& file, const roads::LoadedLayout& layout, const roads::CalculationField& field,
                      const roads::SmallTargetVisibility& visibility) {
    const auto columns = static_cast<double>(field.x.size()), rows = static_cast<double>(field.y.size());
    const double cell = std::clamp(1200 / columns, 30.0, 90.0);
    const glm::dvec2 size(columns * cell, rows * kCellHeight);
    apps::Canvas canvas(static_cast<uint32_t>(std::max(size.x, 900.0) + 2 * kMargin),
                        static_cast<uint32_t>(kTop + size.y + kFoot));
    const auto at = [&](double x, double y) {
        return glm::dvec2(kMargin + size.x * x / layout.spacing, kTop + size.y * (1 - y / layout.width));
    };
    canvas.text({kMargin, 24}, apps::column(layout.name, 100), 17);
    canvas.text({kMargin, 48},
                format("Small targets of reflectance %g, seen from the left, each from %g m: STV %s, ",
                       visibility.reflectance, roads::kTargetDistance, value("%.2f", visibility.stv).c_str()) +
                    levels_of(visibility),
                13);
    double labelled = -HUGE_VAL;
    for (const roads::SmallTarget& target : visibility.targets) {
        const glm::dvec2 middle = at(target.x, target.y), half(cell / 2, kCellHeight / 2);
        canvas.fill(middle - half, 2.0 * half + 0.5,
                    target.visibility_level ? level_colour(*target.visibility_level) : kUnknown);
        canvas.text(middle, value("%.1f", target.visibility_level), std::min(cell / 3.2, 13.0),
                    apps::Canvas::Align::Centre);
    }
    for (const double x : field.x) {
        if (const glm::dvec2 foot = at(x, 0) + glm::dvec2(0, 14); foot.x - labelled > 34) {
            canvas.text(foot, format("%.1f", x), 11, apps::Canvas::Align::Centre);
            labelled = foot.x;
        }
    }
    for (const double y : field.y)
        canvas.text(at(0, y) - glm::dvec2(8, 0), format("%.2f m", y), 11, apps::Canvas::Align::Right);
    canvas.text({kMargin + size.x / 2, kTop + size.y + 32}, "along the road, m", 12, apps::Canvas::Align::Centre);
    for (int lane = 1; lane < layout.lanes; ++lane) {
        const double y = lane * layout.width / layout.lanes;
        canvas.line(at(0, y), at(layout.spacing, y), CanvasColour(0.3), 1, true);
    }
    canvas.rectangle(at(0, layout.width), size, CanvasColour(0.3), 1);
    for (const roads::PlacedLuminaire& lamp : roads::placed_luminaires(layout, 0, layout.spacing))
        if (const glm::dvec2 place = at(lamp.position.x, lamp.position.y);
            place.y > kTop - 16 && place.y < kTop + size.y + 16)
            canvas.disc(place, 5, CanvasColour(0));
    draw_scale(canvas, {kMargin, kTop + size.y + 56});
    canvas.save(file);
}

}  // namespace vesper::commands
