// A photometric scene in memory. SPDX-License-Identifier: MIT
// Lengths in m, angles in rad, intensities in cd, luminances in cd/m^2, illuminances in lx. Y is up, cameras and lamps
// look along their local -Z, matrices are column-major.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "base/image.h"
#include "photometry/distribution.h"
#include "photometry/environment.h"
#include "photometry/luminance_picture.h"
#include "photometry/reflection_table.h"
#include "photometry/retroreflection.h"
#include "scene/bounds.h"
#include "scene/index.h"
#include "scene/lamp.h"
#include "scene/material.h"

namespace vesper::scene {

struct Vertex {
    glm::vec3 position{0};      ///< m, in the mesh's frame
    glm::vec3 normal{0, 1, 0};  ///< unit length
    glm::vec2 uv{0};
    std::array<uint16_t, 4> colour{65535, 65535, 65535, 65535};  ///< linear, 65535 is 1; multiplies base_colour
    glm::vec2 emission_shift{0};  ///< of the coordinates of emission textures and pictures from uv

    glm::vec2 emission_uv() const { return uv + emission_shift; }
};

/// Triangles of one material.
struct Primitive {
    uint32_t material = 0;  ///< index into Scene::materials
    std::vector<Vertex> vertices;
    std::vector<uint32_t>
        indices;  ///< three per triangle, counter-clockwise seen from the front, all < vertices.size()
    Bounds bounds;
};

struct Mesh {
    std::string name;
    std::vector<Primitive> primitives;
};

/// Most lamps of a frame, on each device. Lavapipe ends the loops of an invocation silently after 65,535 turns, and a
/// lamp takes three in a retroreflective pixel.
inline constexpr uint32_t kMaxLamps = 21'000;

struct Camera {
    std::string name;              ///< of the camera, else of its node
    float vertical_fov = 0.6435f;  ///< rad, in (0, pi)
    float near = 0.1f;             ///< m; there is no far plane
};

struct Node {
    std::string name;
    uint32_t parent = kNone;    ///< always smaller than the node's own index
    glm::dvec3 translation{0};  ///< m; double: databases lie far from their origin, and parent nodes compensate
    glm::quat rotation{1, 0, 0, 0};
    glm::vec3 scale{1};
    std::optional<glm::dmat4> matrix;  ///< replaces the three above if the file has one
    uint32_t mesh = kNone, lamp = kNone, camera = kNone;
    std::optional<uint32_t> fixture;  ///< of its lamp: the node at and below which meshes never hide it, kNone: every
                                      ///< mesh hides it; without a value by the rule of scene/fixtures.h
};

/// Key frames of one property of one node. Times in s, ascending.
struct Channel {
    enum class Path : uint8_t { Translation, Rotation, Scale };
    enum class Interpolation : uint8_t { Step, Linear, Cubic };
    uint32_t node = 0;
    Path path = Path::Translation;
    Interpolation interpolation = Interpolation::Linear;
    std::vector<float> times;
    std::vector<glm::vec4> values;  ///< xyz or quaternion xyzw; Cubic: in-tangent, value, out-tangent per key
};

constexpr size_t kMaxRetroreflectors = 8;  ///< limit of the shaders

struct Scene {
    std::string name;
    std::vector<Image> images;
    std::vector<photometry::LuminancePicture> luminance_pictures;  ///< times Material::emission they are cd/m^2
    std::vector<Material> materials;
    std::vector<Mesh> meshes;
    std::vector<Lamp> lamps;
    std::vector<photometry::Distribution> distributions;
    std::vector<photometry::ReflectionTable> reflection_tables;  ///< as published
    bool beyond_tables = true;  ///< tables are rendered as extended(); false: as published, to
                                ///< compare with a calculation
    std::vector<photometry::Retroreflector> retroreflectors;  ///< at most kMaxRetroreflectors
    std::vector<Camera> cameras;
    std::vector<Node> nodes;                             ///< parents before children
    std::vector<Channel> channels;                       ///< of all animations, played together
    Transfer transfer;                                   ///< of base colour textures
    float ambient_illuminance = 0;                       ///< E on any surface, lx: adds E * reflectance / pi
    glm::vec3 ambient_colour{1};                         ///< linear, luminance 1
    float sky_luminance = 0;                             ///< of the background, cd/m^2
    glm::vec3 sky_colour{1};                             ///< linear, luminance 1
    std::optional<photometry::Environment> environment;  ///< a picture of the sky, instead of the two above
};

/// Transforms of all nodes at a time: node frame to world, one matrix per node, in double. Channels keep their first
/// and last values outside their keys. `seconds` >= 0.
std::vector<glm::dmat4> world_transforms(const Scene& scene, double seconds);

/// Duration of the longest channel, s; 0 without animation.
double animation_length(const Scene& scene);

}  // namespace vesper::scene
