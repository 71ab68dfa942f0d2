// Adding up a scene. SPDX-License-Identifier: MIT
#include "scene/scene_report.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <unordered_map>

#include "base/budget.h"
#include "base/srgb.h"
#include "scene/colour.h"
#include "scene/fixtures.h"
#include "scene/lamp.h"
#include "scene/reflectance.h"
#include "scene/scene_warnings.h"

namespace vesper::scene {
namespace {

struct ReportedLamp {
    uint32_t node = 0;
    glm::dvec3 position{0};
    size_t report = 0;
    double lowest = HUGE_VAL, highest = -HUGE_VAL;  // surfaces in the lamp's vertical, m
};

/// A name without the number at its end, which tells lamps of one kind apart.
std::string stem_of(std::string name) {
    size_t end = name.size();
    while (end > 0 && std::isdigit(static_cast<unsigned char>(name[end - 1]))) --end;
    while (end > 0 && end < name.size() && std::string("._- ").find(name[end - 1]) != std::string::npos) --end;
    return end > 0 ? name.substr(0, end) : name;
}

FixtureRule rule_of(const Node& node) {
    if (!node.fixture) return FixtureRule::Own;
    return *node.fixture == kNone ? FixtureRule::None : FixtureRule::Named;
}

/// What lamps that are reported together share.
auto group_of(const Lamp& l, FixtureRule rule) {
    return std::tuple(stem_of(l.name), rule, l.kind, l.intensity, l.colour.r, l.colour.g, l.colour.b, l.inner_cone,
                      l.outer_cone, l.exponent, l.distribution);
}

/// The greatest luminance of a colour times a picture of sRGB codes, of the colour's unit.
double largest_luminance(glm::vec3 colour, const Image& image) {
    std::array<double, 256> linear;
    for (size_t code = 0; code < linear.size(); ++code) linear[code] = srgb_to_linear(double(code) / 255);
    double largest = 0;
    for (size_t i = 0; i < image.rgba.size(); i += 4)
        largest = std::max(largest,
                           luminance(glm::dvec3(colour) * glm::dvec3(linear[image.rgba[i]], linear[image.rgba[i + 1]],
                                                                     linear[image.rgba[i + 2]])));
    return largest;
}

std::vector<ReportedLamp> reported_lamps(const Scene& scene, const std::vector<glm::dmat4>& world,
                                         SceneReport& report) {
    std::vector<ReportedLamp> lamps;
    std::map<decltype(group_of({}, {})), size_t> place;
    for (uint32_t i = 0; i < scene.nodes.size(); ++i) {
        const uint32_t index = scene.nodes[i].lamp;
        if (index == kNone) continue;
        const Lamp& lamp = scene.lamps[index];
        const FixtureRule rule = rule_of(scene.nodes[i]);
        const auto [entry, added] = place.try_emplace(group_of(lamp, rule), report.lamps.size());
        if (added) {
            LampReport made{.name = lamp.name, .kind = lamp.kind, .candela = static_cast<double>(lamp.intensity)};
            made.colour = lamp.colour, made.fixture = rule;
            if (lamp.kind == Lamp::Kind::Measured) {
                const photometry::Distribution& d = scene.distributions[lamp.distribution];
                made.lumens = made.candela * photometry::luminous_flux(d);
                made.candela *= photometry::largest_intensity(d);
            } else if (lamp.kind != Lamp::Kind::Directional) {
                made.lumens = luminous_flux(lamp);
            }
            report.lamps.push_back(made);
        }
        LampReport& alike = report.lamps[entry->second];
        ++alike.number;
        report.lumens += alike.lumens;
        if (lamp.kind != Lamp::Kind::Directional) lamps.push_back({i, glm::dvec3(world[i][3]), entry->second});
    }
    return lamps;
}

/// Notes a triangle that crosses the vertical through a lamp.
void look_for(ReportedLamp& lamp, const std::array<glm::dvec3, 3>& corner) {
    const glm::dvec2 p(lamp.position.x, lamp.position.z);
    const auto flat = [&](size_t i) { return glm::dvec2(corner[i].x, corner[i].z) - p; };
    const auto cross = [](glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; };
    const double w[3] = {cross(flat(1), flat(2)), cross(flat(2), flat(0)), cross(flat(0), flat(1))};
    const double sum = w[0] + w[1] + w[2];
    if (sum == 0) return;
    for (const double part : w)
        if (part / sum < 0) return;
    const double y = (w[0] * corner[0].y + w[1] * corner[1].y + w[2] * corner[2].y) / sum;
    lamp.lowest = std::min(lamp.lowest, y);
    lamp.highest = std::max(lamp.highest, y);
}

/// A primitive's own figures, which placing it many times does not change.
struct PrimitiveSize {
    double area = 0;
    glm::dvec3 low{HUGE_VAL}, high{-HUGE_VAL};
};

PrimitiveSize size_of(const Primitive& primitive) {
    PrimitiveSize size;
    for (size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
        std::array<glm::dvec3, 3> corner;
        for (size_t k = 0; k < 3; ++k) {
            corner[k] = glm::dvec3(primitive.vertices[primitive.indices[i + k]].position);
            size.low = glm::min(size.low, corner[k]), size.high = glm::max(size.high, corner[k]);
        }
        size.area += glm::length(glm::cross(corner[1] - corner[0], corner[2] - corner[0])) / 2;
    }
    return size;
}

/// The factor that a transform has on every area; none where that depends on the direction.
std::optional<double> area_factor(const glm::dmat4& m) {
    const glm::dvec3 x(m[0]), y(m[1]), z(m[2]);
    const double scale = glm::dot(x, x), near = 1e-6 * scale;
    const bool same = std::abs(glm::dot(y, y) - scale) <= near && std::abs(glm::dot(z, z) - scale) <= near;
    const bool square =
        std::abs(glm::dot(x, y)) <= near && std::abs(glm::dot(y, z)) <= near && std::abs(glm::dot(z, x)) <= near;
    return same && square ? std::optional(scale) : std::nullopt;
}

class Measure {
public:
    Measure(const Scene& scene, std::vector<ReportedLamp>& lamps) : lamps_(lamps), area_(scene.materials.size()) {
        std::sort(lamps_.begin(), lamps_.end(),
                  [](const ReportedLamp& a, const ReportedLamp& b) { return a.position.x < b.position.x; });
    }
    /// Triangles are gone through only where the figures of the whole do not tell: a mesh may be shown by a million
    /// nodes.
    void add(const Primitive& primitive, const glm::dmat4& world) {
        const auto [entry, added] = sizes_.try_emplace(&primitive);
        PrimitiveSize& size = entry->second;
        if (added) size = size_of(primitive);
        triangles += primitive.indices.size() / 3;
        const std::optional<double> factor = area_factor(world);
        if (factor) area_[primitive.material] += size.area * *factor;
        if (!factor || may_matter(size, world)) look_at_triangles(primitive, world, !factor);
    }
    glm::dvec3 extent() const { return triangles ? high_ - low_ : glm::dvec3(0); }
    double area(size_t material) const { return area_[material]; }
    uint64_t triangles = 0;

private:
    /// Whether the box around a placed primitive reaches beyond the extent so far, or a lamp stands over or under it.
    bool may_matter(const PrimitiveSize& size, const glm::dmat4& world) const {
        if (!(size.low.x <= size.high.x)) return false;
        glm::dvec3 low(HUGE_VAL), high(-HUGE_VAL);
        for (int i = 0; i < 8; ++i) {
            const glm::dvec3 corner(i & 1 ? size.high.x : size.low.x, i & 2 ? size.high.y : size.low.y,
                                    i & 4 ? size.high.z : size.low.z);
            const glm::dvec3 placed(world * glm::dvec4(corner, 1));
            low = glm::min(low, placed), high = glm::max(high, placed);
        }
        if (glm::any(glm::lessThan(low, low_)) || glm::any(glm::greaterThan(high, high_))) return true;
        const glm::dvec3 margin = 1e-9 * (glm::abs(low) + glm::abs(high));  // of rounding
        auto lamp = first_lamp(low.x - margin.x);
        for (; lamp != lamps_.end() && lamp->position.x <= high.x + margin.x; ++lamp)
            if (lamp->position.z >= low.z - margin.z && lamp->position.z <= high.z + margin.z) return true;
        return false;
    }
    std::vector<ReportedLamp>::iterator first_lamp(double x) const {
        return std::lower_bound(lamps_.begin(), lamps_.end(), x,
                                [](const ReportedLamp& a, double from) { return a.position.x < from; });
    }
    void look_at_triangles(const Primitive& primitive, const glm::dmat4& world, bool add_area) {
        const glm::dvec3 none(HUGE_VAL);
        for (size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
            check_time();
            std::array<glm::dvec3, 3> corner;
            glm::dvec3 low = none, high = -none;
            for (size_t k = 0; k < 3; ++k) {
                const Vertex& vertex = primitive.vertices[primitive.indices[i + k]];
                corner[k] = glm::dvec3(world * glm::dvec4(glm::dvec3(vertex.position), 1));
                low = glm::min(low, corner[k]), high = glm::max(high, corner[k]);
            }
            if (add_area)
                area_[primitive.material] += glm::length(glm::cross(corner[1] - corner[0], corner[2] - corner[0])) / 2;
            low_ = glm::min(low_, low), high_ = glm::max(high_, high);
            for (auto lamp = first_lamp(low.x); lamp != lamps_.end() && lamp->position.x <= high.x; ++lamp)
                if (lamp->position.z >= low.z && lamp->position.z <= high.z) {
                    check_time();
                    look_for(*lamp, corner);
                }
        }
    }

    std::vector<ReportedLamp>& lamps_;
    std::vector<double> area_;
    std::unordered_map<const Primitive*, PrimitiveSize> sizes_;
    glm::dvec3 low_{HUGE_VAL}, high_{-HUGE_VAL};
};

void report_heights(const std::vector<ReportedLamp>& lamps, SceneReport& report) {
    for (const ReportedLamp& lamp : lamps) {
        LampReport& into = report.lamps[lamp.report];
        const double height = lamp.position.y - lamp.lowest;
        if (height >= 0 && height < HUGE_VAL) {
            into.lowest = std::min(into.lowest.value_or(height), height);
            into.highest = std::max(into.highest.value_or(height), height);
        } else {
            ++into.over_nothing;
            into.under_ground += lamp.highest > lamp.position.y;
        }
    }
}

void report_fixtures(const Scene& scene, const std::vector<ReportedLamp>& lamps, const std::vector<glm::dmat4>& world,
                     SceneReport& report) {
    std::vector<uint32_t> nodes;
    for (const ReportedLamp& lamp : lamps) nodes.push_back(lamp.node);
    const std::vector<std::vector<uint32_t>> fixtures = fixture_nodes(scene, nodes, world);
    std::vector<bool> known(report.lamps.size());
    for (size_t i = 0; i < lamps.size(); ++i) {
        LampReport& into = report.lamps[lamps[i].report];
        const size_t meshes = fixtures[i].size();
        into.least_meshes = known[lamps[i].report] ? std::min(into.least_meshes, meshes) : meshes;
        into.most_meshes = std::max(into.most_meshes, meshes);
        known[lamps[i].report] = true;
    }
}

}  // namespace

SceneReport report_scene(const Scene& scene) {
    SceneReport report;
    const std::vector<glm::dmat4> world = world_transforms(scene, 0);
    std::vector<ReportedLamp> lamps = reported_lamps(scene, world, report);
    Measure measure(scene, lamps);
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        if (node.mesh != kNone)
            for (const Primitive& primitive : scene.meshes[node.mesh].primitives) measure.add(primitive, world[i]);
        if (node.camera == kNone) continue;
        const std::string& name = scene.cameras[node.camera].name;
        report.cameras.push_back(name.empty() ? node.name : name);
    }
    report_heights(lamps, report);
    report_fixtures(scene, lamps, world, report);
    report.extent = measure.extent();
    report.triangles = measure.triangles;
    double reflected = 0;
    const std::vector<MaterialUse> uses = material_uses(scene);
    for (size_t i = 0; i < scene.materials.size(); ++i) {
        const double area = measure.area(i);
        if (!(area > 0)) continue;
        const Material& m = scene.materials[i];
        MaterialReport made{.name = m.name, .reflectance = mean_reflectance(scene, m, uses[i])};
        made.roughness = static_cast<double>(m.roughness);
        made.metallic = static_cast<double>(m.metallic);
        made.textured = m.base_colour_texture.image != kNone;
        made.emission = luminance(m.emission);
        if (m.emission_picture.image != kNone) {
            const photometry::LuminancePicture& picture = scene.luminance_pictures[m.emission_picture.image];
            made.picture = picture.name;
            made.mean_emission = made.emission * luminance(photometry::mean_colour(picture));
            made.emission *= photometry::largest_luminance(picture);
        } else if (m.emission_texture.image != kNone) {
            made.emission = largest_luminance(m.emission, scene.images[m.emission_texture.image]);
        }
        if (m.reflection_table != kNone) made.road_table = scene.reflection_tables[m.reflection_table].name;
        made.area = area;
        reflected += area * made.reflectance * (m.metallic_roughness_texture.image == kNone ? 1 - made.metallic : 1);
        report.area += area;
        report.materials.push_back(made);
    }
    if (report.area > 0) report.mean_reflectance = reflected / report.area;
    warn_of(scene, report);
    return report;
}

const char* name_of(Lamp::Kind kind) {
    switch (kind) {
        case Lamp::Kind::Point:
            return "point";
        case Lamp::Kind::Spot:
            return "spot";
        case Lamp::Kind::CosinePower:
            return "cosine_power";
        case Lamp::Kind::Directional:
            return "directional";
        case Lamp::Kind::Measured:
            return "measured";
    }
    return "";
}

const char* name_of(FixtureRule rule) {
    return rule == FixtureRule::Own ? "own" : rule == FixtureRule::None ? "none" : "named";
}

}  // namespace vesper::scene
