#include "external/plain_car.h"

#include <algorithm>
#include <array>
#include <numbers>

#include "base/angle.h"
#include "photometry/standard_lamps.h"
#include "scene/colour.h"

namespace vesper::drive {
namespace {

constexpr float kRadiansPerDegreeF = float(kRadiansPerDegree);
constexpr float kHalogen = 3800;  // K
const glm::vec3 kRed(1, 0.02f, 0.01f), kAmber(1, 0.38f, 0), kWhite(1);

// An axis-aligned box, each face with its own normal.
void add_box(scene::Primitive& p, glm::vec3 low, glm::vec3 high) {
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) {
            glm::vec3 normal(0), u(0), v(0), corner = side ? high : low;
            normal[axis] = side ? 1.0f : -1.0f;
            const int a = (axis + 1) % 3, b = (axis + 2) % 3;
            u[a] = (high[a] - low[a]) * (side ? -1.0f : 1.0f), v[b] = (high[b] - low[b]) * (side ? -1.0f : 1.0f);
            const auto first = uint32_t(p.vertices.size());
            for (const glm::vec3 at : {corner, corner + u, corner + u + v, corner + v}) {
                p.vertices.push_back({.position = at, .normal = normal});
                p.bounds.add(at);
            }
            // u x v points along the axis whatever their signs: both were turned.
            for (const uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u})
                p.indices.push_back(first + (side ? i : (i == 0 ? 0 : 4 - i)));
        }
}

glm::vec3 of_luminance_one(glm::vec3 c) { return c / (0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b); }

uint32_t lamp_of(scene::Scene& scene, const scene::Lamp& lamp) {
    const auto known = std::find_if(scene.lamps.begin(), scene.lamps.end(),
                                    [&](const scene::Lamp& l) { return l.name == lamp.name && l.opening.area() > 0; });
    if (known != scene.lamps.end()) return uint32_t(known - scene.lamps.begin());
    scene.lamps.push_back(lamp);
    return uint32_t(scene.lamps.size() - 1);
}

uint32_t beam(scene::Scene& scene, const std::string& name, const std::string& file) {
    scene::Lamp lamp{.name = name,
                     .kind = scene::Lamp::Kind::Measured,
                     .intensity = 1,
                     .colour = scene::colour_of_temperature(kHalogen),
                     .opening = {.length = 0.265, .width = 0.14}};
    const auto known = std::find_if(scene.distributions.begin(), scene.distributions.end(),
                                    [&](const photometry::Distribution& d) { return d.name == name; });
    lamp.distribution = uint32_t(known - scene.distributions.begin());
    if (known == scene.distributions.end()) {
        scene.distributions.push_back(photometry::standard_lamp(file));
        scene.distributions.back().name = name;
    }
    return lamp_of(scene, lamp);
}

uint32_t signal(scene::Scene& scene, const std::string& name, float candela, float outer, glm::vec3 colour,
                double width, double height) {
    return lamp_of(scene, {.name = name,
                           .kind = scene::Lamp::Kind::Spot,
                           .intensity = candela,
                           .colour = of_luminance_one(colour),
                           .inner_cone = 10 * kRadiansPerDegreeF,
                           .outer_cone = outer * kRadiansPerDegreeF,
                           .opening = {.length = width, .width = height}});
}

uint32_t body_mesh(scene::Scene& scene, const std::string& name, const PlainBody& body, glm::vec3 half,
                   glm::vec3 middle) {
    const auto known = std::find_if(scene.meshes.begin(), scene.meshes.end(),
                                    [&](const scene::Mesh& mesh) { return mesh.name == name; });
    if (known != scene.meshes.end()) return uint32_t(known - scene.meshes.begin());
    scene::Primitive p;
    p.material = uint32_t(scene.materials.size());
    scene.materials.push_back(
        {.name = name, .base_colour = glm::vec4(body.reflectance, 1), .roughness = body.lamps ? 0.4f : 1.0f});
    if (body.lamps) {
        // A body up to the belt, a cabin above it.
        const float belt = middle.y + 0.15f * half.y;
        add_box(p, {middle.x - half.x, middle.y - 0.8f * half.y, middle.z - half.z},
                {middle.x + half.x, belt, middle.z + half.z});
        add_box(p, {middle.x - 0.85f * half.x, belt, middle.z - 0.4f * half.z},
                {middle.x + 0.85f * half.x, middle.y + half.y, middle.z + 0.75f * half.z});
    } else {
        add_box(p, middle - half, middle + half);
    }
    scene.meshes.push_back({name, {std::move(p)}});
    return uint32_t(scene.meshes.size() - 1);
}

}  // namespace

traffic::LampRoles plain_lamps() {
    return {{"low beam"},
            {"high beam"},
            {"tail lamp"},
            {"brake lamp"},
            {"left front indicator", "left rear indicator"},
            {"right front indicator", "right rear indicator"},
            {"front fog lamp"},
            {"rear fog lamp"},
            {"reversing lamp"}};
}

void add_plain_body(scene::Scene& scene, uint32_t root, const std::string& name, const PlainBody& body) {
    const glm::vec3 half = glm::vec3(body.size.y, body.size.z, body.size.x) / 2.0f;  // right, up, back
    const glm::vec3 middle(-body.centre.y, body.centre.z, -body.centre.x);
    scene.nodes[root].mesh = body_mesh(scene, name, body, half, middle);
    if (!body.lamps) return;
    const glm::quat back = glm::angleAxis(std::numbers::pi_v<float>, glm::vec3(0, 1, 0));
    const auto hang = [&](uint32_t lamp, float side, float height, bool front) {
        // Measured lamps are known by their node's name.
        scene::Node node{.name = scene.lamps[lamp].name, .parent = root, .lamp = lamp};
        node.translation = {middle.x + side * 0.75f * half.x, height,
                            middle.z + (front ? -half.z - 0.02f : half.z + 0.02f)};
        if (!front) node.rotation = back;
        scene.nodes.push_back(node);
    };
    const float lamp_height = std::min(0.65f, middle.y), tail_height = std::min(0.85f, middle.y + 0.1f);
    for (const float side : {-1.0f, 1.0f}) {
        const std::string hand = side < 0 ? "left" : "right";
        hang(beam(scene, "low beam", "low-beam"), side, lamp_height, true);
        hang(beam(scene, "high beam", "high-beam"), side, lamp_height, true);
        hang(signal(scene, "tail lamp", 5, 55, kRed, 0.2, 0.26), side, tail_height, false);
        hang(signal(scene, "brake lamp", 80, 55, kRed, 0.2, 0.26), side, tail_height, false);
        hang(beam(scene, "front fog lamp", "front-fog"), side * 0.9f, lamp_height - 0.25f, true);
        hang(signal(scene, "rear fog lamp", 200, 40, kRed, 0.14, 0.1), side * 0.9f, tail_height - 0.25f, false);
        hang(signal(scene, "reversing lamp", 200, 60, kWhite, 0.14, 0.08), side * 0.8f, tail_height - 0.16f, false);
        hang(signal(scene, hand + " front indicator", 200, 60, kAmber, 0.14, 0.08), side * 1.15f, lamp_height - 0.12f,
             true);
        hang(signal(scene, hand + " rear indicator", 100, 60, kAmber, 0.14, 0.08), side * 1.1f, tail_height - 0.16f,
             false);
    }
}

}  // namespace vesper::drive
