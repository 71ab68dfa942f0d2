#include "street.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"

namespace vesper::bench {
namespace {

constexpr float kSpacing = 12, kHeight = 6.5f, kHalfWidth = 7, kWall = 15, kShortest = 400;  // m
constexpr float kCandela = 1500;                                                             // cd
constexpr float kSpeed = 50 / 3.6f, kSeconds = 10;                                           // m/s, s
constexpr uint32_t kHouses = 10;                                                             // each way
constexpr float kPitch = 100, kHouse = kPitch - 2 * kHalfWidth;                              // m, of houses

/// A rectangle from `corner` along two edges, its front where their cross product points.
scene::Mesh patch(const std::string& name, glm::vec3 corner, glm::vec3 u, glm::vec3 v, uint32_t across,
                  uint32_t along) {
    scene::Primitive p;
    const glm::vec3 normal = glm::normalize(glm::cross(u, v));
    for (uint32_t j = 0; j <= along; ++j)
        for (uint32_t i = 0; i <= across; ++i) {
            const glm::vec3 position = corner + u * (float(i) / float(across)) + v * (float(j) / float(along));
            p.vertices.push_back({.position = position, .normal = normal});
            p.bounds.add(position);
        }
    const uint32_t row = across + 1;
    for (uint32_t j = 0; j < along; ++j)
        for (uint32_t i = 0; i < across; ++i) {
            const uint32_t a = j * row + i;
            for (const uint32_t index : {a, a + 1, a + row + 1, a, a + row + 1, a + row}) p.indices.push_back(index);
        }
    return {name, {std::move(p)}};
}

/// What the lamps of the street are (street.h). Measured ones go into the scene's distributions.
scene::Lamp luminaire_of(const std::string& name, scene::Scene& scene) {
    scene::Lamp lamp{.name = "lamp", .kind = scene::Lamp::Kind::Point, .intensity = kCandela};
    if (name == "point") return lamp;
    if (name.empty()) {
        lamp.kind = scene::Lamp::Kind::Spot, lamp.inner_cone = 0.8f,
        lamp.outer_cone = 80 * std::numbers::pi_v<float> / 180;
        return lamp;
    }
    scene.distributions.push_back(photometry::read_distribution(name));
    const double flux = photometry::luminous_flux(scene.distributions.back());
    if (!(flux > 1e-6)) throw Error(name + ": no light");
    lamp.kind = scene::Lamp::Kind::Measured, lamp.distribution = 0,
    lamp.intensity = float(2 * std::numbers::pi * double(kCandela) / flux);
    return lamp;
}

struct Cells {
    uint32_t across, along;
};
/// Of each of so many patches, so that they have so many triangles together.
Cells cells_of(uint64_t triangles, uint64_t patches) {
    const uint64_t cells = std::max<uint64_t>(1, (triangles + 2 * patches - 1) / (2 * patches));
    const auto across = uint32_t(std::max(1.0, std::floor(std::sqrt(double(cells)))));
    return {across, uint32_t((cells + across - 1) / across)};
}

/// A scene without surfaces.
scene::Scene empty_scene(const std::string& name, const std::string& luminaire) {
    scene::Scene scene;
    scene.name = name;
    scene.materials.push_back({.name = "grey", .base_colour = {0.2f, 0.2f, 0.2f, 1}});
    if (luminaire != "none") scene.lamps.push_back(luminaire_of(luminaire, scene));
    return scene;
}

void add_lamp(scene::Scene& scene, glm::vec3 place) {
    const glm::quat down = glm::angleAxis(-std::numbers::pi_v<float> / 2, glm::vec3(1, 0, 0));
    if (!scene.lamps.empty())
        scene.nodes.push_back({.name = "lamp", .translation = place, .rotation = down, .lamp = 0});
}

/// The eye, which drives along -z.
void add_driver(scene::Scene& scene, glm::vec3 eye) {
    scene.cameras.push_back({.name = "driver"});
    scene.nodes.push_back({.name = "driver", .translation = eye, .camera = 0});
    scene.channels.push_back({.node = uint32_t(scene.nodes.size() - 1),
                              .path = scene::Channel::Path::Translation,
                              .times = {0, kSeconds},
                              .values = {glm::vec4(eye, 0), glm::vec4(eye - glm::vec3(0, 0, kSpeed * kSeconds), 0)}});
}

/// A place around a house, by the part [0, 1) of the way around it.
glm::vec3 around_house(float part) {
    constexpr float kSide = kHouse + 2;  // 1 m from the walls
    const float way = 4 * part, along = (way - std::floor(way) - 0.5f) * kSide, aside = kSide / 2;
    switch (int(way)) {
        case 0:
            return {along, kHeight, aside};
        case 1:
            return {aside, kHeight, -along};
        case 2:
            return {-along, kHeight, -aside};
        default:
            return {-aside, kHeight, along};
    }
}

}  // namespace

scene::Scene lamp_street(uint32_t lamps, uint64_t triangles, const std::string& luminaire) {
    // Cut into pieces of one spacing, so that they can be culled; the first lies behind the eye.
    const uint32_t pieces = 1 + uint32_t(std::ceil(std::max(kShortest, float((lamps + 1) / 2) * kSpacing) / kSpacing));
    const auto [across, along] = cells_of(triangles, uint64_t{3} * pieces);
    scene::Scene scene = empty_scene("street", luminaire);
    const float w = kHalfWidth;
    scene.meshes.push_back(patch("road", {-w, 0, 0}, {2 * w, 0, 0}, {0, 0, -kSpacing}, across, along));
    scene.meshes.push_back(patch("left wall", {-w, 0, 0}, {0, 0, -kSpacing}, {0, kWall, 0}, across, along));
    scene.meshes.push_back(patch("right wall", {w, 0, -kSpacing}, {0, 0, kSpacing}, {0, kWall, 0}, across, along));
    for (uint32_t piece = 0; piece < pieces; ++piece)
        for (uint32_t mesh = 0; mesh < 3; ++mesh)
            scene.nodes.push_back(
                {.name = scene.meshes[mesh].name, .translation = {0, 0, kSpacing * (1 - float(piece))}, .mesh = mesh});
    for (uint32_t i = 0; i < lamps; ++i) add_lamp(scene, {i % 2 ? w - 1 : 1 - w, kHeight, -float(i / 2) * kSpacing});
    add_driver(scene, {1.75f, 1.2f, 0});
    return scene;
}

scene::Scene lamp_town(uint32_t lamps, uint64_t triangles, const std::string& luminaire) {
    constexpr uint32_t kAll = kHouses * kHouses;
    const auto [across, along] = cells_of(triangles, uint64_t{6} * kAll);
    scene::Scene scene = empty_scene("town", luminaire);
    const float g = kPitch / 2, w = kHouse / 2, h = kWall;
    scene.meshes.push_back(patch("ground", {-g, 0, g}, {2 * g, 0, 0}, {0, 0, -2 * g}, across, along));
    scene.meshes.push_back(patch("roof", {-w, h, w}, {2 * w, 0, 0}, {0, 0, -2 * w}, across, along));
    scene.meshes.push_back(patch("south wall", {-w, 0, w}, {2 * w, 0, 0}, {0, h, 0}, across, along));
    scene.meshes.push_back(patch("east wall", {w, 0, w}, {0, 0, -2 * w}, {0, h, 0}, across, along));
    scene.meshes.push_back(patch("north wall", {w, 0, -w}, {-2 * w, 0, 0}, {0, h, 0}, across, along));
    scene.meshes.push_back(patch("west wall", {-w, 0, -w}, {0, 0, 2 * w}, {0, h, 0}, across, along));
    const auto middle_of = [](uint32_t house) {
        const auto place = [](uint32_t i) { return kPitch * (float(i) + 0.5f - float(kHouses) / 2); };
        return glm::vec3(place(house % kHouses), 0, place(house / kHouses));
    };
    for (uint32_t house = 0; house < kAll; ++house)
        for (uint32_t mesh = 0; mesh < scene.meshes.size(); ++mesh)
            scene.nodes.push_back({.name = scene.meshes[mesh].name, .translation = middle_of(house), .mesh = mesh});
    for (uint32_t house = 0; house < kAll; ++house) {
        const uint32_t own = lamps / kAll + (house < lamps % kAll ? 1 : 0);
        for (uint32_t i = 0; i < own; ++i)
            add_lamp(scene, middle_of(house) + around_house((float(i) + 0.5f) / float(own)));
    }
    add_driver(scene, {1.75f, 1.2f, 1.5f * kPitch});
    return scene;
}

}  // namespace vesper::bench
