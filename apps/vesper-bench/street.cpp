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

}  // namespace

scene::Scene lamp_street(uint32_t lamps, uint64_t triangles, const std::string& luminaire) {
    // Cut into pieces of one spacing, so that they can be culled; the first lies behind the eye.
    const uint32_t pieces = 1 + uint32_t(std::ceil(std::max(kShortest, float((lamps + 1) / 2) * kSpacing) / kSpacing));
    const uint64_t cells =
        std::max<uint64_t>(1, (triangles + 6 * pieces - 1) / (6 * pieces));  // of each of three patches
    const uint32_t across = uint32_t(std::max(1.0, std::floor(std::sqrt(double(cells)))));
    const uint32_t along = uint32_t((cells + across - 1) / across);

    scene::Scene scene;
    scene.name = "street";
    scene.materials.push_back({.name = "grey", .base_colour = {0.2f, 0.2f, 0.2f, 1}});
    const float w = kHalfWidth;
    scene.meshes.push_back(patch("road", {-w, 0, 0}, {2 * w, 0, 0}, {0, 0, -kSpacing}, across, along));
    scene.meshes.push_back(patch("left wall", {-w, 0, 0}, {0, 0, -kSpacing}, {0, kWall, 0}, across, along));
    scene.meshes.push_back(patch("right wall", {w, 0, -kSpacing}, {0, 0, kSpacing}, {0, kWall, 0}, across, along));
    for (uint32_t piece = 0; piece < pieces; ++piece)
        for (uint32_t mesh = 0; mesh < 3; ++mesh)
            scene.nodes.push_back(
                {.name = scene.meshes[mesh].name, .translation = {0, 0, kSpacing * (1 - float(piece))}, .mesh = mesh});

    const bool dark = luminaire == "none";
    if (!dark) scene.lamps.push_back(luminaire_of(luminaire, scene));
    const glm::quat down = glm::angleAxis(-std::numbers::pi_v<float> / 2, glm::vec3(1, 0, 0));
    for (uint32_t i = 0; i < lamps && !dark; ++i)
        scene.nodes.push_back({.name = "lamp",
                               .translation = {i % 2 ? w - 1 : 1 - w, kHeight, -float(i / 2) * kSpacing},
                               .rotation = down,
                               .lamp = 0});

    const glm::vec3 eye(1.75f, 1.2f, 0);
    scene.cameras.push_back({.name = "driver"});
    scene.nodes.push_back({.name = "driver", .translation = eye, .camera = 0});
    scene.channels.push_back({.node = uint32_t(scene.nodes.size() - 1),
                              .path = scene::Channel::Path::Translation,
                              .times = {0, kSeconds},
                              .values = {glm::vec4(eye, 0), glm::vec4(eye - glm::vec3(0, 0, kSpeed * kSeconds), 0)}});
    return scene;
}

}  // namespace vesper::bench
