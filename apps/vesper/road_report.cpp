#include "road_report.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "base/one_line.h"
#include "print.h"

namespace vesper::commands {
namespace {

using apps::format;

const char* name_of(roads::Arrangement arrangement) {
    switch (arrangement) {
        case roads::Arrangement::Right:
            return "a row on the right";
        case roads::Arrangement::Left:
            return "a row on the left";
        case roads::Arrangement::Opposite:
            return "facing rows";
        case roads::Arrangement::Staggered:
            return "staggered rows";
        case roads::Arrangement::Central:
            return "back to back on the reservation";
        case roads::Arrangement::List:
            return "as listed";
    }
    return "";
}

double q0_of(const photometry::ReflectionTable& table) {
    return table.stated_q0 > 0 ? table.stated_q0 : photometry::average_luminance_coefficient(table);
}

std::string occluders_of(const roads::LoadedLayout& layout) {
    return one_line(layout.occluders.filename().string(), 100);
}

std::string head_of(const roads::LoadedLayout& layout, const roads::RoadLighting& result) {
    std::string text = layout.name + "\n";
    text += format("  carriageway  %g m, %d lanes, surface %s with Q0 %.3g, S1 %.2f\n", layout.width, layout.lanes,
                   layout.surface.name.c_str(), q0_of(layout.surface), photometry::specular_factor(layout.surface));
    text +=
        format("  luminaires   %s, every %g m, %g m high, overhang %g m, tilt %g deg\n", name_of(layout.arrangement),
               layout.spacing, roads::mounting_height(layout), layout.overhang, layout.tilt_deg);
    text += format("               %s, %.0f lm, maintenance factor %g\n", layout.distribution.name.c_str(),
                   photometry::luminous_flux(layout.distribution) * layout.flux_factor, layout.maintenance_factor);
    text += format("  grid         %zu x %zu points, %.3g m apart\n", result.field.x.size(), result.field.y.size(),
                   result.field.step);
    if (layout.hiding)
        text += format("  occluders    %s: %zu of %zu luminaire-point pairs are hidden\n", occluders_of(layout).c_str(),
                       result.hidden_pairs, result.pairs);
    else if (!layout.occluders.empty())
        text += "  occluders    " + occluders_of(layout) + ": not counted, as in EN 13201-3\n";
    return text;
}

struct Figure {
    const char *name, *key, *unit;
    int decimals;
    double value;
    double roads::LightingClass::*limit;
};

std::vector<Figure> figures_of(const roads::RoadLighting& r) {
    // Of a wet road, classes limit the overall uniformity alone.
    if (r.wet)
        return {{"Lav", "average_luminance_cd_m2", "cd/m2", 3, r.average_luminance, nullptr},
                {"Uow", "overall_uniformity", "", 3, r.overall_uniformity, &roads::LightingClass::wet_uniformity},
                {"Ul", "lengthwise_uniformity", "", 3, r.longitudinal_uniformity, nullptr},
                {"TI", "threshold_increment_percent", "%", 2, r.threshold_increment_percent, nullptr},
                {"EIR", "edge_illuminance_ratio", "", 3, r.edge_ratio, nullptr}};
    return {
        {"Lav", "average_luminance_cd_m2", "cd/m2", 3, r.average_luminance, &roads::LightingClass::average_luminance},
        {"Uo", "overall_uniformity", "", 3, r.overall_uniformity, &roads::LightingClass::overall_uniformity},
        {"Ul", "lengthwise_uniformity", "", 3, r.longitudinal_uniformity,
         &roads::LightingClass::longitudinal_uniformity},
        {"TI", "threshold_increment_percent", "%", 2, r.threshold_increment_percent,
         &roads::LightingClass::threshold_increment_percent},
        {"EIR", "edge_illuminance_ratio", "", 3, r.edge_ratio, &roads::LightingClass::edge_ratio}};
}

bool holds(const Figure& figure, const roads::LightingClass& wanted) {
    const double limit = wanted.*figure.limit;
    return figure.limit == &roads::LightingClass::threshold_increment_percent ? figure.value <= limit
                                                                              : figure.value >= limit;
}

const char* verdict(const Figure& figure, const roads::LightingClass& wanted) {
    return holds(figure, wanted) ? "ok" : "missed";
}

constexpr size_t kStandardColumn = 44;

/// The figures against a class, and beside them those of the standard if they are others.
std::string table_of(const roads::RoadLighting& result, const roads::LightingClass* wanted,
                     const roads::RoadLighting* standard) {
    std::string text;
    const auto add_row = [&](std::string row, const std::string& beside) {
        if (standard) row.resize(std::max(row.size(), kStandardColumn), ' ');
        text += row + (standard ? beside : "") + "\n";
    };
    add_row(wanted ? format("                  value   %s asks", wanted->name) : "                  value",
            "without occluders (EN 13201-3)");
    const std::vector<Figure> figures = figures_of(result), others = figures_of(standard ? *standard : result);
    for (size_t i = 0; i < figures.size(); ++i) {
        const Figure &f = figures[i], &other = others[i];
        std::string row = format("  %-4s %-6s %10.*f", f.name, f.unit, f.decimals, f.value);
        std::string beside = format("%10.*f", other.decimals, other.value);
        if (wanted && f.limit) {
            const bool most = f.limit == &roads::LightingClass::threshold_increment_percent;
            row += format("   %s %-5g %s", most ? "<=" : ">=", wanted->*f.limit, verdict(f, *wanted));
            beside += format(" %s", verdict(other, *wanted));
        }
        add_row(row, beside);
    }
    const roads::RoadLighting& beside = standard ? *standard : result;
    add_row(format("  Eav  lx     %10.2f", result.average_illuminance), format("%10.2f", beside.average_illuminance));
    add_row(format("  Emin lx     %10.2f   Emin / Eav %.3f", result.minimum_illuminance,
                   result.minimum_illuminance / result.average_illuminance),
            format("%10.2f", beside.minimum_illuminance));
    return text;
}

std::string class_line_of(const roads::RoadLighting& result, const roads::RoadLighting* standard) {
    const auto name_of_class = [](const roads::RoadLighting& lighting) {
        const roads::LightingClass* reached = roads::reached_class(lighting);
        return reached ? reached->name : "none";
    };
    if (result.wet)
        return "\nA wet surface: the other limits of the classes (EN 13201-2:2015) are those of the road when it is "
               "dry\n";
    if (standard)
        return format("\nLighting class reached (EN 13201-2:2015, dry): %s; with occluders: %s\n",
                      name_of_class(*standard), name_of_class(result));
    return format("\nLighting class reached (EN 13201-2:2015, dry): %s\n", name_of_class(result));
}

nlohmann::ordered_json json_of(const RoadReading& reading) {
    return {{"average_luminance_cd_m2", reading.average_luminance},
            {"overall_uniformity", reading.overall_uniformity},
            {"lengthwise_uniformity", reading.longitudinal_uniformity},
            {"average_difference_percent", reading.average_difference},
            {"rms_difference_percent", reading.mean_difference},
            {"largest_difference_percent", reading.largest_difference}};
}

void add_figures(nlohmann::ordered_json& json, const roads::RoadLighting& result) {
    for (const Figure& figure : figures_of(result)) json[figure.key] = figure.value;
    json["edge_illuminance_ratio_right"] = result.edge_ratio_right;
    json["edge_illuminance_ratio_left"] = result.edge_ratio_left;
    json["average_illuminance_lx"] = result.average_illuminance;
    json["minimum_illuminance_lx"] = result.minimum_illuminance;
    const roads::LightingClass* reached = roads::reached_class(result);
    json["class_reached"] = reached ? nlohmann::ordered_json(reached->name) : nlohmann::ordered_json();
}

}  // namespace

std::string text_of(const roads::LoadedLayout& layout, const roads::RoadLighting& result,
                    const roads::LightingClass* wanted, const roads::RoadLighting* standard) {
    std::string text = head_of(layout, result) + "\n" + table_of(result, wanted, standard);
    text += format("  EIR  right %.3f, left %.3f\n\n", result.edge_ratio_right, result.edge_ratio_left);

    text += "  lane  eye at y, m   Lav cd/m2      Uo      Ul    TI %   Lv cd/m2   worst from x, m\n";
    for (const roads::LaneObserver& o : result.observers)
        text += format("  %4d  %11.2f  %10.3f  %6.3f  %6.3f  %6.2f  %9.4f  %16.1f\n", o.lane, o.eye.y,
                       o.average_luminance, o.overall_uniformity, o.longitudinal_uniformity,
                       o.threshold_increment_percent, o.veil, o.glare_eye.x);
    return text + class_line_of(result, standard);
}

std::string grid_text_of(const roads::RoadLighting& result) {
    const size_t columns = result.field.x.size();
    std::string text;
    for (size_t table = 0; table <= result.observers.size(); ++table) {
        text += table == 0
                    ? "\nHorizontal illuminance, lx\n"
                    : format("\nLuminance for the observer of lane %d, cd/m2\n", result.observers[table - 1].lane);
        text += "   y \\ x";
        for (const double x : result.field.x) text += format(" %7.2f", x);
        for (size_t row = result.field.y.size(); row-- > 0;) {
            text += format("\n %7.3f", result.field.y[row]);
            for (size_t i = 0; i < columns; ++i) {
                const roads::FieldPoint& point = result.points[row * columns + i];
                text += table == 0 ? format(" %7.2f", point.illuminance) : format(" %7.3f", point.luminance[table - 1]);
            }
        }
        text += "\n";
    }
    return text;
}

std::string csv_of(const roads::LoadedLayout& layout, const roads::RoadLighting& result, const RenderedRoad* rendered,
                   const RoadTargets* targets) {
    std::string text = "# " + layout.name + ": surface " + layout.surface.name + ", x ahead and y to the left, m";
    text += layout.hiding ? "; less what " + occluders_of(layout) + " hides\n" : "\n";
    text += "x_m,y_m,E_h_lx";
    for (const roads::LaneObserver& o : result.observers) text += format(",L_lane%d_cd_m2", o.lane);
    if (rendered)
        for (const roads::LaneObserver& o : result.observers) text += format(",L_lane%d_rendered_cd_m2", o.lane);
    if (targets) text += ",E_v_lx,Lt_cd_m2,Lb_cd_m2,Lv_cd_m2,VL";
    for (size_t i = 0; i < result.points.size(); ++i) {
        const roads::FieldPoint& point = result.points[i];
        text += format("\n%.4f,%.4f,%.6g", point.x, point.y, point.illuminance);
        for (const double luminance : point.luminance) text += format(",%.6g", luminance);
        if (rendered)
            for (const RenderedObserver& seen : rendered->observers) text += format(",%.6g", seen.counted.luminance[i]);
        if (!targets) continue;
        const roads::SmallTarget& t = targets->counted.targets[i];
        text += format(",%.6g,%.6g,%.6g,%.6g,", t.vertical_illuminance, t.luminance, t.background, t.veil) +
                (t.visibility_level ? format("%.6g", *t.visibility_level) : "");
    }
    return text + "\n";
}

std::string json_of(const roads::LoadedLayout& layout, const roads::RoadLighting& result,
                    const roads::LightingClass* wanted, const roads::RoadLighting* standard,
                    const RenderedRoad* rendered, const RoadTargets* targets) {
    nlohmann::ordered_json json = {
        {"name", layout.name}, {"surface", layout.surface.name}, {"q0", q0_of(layout.surface)}, {"wet", result.wet}};
    add_figures(json, result);
    if (standard) {
        json["occlusion"] = {
            {"occluders", occluders_of(layout)}, {"pairs", result.pairs}, {"hidden_pairs", result.hidden_pairs}};
        add_figures(json["occlusion"]["en_13201_3"], *standard);
    }
    if (wanted) json["class_wanted"] = {{"name", wanted->name}, {"fulfilled", roads::fulfils(result, *wanted)}};
    for (const roads::LaneObserver& o : result.observers)
        json["observers"].push_back({{"lane", o.lane},
                                     {"eye_m", {o.eye.x, o.eye.y, o.eye.z}},
                                     {"average_luminance_cd_m2", o.average_luminance},
                                     {"overall_uniformity", o.overall_uniformity},
                                     {"lengthwise_uniformity", o.longitudinal_uniformity},
                                     {"threshold_increment_percent", o.threshold_increment_percent},
                                     {"veiling_luminance_cd_m2", o.veil},
                                     {"glare_eye_m", {o.glare_eye.x, o.glare_eye.y, o.glare_eye.z}}});
    for (const roads::FieldPoint& p : result.points)
        json["points"].push_back(
            {{"x_m", p.x}, {"y_m", p.y}, {"illuminance_lx", p.illuminance}, {"luminance_cd_m2", p.luminance}});
    if (rendered) {
        json["rendered_on"] = rendered->device;
        for (size_t o = 0; o < rendered->observers.size(); ++o) {
            const RenderedObserver& seen = rendered->observers[o];
            json["observers"][o]["rendered"] = json_of(seen.counted);
            json["observers"][o]["rendered"]["veiling_luminance_cd_m2"] = seen.glare.road_veil;
            json["observers"][o]["rendered"]["threshold_increment_percent"] = seen.glare.increment;
            json["observers"][o]["rendered_every_luminaire"] = json_of(seen.every);
            for (size_t i = 0; i < result.points.size(); ++i) {
                json["points"][i]["luminance_rendered_cd_m2"].push_back(seen.counted.luminance[i]);
                json["points"][i]["luminance_every_luminaire_cd_m2"].push_back(seen.every.luminance[i]);
            }
        }
    }
    if (targets) json["small_targets"] = json_of(*targets);
    return json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace vesper::commands
