// Measured lamps of a glTF file: EXT_lights_ies. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/error.h"
#include "photometry/ies.h"
#include "scene/colour.h"
#include "scene/gltf_reader.h"

namespace vesper::scene {
namespace {

photometry::Distribution read_profile(GltfReader& reader, const JsonValue& profile, uint64_t& bytes_read) {
    const auto type = profile.find("mimeType");
    if (type && type->text() != "application/x-ies-lm-63") type->fail("is not application/x-ies-lm-63");
    const std::vector<uint8_t> bytes = reader.document.file_of(profile);
    bytes_read += bytes.size();
    if (bytes_read > reader.limits.file_bytes) profile.fail("the light profiles add up to more than the limit");
    photometry::Distribution made = photometry::parse_ies(bytes, profile.place());
    const std::string name = profile.text_or("name", "");
    if (!name.empty()) made.name = name;
    for (const std::string& note : made.notes) reader.notes.add("a measured lamp: " + note);
    return made;
}

}  // namespace

void read_distributions(GltfReader& reader) {
    const auto extensions = reader.document.root().find("extensions");
    const auto extension = extensions ? extensions->find("EXT_lights_ies") : std::nullopt;
    if (!extension) return;
    const auto profiles = extension->elements_of("lights");
    if (profiles.size() > reader.limits.lamps)
        extension->fail("more lights than the limit of " + std::to_string(reader.limits.lamps));
    uint64_t bytes = 0, candela = 0;
    for (const JsonValue& profile : profiles) {
        reader.scene.distributions.push_back(read_profile(reader, profile, bytes));
        candela += reader.scene.distributions.back().candela.size();
        if (candela > reader.limits.candela)
            profile.fail("more intensities than the limit of " + std::to_string(reader.limits.candela) +
                         " for all light profiles together");
    }
}

uint32_t read_measured_light(GltfReader& reader, const JsonValue& use) {
    const uint32_t index = use.at("light").index(reader.scene.distributions.size(), "lights");
    const double multiplier = use.number_or("multiplier", 1, 0);
    glm::dvec3 colour(1);
    if (const auto stated = use.find("color")) {
        const auto c = stated->numbers<3, double>(0);
        colour = glm::min(glm::dvec3(c[0], c[1], c[2]), glm::dvec3(1));  // the extension clamps
    }
    const auto key = std::tuple(index, static_cast<float>(multiplier), static_cast<float>(colour.r),
                                static_cast<float>(colour.g), static_cast<float>(colour.b));
    const auto [known, is_new] =
        reader.measured_lights.try_emplace(key, static_cast<uint32_t>(reader.scene.lamps.size()));
    if (!is_new) return known->second;
    Lamp lamp;
    lamp.kind = Lamp::Kind::Measured;
    lamp.distribution = index;
    lamp.name = reader.scene.distributions[index].name;
    if (index < reader.profile_openings.size()) lamp.opening = reader.profile_openings[index];
    const double y = luminance(colour);
    lamp.intensity = static_cast<float>(multiplier * y);
    if (y > 0) lamp.colour = glm::vec3(colour / y);
    if (!std::isfinite(lamp.colour.r + lamp.colour.g + lamp.colour.b)) use.fail("the colour is too dark");
    reader.scene.lamps.push_back(std::move(lamp));
    return known->second;
}

}  // namespace vesper::scene
