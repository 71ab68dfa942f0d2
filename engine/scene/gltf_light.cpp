// Lamps of a glTF file, and what our extras block says of them, the ambient light and the sky.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "scene/colour.h"
#include "scene/gltf_reader.h"

namespace vesper::scene {
namespace {

glm::dvec3 rgb_of(const JsonValue& value) {
    const auto c = value.numbers<3, double>(0);
    return {c[0], c[1], c[2]};
}

/// KHR_lights_punctual multiplies colour by intensity; we keep a colour of luminance 1, so that intensity is what a
/// photometer measures.
void normalise(Lamp& lamp, double stored_intensity, glm::dvec3 stored_colour, const JsonValue& source) {
    const double y = luminance(stored_colour);
    lamp.intensity = static_cast<float>(stored_intensity * y);
    lamp.colour = y > 0 ? glm::vec3(stored_colour / y) : glm::vec3(1);
    if (!std::isfinite(lamp.intensity) || !std::isfinite(lamp.colour.r + lamp.colour.g + lamp.colour.b))
        source.fail("intensity times colour is not finite");
}

void read_cones(Lamp& lamp, const JsonValue& source) {
    constexpr double kRight = kPi / 2;
    // Blender and others write a hair more than a right angle.
    lamp.outer_cone =
        static_cast<float>(std::min(source.number_or("outerConeAngle", kRight / 2, 0, kRight + 0.01), kRight));
    lamp.inner_cone = static_cast<float>(source.number_or("innerConeAngle", 0, 0, kRight + 0.01));
    if (lamp.outer_cone < 1e-3f) source.fail("outerConeAngle must be more than 0.001");
    // The ramp between the cones must have a width.
    lamp.inner_cone = std::min(lamp.inner_cone, lamp.outer_cone * 0.9999f);
}

Lamp read_light(GltfReader& reader, const JsonValue& source) {
    Lamp lamp;
    lamp.name = source.text_or("name", "");
    const std::string& type = source.at("type").text();
    if (type == "point")
        lamp.kind = Lamp::Kind::Point;
    else if (type == "spot")
        lamp.kind = Lamp::Kind::Spot;
    else if (type == "directional")
        lamp.kind = Lamp::Kind::Directional;
    else {
        reader.notes.add("a light of a type that glTF does not have is left out");
        reader.unknown_lights.insert(static_cast<uint32_t>(reader.scene.lamps.size()));
    }
    const auto colour = source.find("color");
    normalise(lamp, source.number_or("intensity", 1, 0), colour ? rgb_of(*colour) : glm::dvec3(1), source);
    if (const auto spot = source.find("spot"); spot && lamp.kind == Lamp::Kind::Spot) {
        read_cones(lamp, *spot);
        constexpr double kNarrow = 0.5 * kRadiansPerDegree;
        if (lamp.outer_cone < kNarrow)
            reader.notes.add(
                "a spot light of less than 0.5 degrees to either side gives more light than it says, and wider");
    }
    if (source.find("range")) reader.notes.add("the range of a light is ignored: light follows the square law");
    return lamp;
}

void read_lobe(GltfReader& reader, const JsonValue& lobe) {
    lobe.allow_only({"light", "type", "exponent"});
    Lamp& lamp = reader.scene.lamps[lobe.at("light").index(reader.scene.lamps.size(), "lights")];
    if (lobe.at("type").text() != "cosine_power") lobe.at("type").fail("is no lobe this version knows: cosine_power");
    lamp.kind = Lamp::Kind::CosinePower;
    lamp.exponent = static_cast<float>(lobe.at("exponent").number(0, 1e5));
}

/// Where the light of a punctual light, or of all uses of a light profile, comes out.
void read_opening(GltfReader& reader, const JsonValue& source) {
    if (const auto diameter = source.find("angular_diameter_deg")) {
        source.allow_only({"light", "angular_diameter_deg"});
        Lamp& lamp = reader.scene.lamps[source.at("light").index(reader.scene.lamps.size(), "lights")];
        if (lamp.kind != Lamp::Kind::Directional) diameter->fail("is of directional lights alone");
        lamp.angular_diameter = float(diameter->number(0, kMostAngularDiameter) * kRadiansPerDegree);
        return;
    }
    source.allow_only({"light", "profile", "width_m", "height_m", "round", "drawn"});
    photometry::LuminousOpening opening;
    opening.length = source.at("width_m").number(1e-4, 100);
    opening.width = source.at("height_m").number(1e-4, 100);
    opening.round = source.boolean_or("round", false);
    opening.drawn = source.boolean_or("drawn", true);
    if (const auto profile = source.find("profile")) {
        if (source.find("light")) profile->fail("is given beside light: one of them is wanted");
        reader.profile_openings.resize(reader.scene.distributions.size());
        reader.profile_openings[profile->index(reader.scene.distributions.size(), "profiles")] = opening;
        return;
    }
    Lamp& lamp = reader.scene.lamps[source.at("light").index(reader.scene.lamps.size(), "lights")];
    if (lamp.kind == Lamp::Kind::Directional) source.at("light").fail("a directional light has no opening");
    lamp.opening = opening;
}

/// {"<quantity>": number, "colour": [r, g, b]}; the colour is brought to luminance 1.
void read_uniform(const JsonValue& source, const char* quantity, float& value, glm::vec3& colour) {
    source.allow_only({quantity, "colour"});
    value = static_cast<float>(source.at(quantity).number(0));
    const auto stated = source.find("colour");
    if (!stated) return;
    const glm::dvec3 rgb = rgb_of(*stated);
    if (!(luminance(rgb) > 0)) stated->fail("must not be black");
    colour = glm::vec3(rgb / luminance(rgb));
}

std::optional<JsonValue> photometry_block(const GltfReader& reader) {
    const auto extras = reader.document.root().find("extras");
    return extras && extras->json().is_object() ? extras->find("vesper") : std::nullopt;
}

/// The meshes that never hide the lamp of a node.
void read_fixture(GltfReader& reader, const JsonValue& source) {
    source.allow_only({"node", "fixture"});
    const size_t count = reader.node_of.size();
    const JsonValue node = source.at("node"), fixture = source.at("fixture");
    const uint32_t lamp = reader.node_of[node.index(count, "nodes")];
    uint32_t named = kNone;
    if (!fixture.json().is_string()) {
        named = reader.node_of[fixture.index(count, "nodes")];
        if (named == kNone) fixture.fail("is a node that the scene does not show");
    } else if (fixture.text() != "none") {
        fixture.fail("is neither \"none\" nor the index of a node");
    }
    if (lamp == kNone) return;  // not shown
    Node& holder = reader.scene.nodes[lamp];
    if (holder.lamp == kNone || reader.scene.lamps[holder.lamp].kind == Lamp::Kind::Directional)
        node.fail("has no lamp");
    if (holder.fixture) node.fail("is named twice");
    holder.fixture = named;
}

}  // namespace

void read_lights(GltfReader& reader) {
    const auto extensions = reader.document.root().find("extensions");
    const auto punctual = extensions ? extensions->find("KHR_lights_punctual") : std::nullopt;
    if (!punctual) return;
    const auto lamps = punctual->elements_of("lights");
    if (lamps.size() > reader.limits.lamps)
        punctual->fail("more lights than the limit of " + std::to_string(reader.limits.lamps));
    for (const JsonValue& lamp : lamps) reader.scene.lamps.push_back(read_light(reader, lamp));
    reader.punctual_lights = static_cast<uint32_t>(lamps.size());
}

void read_photometry_block(GltfReader& reader) {
    const auto block = photometry_block(reader);
    if (!block) return;
    reader.photometric = true;
    const JsonValue version = block->at("version");
    if (version.integer() != 1)
        version.fail("vesper extras of version " + std::to_string(version.integer()) +
                     ": this program reads version 1");
    block->allow_only({"version", "transfer", "ambient", "sky", "environment", "lobes", "openings", "fixtures",
                       "reflection_tables", "roads", "retroreflectors", "retroreflective", "luminance_pictures",
                       "luminous", "provenance"});
    if (const auto transfer = block->find("transfer")) {
        transfer->allow_only({"kind", "gamma"});
        const std::string& kind = transfer->at("kind").text();
        if (kind != "gamma" && kind != "srgb") transfer->at("kind").fail("is neither gamma nor srgb");
        reader.scene.transfer.kind = kind == "gamma" ? Transfer::Kind::Gamma : Transfer::Kind::Srgb;
        reader.scene.transfer.gamma = static_cast<float>(transfer->number_or("gamma", 2.2, 0.1, 10));
    }
    if (const auto ambient = block->find("ambient"))
        read_uniform(*ambient, "illuminance_lx", reader.scene.ambient_illuminance, reader.scene.ambient_colour);
    if (const auto sky = block->find("sky"))
        read_uniform(*sky, "luminance_cd_m2", reader.scene.sky_luminance, reader.scene.sky_colour);
    for (const JsonValue& lobe : block->elements_of("lobes")) read_lobe(reader, lobe);
    if (const auto environment = block->find("environment")) read_environment(reader, *environment);
    for (const JsonValue& opening : block->elements_of("openings")) read_opening(reader, opening);
    read_reflection_tables(reader, *block);
    read_retroreflectors(reader, *block);
    read_luminance_pictures(reader, *block);
}

void read_fixtures(GltfReader& reader) {
    if (const auto block = photometry_block(reader))
        for (const JsonValue& fixture : block->elements_of("fixtures")) read_fixture(reader, fixture);
}

}  // namespace vesper::scene
