// What roads and what stands beside them are made of. SPDX-License-Identifier: MIT
#include <numbers>

#include "base/luminance.h"
#include "roads/road_mesh.h"

namespace vesper::roads {
namespace {

constexpr float kSignWhite = 0.8f;  // diffuse reflectance of a white sheet

// Diffuse reflectances of weathered surfaces, Y of Rec. 709: concrete 0.25 to 0.35, granite 0.3, grass 0.08 to 0.12,
// bark 0.1, leaves 0.08, white thermoplastic 0.5 to 0.6 (Thorn 1994, Lighting people and places, tables of materials;
// CIE 140 for roads).
scene::Material of(const char* name, glm::vec3 colour, float roughness = 1) {
    scene::Material material{.name = name};
    material.base_colour = glm::vec4(colour, 1);
    material.roughness = roughness;
    return material;
}

scene::Material material_of(RoadMaterial stuff) {
    constexpr float kRoad = 0.17f;  // pi Qd of R3, for renderers without tables
    switch (stuff) {
        case RoadMaterial::Asphalt:
            return of("asphalt", glm::vec3(kRoad));
        case RoadMaterial::Shoulder:
            return of("asphalt shoulder", glm::vec3(kRoad));
        case RoadMaterial::Bikeway:
            return of("bikeway", {0.16f, 0.07f, 0.05f});
        case RoadMaterial::Pavement:
            return of("pavement", {0.27f, 0.25f, 0.23f});
        case RoadMaterial::Kerb:
            return of("kerb", {0.32f, 0.31f, 0.3f});
        case RoadMaterial::Grass:
            return of("grass", {0.06f, 0.1f, 0.03f});
        case RoadMaterial::Gravel:
            return of("gravel", {0.2f, 0.18f, 0.15f});
        case RoadMaterial::Concrete:
            return of("concrete", {0.3f, 0.29f, 0.27f});
        case RoadMaterial::MarkWhite:
            return of("marking white", glm::vec3(0.55f));
        case RoadMaterial::MarkYellow:
            return of("marking yellow", {0.5f, 0.33f, 0.04f});
        case RoadMaterial::MarkRed:
            return of("marking red", {0.3f, 0.03f, 0.02f});
        case RoadMaterial::MarkBlue:
            return of("marking blue", {0.03f, 0.08f, 0.3f});
        case RoadMaterial::MarkGreen:
            return of("marking green", {0.03f, 0.2f, 0.07f});
        case RoadMaterial::MarkBlack:
            return of("marking black", glm::vec3(0.04f));
        case RoadMaterial::Steel:
            return of("galvanised steel", {0.4f, 0.41f, 0.42f}, 0.6f);
        case RoadMaterial::PoleSteel:
            return of("pole", {0.35f, 0.36f, 0.37f}, 0.7f);
        case RoadMaterial::Post:
            return of("guide post", glm::vec3(0.6f), 0.8f);
        case RoadMaterial::PostBand:
            return of("guide post band", glm::vec3(0.03f));
        case RoadMaterial::PostReflector:
            return of("guide post reflector", glm::vec3(0.9f));
        case RoadMaterial::Bark:
            return of("bark", {0.11f, 0.08f, 0.06f});
        case RoadMaterial::Leaves:
            return of("leaves", {0.05f, 0.09f, 0.03f});
        case RoadMaterial::Wall:
            return of("wall", {0.4f, 0.37f, 0.32f});
        case RoadMaterial::SignWhite:
            return of("sign white", glm::vec3(kSignWhite));
        // Prints let that share of the light through that EN 12899-1, table 1, has for each colour over white.
        case RoadMaterial::SignRed:
            return of("sign red", {0.45f, 0.02f, 0.02f});
        case RoadMaterial::SignYellow:
            return of("sign yellow", {0.8f, 0.5f, 0.02f});
        case RoadMaterial::SignBlue:
            return of("sign blue", {0.01f, 0.05f, 0.3f});
        case RoadMaterial::SignGreen:
            return of("sign green", {0.01f, 0.15f, 0.06f});
        case RoadMaterial::SignBlack:
            return of("sign black", glm::vec3(0.03f));
        case RoadMaterial::SignBack:
            return of("sign back", glm::vec3(0.3f), 0.7f);
        case RoadMaterial::Housing:
            return of("signal housing", glm::vec3(0.03f));
        default:
            return of("luminaire", glm::vec3(0.25f), 0.7f);
    }
}

/// Markings of class R3 of EN 1436 (150 mcd/(m^2 lx)), yellow ones R1 (80); signs and posts of RA2 (EN 12899-1).
void make_retroreflective(scene::Scene& scene, scene::Material& material, RoadMaterial stuff) {
    const auto use = [&](photometry::Retroreflector made) {
        for (uint32_t i = 0; i < scene.retroreflectors.size(); ++i)
            if (scene.retroreflectors[i] == made) return material.retroreflector = i;
        scene.retroreflectors.push_back(std::move(made));
        return material.retroreflector = static_cast<uint32_t>(scene.retroreflectors.size() - 1);
    };
    // Coefficients are multiplied by the base colour; of prints by that over white.
    const double own = luminance(glm::dvec3(material.base_colour));
    if (stuff == RoadMaterial::MarkWhite || stuff == RoadMaterial::MarkYellow)
        use(photometry::retroreflective_marking((stuff == RoadMaterial::MarkWhite ? 150 : 80) / own));
    if (stuff >= RoadMaterial::SignWhite && stuff <= RoadMaterial::SignGreen)
        use(photometry::rescaled(photometry::retroreflective_class("RA2"), 1 / double(kSignWhite)));
    if (stuff == RoadMaterial::PostReflector)
        use(photometry::rescaled(photometry::retroreflective_class("RA2"), 1 / own));
}

}  // namespace

uint32_t RoadMaterials::index_of(RoadMaterial stuff) {
    uint32_t& known = index_[static_cast<size_t>(stuff)];
    if (known != scene::kNone) return known;
    scene::Material material = material_of(stuff);
    if (stuff == RoadMaterial::Asphalt || stuff == RoadMaterial::Shoulder) {
        if (scene_.reflection_tables.empty())
            scene_.reflection_tables.push_back(photometry::find_reflection_table("R3"));
        material.reflection_table = 0;
    }
    make_retroreflective(scene_, material, stuff);
    scene_.materials.push_back(std::move(material));
    return known = static_cast<uint32_t>(scene_.materials.size() - 1);
}

}  // namespace vesper::roads
