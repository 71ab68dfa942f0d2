#include "scene/gltf_parts.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/luminance.h"
#include "photometry/ies.h"
#include "scene/photometry_parts.h"
#include "scene/reflection_json.h"

namespace vesper::scene {
namespace {

using nlohmann::json;

json json_of(glm::dvec3 v) { return {v.x, v.y, v.z}; }

/// The colour of luminance 1, in double, of which these are the floats. Readers divide by the luminance and get the
/// same floats again, which they would not of a colour whose luminance is 1 up to its rounding alone.
glm::dvec3 of_luminance_one(glm::vec3 colour) {
    const double excess = luminance(colour) - 1;
    glm::dvec3 room;  // to either side, in which a number rounds to its float
    for (int c = 0; c < 3; ++c) room[c] = (double(colour[c]) - double(std::nextafter(colour[c], 0.0f))) / 2;
    const double most = luminance(room);
    return std::abs(excess) < most ? glm::dvec3(colour) - excess / most * room : glm::dvec3(colour);
}

/// Intensity and colour as extensions state them: the largest component is 1; intensity times luminance is the lamp's.
struct StatedLight {
    glm::dvec3 colour;
    double intensity;
};

StatedLight stated(const Lamp& lamp) {
    const glm::dvec3 colour = of_luminance_one(lamp.colour), made = colour / std::max({colour.r, colour.g, colour.b});
    return {made, double(lamp.intensity) / luminance(made)};
}

void add_opening(json& openings, const char* of, size_t index, const photometry::LuminousOpening& opening) {
    if (!(opening.area() > 0)) return;
    openings.push_back({{of, index}, {"width_m", opening.length}, {"height_m", opening.width}});
    if (opening.round) openings.back()["round"] = true;
    if (!opening.drawn) openings.back()["drawn"] = false;
}

json light_of(const Lamp& lamp) {
    const StatedLight light = stated(lamp);
    const bool spot = lamp.kind == Lamp::Kind::Spot || lamp.kind == Lamp::Kind::CosinePower;
    json made = {{"name", lamp.name},
                 {"type", spot                                   ? "spot"
                          : lamp.kind == Lamp::Kind::Directional ? "directional"
                                                                 : "point"},
                 {"intensity", light.intensity},
                 {"color", json_of(light.colour)}};
    if (spot) made["spot"] = {{"innerConeAngle", lamp.inner_cone}, {"outerConeAngle", lamp.outer_cone}};
    return made;
}

/// A light profile of the file: a distribution with the opening and the name of the lamps that have it.
struct Profile {
    uint32_t distribution;
    const Lamp* lamp;  ///< null where none has it

    bool serves(const Lamp& other) const {
        const photometry::LuminousOpening &a = lamp->opening, &b = other.opening;
        return distribution == other.distribution && lamp->name == other.name && a.length == b.length &&
               a.width == b.width && a.round == b.round && a.drawn == b.drawn;
    }
};

/// One for each distribution, in its order, and more where lamps of one distribution differ.
std::vector<Profile> profiles_of(const Scene& scene, size_t first) {
    std::vector<Profile> profiles;
    for (auto i = static_cast<uint32_t>(first); i < scene.distributions.size(); ++i) profiles.push_back({i, nullptr});
    for (const Lamp& lamp : scene.lamps) {
        if (lamp.kind != Lamp::Kind::Measured || lamp.distribution < first) continue;
        Profile& own = profiles.at(lamp.distribution - first);
        if (!own.lamp) own.lamp = &lamp;
        if (std::ranges::none_of(profiles, [&](const Profile& p) { return p.lamp && p.serves(lamp); }))
            profiles.push_back({lamp.distribution, &lamp});
    }
    return profiles;
}

json quantity(const char* name, float value, glm::vec3 colour) {
    return {{name, value}, {"colour", json_of(of_luminance_one(colour))}};
}

json transfer_of(const Transfer& transfer) {
    if (transfer.kind == Transfer::Kind::Srgb) return {{"kind", "srgb"}};
    const double shorter = std::round(double(transfer.gamma) * 1e4) / 1e4;  // 2.2f as a double has a long tail
    return {{"kind", "gamma"},
            {"gamma", static_cast<float>(shorter) == transfer.gamma ? shorter : double(transfer.gamma)}};
}

void add_tables(const Scene& scene, json& block) {
    for (const photometry::ReflectionTable& table : scene.reflection_tables)
        block["reflection_tables"].push_back(scene::json_of(table));
    for (const photometry::Retroreflector& one : scene.retroreflectors)
        block["retroreflectors"].push_back(scene::json_of(one));
    for (size_t m = 0; m < scene.materials.size(); ++m) {
        const Material& material = scene.materials[m];
        if (material.reflection_table != kNone)
            block["roads"].push_back({{"material", m}, {"table", material.reflection_table}});
        if (material.retroreflector != kNone)
            block["retroreflective"].push_back({{"material", m}, {"retroreflector", material.retroreflector}});
    }
}

}  // namespace

LampParts lamp_parts(const Scene& scene, size_t lights, size_t profiles, const AddView& add_view) {
    LampParts parts;
    const std::vector<Profile> written = profiles_of(scene, profiles);
    for (const Profile& profile : written) {
        const photometry::Distribution& distribution = scene.distributions[profile.distribution];
        const std::string text = photometry::write_ies(distribution);
        const size_t view = add_view({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
        if (profile.lamp)
            add_opening(parts.openings, "profile", profiles + parts.profiles.size(), profile.lamp->opening);
        parts.profiles.push_back({{"name", profile.lamp ? profile.lamp->name : distribution.name},
                                  {"bufferView", view},
                                  {"mimeType", "application/x-ies-lm-63"}});
    }
    size_t index = 0;  // in the list of punctual lights
    for (const Lamp& lamp : scene.lamps) {
        LampUse& use = parts.uses.emplace_back();
        if (lamp.kind == Lamp::Kind::Measured) {
            if (lamp.distribution < profiles) continue;
            const auto own = std::ranges::find_if(written, [&](const Profile& p) { return p.lamp && p.serves(lamp); });
            const StatedLight light = stated(lamp);
            use = {"EXT_lights_ies",
                   {{"light", profiles + static_cast<size_t>(own - written.begin())},
                    {"multiplier", light.intensity},
                    {"color", json_of(light.colour)}}};
            continue;
        }
        const size_t light = index++;
        if (light < lights) continue;
        use = {"KHR_lights_punctual", {{"light", light}}};
        parts.lights.push_back(light_of(lamp));
        if (lamp.kind == Lamp::Kind::CosinePower)
            parts.lobes.push_back({{"light", light}, {"type", "cosine_power"}, {"exponent", lamp.exponent}});
        add_opening(parts.openings, "light", light, lamp.opening);
        if (lamp.kind == Lamp::Kind::Directional && lamp.angular_diameter != Lamp{}.angular_diameter)
            parts.openings.push_back(
                {{"light", light},
                 {"angular_diameter_deg",
                  std::min(double(lamp.angular_diameter) * kDegreesPerRadian, kMostAngularDiameter)}});
    }
    return parts;
}

EmissionParts emission_parts(glm::dvec3 emission) {
    const double largest = std::max({emission.r, emission.g, emission.b});
    return largest > 0 ? EmissionParts{emission / largest, largest} : EmissionParts{};
}

json photometry_block(const Scene& scene, const LampParts& lamps, std::span<const uint32_t> file_nodes) {
    json block = {{"version", 1}, {"transfer", transfer_of(scene.transfer)}};
    block["ambient"] = quantity("illuminance_lx", scene.ambient_illuminance, scene.ambient_colour);
    if (!scene.environment) block["sky"] = quantity("luminance_cd_m2", scene.sky_luminance, scene.sky_colour);
    if (!lamps.lobes.empty()) block["lobes"] = lamps.lobes;
    if (!lamps.openings.empty()) block["openings"] = lamps.openings;
    add_tables(scene, block);
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        const std::optional<uint32_t>& fixture = scene.nodes[i].fixture;
        if (scene.nodes[i].lamp != kNone && fixture)
            block["fixtures"].push_back(
                {{"node", file_nodes[i]}, {"fixture", *fixture == kNone ? json("none") : json(file_nodes[*fixture])}});
    }
    return block;
}

}  // namespace vesper::scene
