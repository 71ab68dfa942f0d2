// Light at points of a scene, by its origin. SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <cstdio>

#include "arguments/arguments.h"
#include "base/error.h"
#include "base/luminance.h"
#include "base/one_line.h"
#include "inspect.h"
#include "print.h"
#include "scene/read_scene.h"
#include "transport/light_tracer.h"

namespace vesper::commands {
namespace {

using apps::format;
using transport::Illuminance;

// Of each origin, in JSON.
constexpr std::array<const char*, transport::kOrigins> kKeys{"lamps", "emitters", "sky", "reflected_once",
                                                             "reflected_more_often"};

glm::dvec3 triple(const char* option, const std::string& text) {
    glm::dvec3 v;
    int used = 0;
    const bool read = std::sscanf(text.c_str(), "%lf,%lf,%lf%n", &v.x, &v.y, &v.z, &used) == 3;
    if (!read || size_t(used) != text.size() || !(glm::length(v) < 1e7))
        throw Error(std::string(option) + " " + one_line(text) + ": expected X,Y,Z, three numbers below 1e7");
    return v;
}

std::string numbers(glm::dvec3 v) { return format("(%.6g, %.6g, %.6g)", v.x, v.y, v.z); }

void report(const Illuminance& light, glm::dvec3 point, glm::dvec3 normal, Inspection& made) {
    const double sum = luminance(light.sum());
    nlohmann::ordered_json json = {{"point_m", {point.x, point.y, point.z}},
                                   {"normal", {normal.x, normal.y, normal.z}}};
    made.text += "\nat " + numbers(point) + " m, facing " + numbers(normal) + "\n";
    made.text += "  illuminance                          lx   std. error   share\n";
    for (size_t i = 0; i < kKeys.size(); ++i) {
        const double lux = luminance(light.rgb[i]), error = light.standard_error[i];
        made.text += format("  %-28s %10.4g   %10.2g   %5.1f %%\n", kOriginTexts[i], lux, error,
                            sum > 0 ? 100 * lux / sum : 0.0);
        json["illuminance_lx"][kKeys[i]] = lux;
        json["standard_error_lx"][kKeys[i]] = error;
    }
    made.text += format("  %-28s %10.4g   %10.2g\n", "sum", sum, light.standard_error_of_sum);
    json["illuminance_lx"]["sum"] = sum;
    json["standard_error_lx"]["sum"] = light.standard_error_of_sum;
    made.json["light"].push_back(json);
}

}  // namespace

Inspection inspect_light(const InspectArguments& arguments) {
    const glm::dvec3 facing = arguments.normal.empty() ? glm::dvec3(0, 1, 0) : triple("--normal", arguments.normal);
    transport::TraceSettings settings;
    if (arguments.paths > 0) settings.paths = arguments.paths;
    if (!(glm::length(facing) > 1e-6)) throw Error("--normal " + one_line(arguments.normal) + ": has no direction");
    std::vector<glm::dvec3> points;
    for (const std::string& text : arguments.points) points.push_back(triple("--at", text));
    const scene::Scene scene = scene::read_scene(arguments.file).scene;
    const std::vector<glm::dmat4> world = scene::world_transforms(scene, 0);
    const transport::LightTracer tracer(scene, world);
    Inspection made;
    made.text = one_line(arguments.file) + ": light on surfaces, " + std::to_string(settings.paths) + " paths each\n";
    for (const glm::dvec3 point : points)
        report(tracer.at(point, glm::normalize(facing), settings), point, glm::normalize(facing), made);
    if (scene.ambient_illuminance > 0) {
        made.text +=
            format("\nThe ambient constant of the file, %.4g lx, is not counted: it stands for all but the lamps.\n",
                   double(scene.ambient_illuminance));
        made.json["ambient_illuminance_lx"] = scene.ambient_illuminance;
    }
    return made;
}

}  // namespace vesper::commands
