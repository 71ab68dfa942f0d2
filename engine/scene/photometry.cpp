// Reading the photometry file, strictly: what is misspelt must not be ignored in silence. SPDX-License-Identifier: MIT
#include "scene/photometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/angle.h"
#include "base/budget.h"
#include "io/read_file.h"
#include "scene/colour.h"
#include "scene/json_value.h"
#include "scene/photometry_measured.h"
#include "scene/photometry_parts.h"
#include "scene/reflection_json.h"

namespace vesper::scene {
namespace {

constexpr uint64_t kMaxPhotometryBytes = 64u << 20;

glm::dvec3 read_vector(const JsonValue& value) {
    const auto v = value.numbers<3>();
    return {v[0], v[1], v[2]};
}

}  // namespace

glm::dvec3 read_colour(const JsonValue& holder, double* kelvin) {
    const auto temperature = holder.find("colour_temperature_K"), rgb = holder.find("colour_rgb");
    if (temperature && rgb) rgb->fail("is given beside colour_temperature_K: one of them is wanted");
    if (temperature) {
        const double stated = temperature->number(1000, 25000);
        if (kelvin) *kelvin = stated;
        return colour_of_temperature(stated);
    }
    if (!rgb) return glm::dvec3(1);
    const auto c = rgb->numbers<3>(0, 1e4);
    const glm::dvec3 colour(c[0], c[1], c[2]);
    if (!(luminance(colour) > 1e-6)) rgb->fail("must not be black");
    return colour / luminance(colour);
}

void allow_in_rule(const JsonValue& rule, std::vector<const char*> keys) {
    keys.push_back("comment");
    rule.allow_only(keys);
    if (const auto comment = rule.find("comment")) comment->text();
}

std::vector<std::string> read_patterns(const JsonValue& rule, const char* key) {
    const JsonValue value = rule.at(key);
    std::vector<std::string> patterns;
    if (value.json().is_array())
        for (const JsonValue& element : value.elements()) patterns.push_back(element.text());
    else
        patterns.push_back(value.text());
    if (patterns.empty()) value.fail("must name at least one pattern");
    if (std::any_of(patterns.begin(), patterns.end(), [](const std::string& p) { return p.empty(); }))
        value.fail("must not contain an empty pattern");
    return patterns;
}

namespace {

void read_lobe(Lamp& lamp, const JsonValue& rule) {
    const JsonValue type = rule.at("type");
    if (type.text() == "point") {
        allow_in_rule(rule, {"name", "nodes", "type", "intensity_cd", "colour_temperature_K", "colour_rgb", "offset_m",
                             "opening", "fixture"});
        lamp.kind = Lamp::Kind::Point;
    } else if (type.text() == "spot") {
        allow_in_rule(rule, {"name", "nodes", "type", "intensity_cd", "colour_temperature_K", "colour_rgb", "offset_m",
                             "opening", "fixture", "aim", "inner_cone_deg", "outer_cone_deg"});
        lamp.kind = Lamp::Kind::Spot;
        const double outer = rule.at("outer_cone_deg").number(0.5, 90);
        const double inner = rule.number_or("inner_cone_deg", 0, 0, 90);
        if (inner > outer) rule.at("inner_cone_deg").fail("must not be more than outer_cone_deg");
        lamp.outer_cone = static_cast<float>(outer * kRadiansPerDegree);
        // KHR_lights_punctual wants the inner angle to be less.
        lamp.inner_cone = static_cast<float>(std::min(inner, outer * 0.9999) * kRadiansPerDegree);
    } else if (type.text() == "cosine_power") {
        allow_in_rule(rule, {"name", "nodes", "type", "intensity_cd", "colour_temperature_K", "colour_rgb", "offset_m",
                             "opening", "fixture", "aim", "exponent"});
        lamp.kind = Lamp::Kind::CosinePower;
        lamp.exponent = static_cast<float>(rule.at("exponent").number(0, 1e5));
        // For viewers that know only spots: the cone ends where the lobe has fallen to a thousandth.
        const double edge = std::acos(std::pow(1e-3, 1 / std::max<double>(lamp.exponent, 1e-3)));
        lamp.inner_cone = 0;
        lamp.outer_cone = static_cast<float>(std::min(edge, std::numbers::pi / 2));
    } else {
        type.fail("is none of point, spot, cosine_power and distribution");
    }
}

/// Intensity and axis of a lamp that has a lobe.
void read_shape(LampRule& rule, const JsonValue& source) {
    read_lobe(rule.lamp, source);
    rule.lamp.intensity = static_cast<float>(source.at("intensity_cd").number(0, 1e9));
    if (!(rule.lamp.intensity > 0)) source.at("intensity_cd").fail("must be more than 0");
    if (const auto aim = source.find("aim")) {
        const glm::dvec3 axis = read_vector(*aim);
        if (!(glm::length(axis) > 1e-6)) aim->fail("must not be of length 0");
        rule.aim = glm::normalize(axis);
    }
}

/// Where the light comes out: {"width_m", "height_m", "round", "drawn"}, or "file".
photometry::LuminousOpening read_opening(const JsonValue& source, const LampRule& rule, const Photometry& made) {
    constexpr double kSmallest = 1e-4, kLargest = 100;
    if (source.json().is_string()) {
        if (source.text() != "file") source.fail("is neither an object nor \"file\"");
        if (rule.lamp.kind != Lamp::Kind::Measured) source.fail("\"file\" is for lamps of type distribution");
        const photometry::LuminousOpening& stated = made.measured[rule.lamp.distribution].distribution.opening;
        if (std::min(stated.length, stated.width) < kSmallest || std::max(stated.length, stated.width) > kLargest)
            source.fail("the file states no luminous area that can be seen");
        return {.length = stated.length, .width = stated.width, .height = 0, .round = stated.round};
    }
    source.allow_only({"width_m", "height_m", "round", "drawn"});
    photometry::LuminousOpening opening;
    opening.drawn = source.boolean_or("drawn", true);
    opening.round = source.boolean_or("round", false);
    opening.length = source.at("width_m").number(kSmallest, kLargest);
    opening.width = opening.round ? source.number_or("height_m", opening.length, kSmallest, kLargest)
                                  : source.at("height_m").number(kSmallest, kLargest);
    return opening;
}

LampRule read_lamp(const JsonValue& source, const std::filesystem::path& folder, Photometry& made) {
    LampRule rule;
    if (source.at("type").text() == "distribution")
        read_measured(source, folder, made, rule);
    else
        read_shape(rule, source);
    rule.nodes = read_patterns(source, "nodes");
    rule.name = source.text_or("name", rule.nodes.front());
    rule.lamp.name = rule.name;
    rule.lamp.colour = glm::vec3(read_colour(source, &rule.kelvin));
    if (const auto offset = source.find("offset_m")) rule.offset = read_vector(*offset);
    if (const auto opening = source.find("opening")) rule.lamp.opening = read_opening(*opening, rule, made);
    if (const auto fixture = source.find("fixture")) {
        rule.fixture = fixture->text(), rule.fixture_place = fixture->place();
        if (rule.fixture.empty()) fixture->fail("must be \"own\", \"none\" or the name of a node");
    }
    return rule;
}

SurfaceRule read_surface(const JsonValue& source, const std::filesystem::path& folder) {
    allow_in_rule(source, {"name", "materials", "reflectance_scale", "roughness", "metallic", "reflection_table", "q0",
                           "retroreflection"});
    SurfaceRule rule;
    rule.materials = read_patterns(source, "materials");
    rule.name = source.text_or("name", rule.materials.front());
    rule.reflectance_scale = source.number_or("reflectance_scale", 1, 0, 100);
    if (const auto roughness = source.find("roughness")) rule.roughness = roughness->number(0, 1);
    if (const auto metallic = source.find("metallic")) rule.metallic = metallic->number(0, 1);
    if (source.find("reflection_table"))
        rule.reflection_table = read_named_table(source, folder);
    else if (const auto q0 = source.find("q0"))
        q0->fail("has a meaning only beside a reflection_table");
    if (rule.reflection_table)
        for (const char* key : {"reflectance_scale", "roughness", "metallic"})
            if (const auto beside = source.find(key))
                beside->fail("has no meaning beside reflection_table, which is the whole of a surface (q0 scales it)");
    if (const auto retroreflection = source.find("retroreflection")) {
        if (const auto metallic = source.find("metallic"); metallic && rule.metallic > 0.0)
            metallic->fail("has no meaning beside retroreflection: such a surface is no metal");
        if (rule.reflection_table) retroreflection->fail("is given beside reflection_table: one of them is wanted");
        rule.retroreflector = read_retroreflection(*retroreflection);
    }
    return rule;
}

ColouredQuantity read_quantity(const JsonValue& source, const char* key, double high) {
    source.allow_only({key, "colour_temperature_K", "colour_rgb"});
    return {source.at(key).number(0, high), read_colour(source)};
}

Transfer read_transfer(const JsonValue& textures) {
    textures.allow_only({"transfer", "gamma"});
    Transfer transfer{Transfer::Kind::Gamma, 2.2f};
    const auto kind = textures.find("transfer");
    if (kind && kind->text() == "srgb")
        transfer.kind = Transfer::Kind::Srgb;
    else if (kind && kind->text() != "gamma")
        kind->fail("is neither gamma nor srgb");
    const auto gamma = textures.find("gamma");
    if (gamma && transfer.kind == Transfer::Kind::Srgb) gamma->fail("has no meaning beside the transfer srgb");
    if (gamma) transfer.gamma = static_cast<float>(gamma->number(0.1, 10));
    return transfer;
}

/// Wildcards match any character but `barrier` (0: none). Backtracks to the last star only: at most |pattern| |text|.
bool matches(const char* pattern, const char* text, char barrier) {
    const char *star = nullptr, *retry = nullptr;
    while (*text) {
        check_time();
        if (*pattern == '*') {
            star = pattern++;
            retry = text;
        } else if (*pattern == '?' && *text != barrier) {
            ++pattern, ++text;
            while ((static_cast<unsigned char>(*text) & 0xc0) == 0x80) ++text;  // the rest of a UTF-8 character
        } else if (*pattern == *text) {
            ++pattern, ++text;
        } else if (star && *retry != barrier) {
            pattern = star + 1;
            text = ++retry;
        } else {
            return false;
        }
    }
    while (*pattern == '*') ++pattern;
    return *pattern == 0;
}

}  // namespace

Photometry read_photometry(const std::filesystem::path& file) {
    const JsonFile json = parse_json(io::read_file(file, kMaxPhotometryBytes), file.string());
    const JsonValue root(json);
    allow_in_rule(root, {"$schema", "version", "textures", "ambient", "sky", "directional", "lights", "lamps",
                         "emitters", "surfaces"});
    const JsonValue version = root.at("version");
    if (version.integer() != 1) version.fail("must be 1: this program knows no other");
    Photometry made{.file = file};
    if (const auto textures = root.find("textures")) made.transfer = read_transfer(*textures);
    if (const auto ambient = root.find("ambient")) made.ambient = read_quantity(*ambient, "illuminance_lx", 2e5);
    if (const auto sky = root.find("sky")) {
        if (sky->find("image"))
            made.sky_picture = read_sky_picture(*sky, file.parent_path());
        else
            made.sky = read_quantity(*sky, "luminance_cd_m2", 1e6);
    }
    for (const JsonValue& rule : root.elements_of("directional")) made.directional.push_back(read_directional(rule));
    if (const auto lamps = root.find("lights")) {
        lamps->allow_only({"keep"});
        made.keep_lights = lamps->boolean_or("keep", false);
    }
    for (const JsonValue& rule : root.elements_of("lamps"))
        made.lamps.push_back(read_lamp(rule, file.parent_path(), made));
    for (const JsonValue& rule : root.elements_of("emitters"))
        made.emitters.push_back(read_emitter(rule, file.parent_path(), made));
    for (const JsonValue& rule : root.elements_of("surfaces"))
        made.surfaces.push_back(read_surface(rule, file.parent_path()));
    return made;
}

bool matches_name(const std::string& pattern, const std::string& name) {
    return matches(pattern.c_str(), name.c_str(), 0);
}

bool matches_path(const std::string& pattern, const std::vector<std::string>& path) {
    if (path.empty()) return false;
    const auto slashes = std::count(pattern.begin(), pattern.end(), '/');
    if (slashes == 0) return matches_name(pattern, path.front());
    // Names may hold slashes themselves, so there can be several ends of the path with the right number of them.
    std::string end;
    for (const std::string& name : path) {
        end = end.empty() ? name : name + "/" + end;
        const auto there = std::count(end.begin(), end.end(), '/');
        if (there > slashes) return false;
        if (there == slashes && matches(pattern.c_str(), end.c_str(), '/')) return true;
    }
    return false;
}

bool matches_node(const std::string& pattern, const Scene& scene, uint32_t node) {
    const auto most = size_t(std::count(pattern.begin(), pattern.end(), '/')) + 1;  // names that can match
    std::vector<std::string> path;
    for (; node != kNone && path.size() < most; node = scene.nodes[node].parent) path.push_back(scene.nodes[node].name);
    return matches_path(pattern, path);
}

}  // namespace vesper::scene
