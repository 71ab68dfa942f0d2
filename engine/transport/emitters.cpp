#include "transport/emitters.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "base/budget.h"
#include "base/error.h"
#include "base/luminance.h"
#include "base/one_line.h"
#include "scene/scene.h"
#include "transport/sampling.h"

namespace vesper::transport {
namespace {

constexpr double kSide = 0.5;  // m: triangles with longer sides are in parts
constexpr double kLarge = 64;  // m: those with such sides are not, as of domes
constexpr uint8_t kMostHalvings = 3;
constexpr size_t kManyParts = 1u << 17;  // with so many emitters the next triangles are whole, without their textures
constexpr double kLeastPart = 0.05;      // of its material's luminance that a part counts with, at least; and of the
constexpr double kLeastOfPicture = 0.5;  // mean of a picture, whose small bright spots may lie between the samples
constexpr uint8_t kSamples = 2;          // halvings of a part, where its texture is looked up

auto key_of(const Emitters::Emitter& e) { return std::tuple(e.node, e.primitive, e.triangle); }

constexpr uint32_t parts(uint32_t halvings) { return 1u << 2 * halvings; }

// Of a part, the place with some weights of its corners, by its weights of those of the triangle. Parts 0 to 2 of four
// are at these corners, the last is between them, turned about.
glm::dvec3 in_triangle(uint32_t halvings, uint32_t part, glm::dvec3 weights) {
    for (; halvings > 0; --halvings, part /= 4) {
        weights *= 0.5;
        if (part % 4 == 3)
            weights = 0.5 - weights;
        else
            weights[int(part % 4)] += 0.5;
    }
    return weights;
}

uint32_t part_at(uint32_t halvings, glm::dvec3 weights) {
    uint32_t part = 0;
    for (; halvings > 0; --halvings) {
        uint32_t k = 0;
        while (k < 3 && !(weights[int(k)] > 0.5)) ++k;
        if (k < 3)
            weights[int(k)] -= 0.5;
        else
            weights = 0.5 - weights;
        weights *= 2.0, part = 4 * part + k;
    }
    return part;
}

// About the mean over a part, cd/m^2, at least `least`; `from`: before its front.
double luminance_on(const Surfaces& surfaces, const Emitters::Emitter& e, double least, glm::dvec3 from) {
    double sum = 0;
    for (uint32_t part = 0; part < parts(kSamples); ++part) {
        const glm::dvec3 weights = in_triangle(e.halvings, e.part, in_triangle(kSamples, part, glm::dvec3(1 / 3.0)));
        const rays::Hit hit{
            .share = 1, .node = e.node, .primitive = e.primitive, .triangle = e.triangle, .weights = weights};
        sum += luminance(surfaces.emission(hit, from));
    }
    return std::max(least, sum / parts(kSamples));
}

// Of each material, cd/m^2.
std::vector<double> luminances_of(const scene::Scene& scene) {
    std::vector<glm::dvec3> means;
    for (const photometry::LuminancePicture& picture : scene.luminance_pictures)
        means.push_back(photometry::mean_colour(picture));
    std::vector<double> luminances;
    for (const scene::Material& material : scene.materials) {
        const uint32_t picture = material.emission_picture.image;
        const glm::dvec3 factor(material.emission);
        luminances.push_back(luminance(picture == scene::kNone ? factor : factor * means[picture]));
    }
    return luminances;
}

}  // namespace

Emitters::Emitters(const scene::Scene& scene, std::span<const glm::dmat4> world, const Surfaces& surfaces) {
    const std::vector<double> luminances = luminances_of(scene);
    for (uint32_t node = 0; node < scene.nodes.size(); ++node) {
        if (scene.nodes[node].mesh == scene::kNone) continue;
        const scene::Mesh& mesh = scene.meshes[scene.nodes[node].mesh];
        const double front = glm::determinant(glm::dmat3(world[node])) < 0 ? -1 : 1;
        for (uint32_t p = 0; p < mesh.primitives.size(); ++p) {
            const scene::Primitive& primitive = mesh.primitives[p];
            const scene::Material& material = scene.materials[primitive.material];
            const double emitted = luminances[primitive.material];
            if (!(emitted > 0) || material.clear) continue;
            spend(primitive.indices.size() / 3 * 2 * sizeof(Emitter));  // of a vector that grows
            for (uint32_t t = 0; 3 * size_t(t) < primitive.indices.size(); ++t) {
                Emitter e{node, p, t, 0, 0, {}, {}, 0, emitted, material.double_sided};
                for (size_t k = 0; k < 3; ++k) {
                    const scene::Vertex& vertex = primitive.vertices[primitive.indices[3 * size_t(t) + k]];
                    e.corners[k] = glm::dvec3(world[node] * glm::dvec4(vertex.position, 1));
                }
                const glm::dvec3 twice = glm::cross(e.corners[1] - e.corners[0], e.corners[2] - e.corners[0]);
                e.area = 0.5 * glm::length(twice);
                if (!(e.area > 0) || !std::isfinite(e.area) || surfaces.is_housing(node, e.corners)) continue;
                e.outwards = front * twice / (2 * e.area);
                add(scene, surfaces, e);
            }
        }
    }
    make_groups();
}

void Emitters::add(const scene::Scene& scene, const Surfaces& surfaces, const Emitter& triangle) {
    const auto& [a, b, c] = triangle.corners;
    double side = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
    const bool whole = list_.size() >= kManyParts || side > kLarge;
    Emitter e = triangle;
    for (; !whole && side > kSide && e.halvings < kMostHalvings; side /= 2) ++e.halvings;
    e.area = triangle.area / parts(e.halvings);
    const scene::Mesh& mesh = scene.meshes[scene.nodes[e.node].mesh];
    const scene::Material& material = scene.materials[mesh.primitives[e.primitive].material];
    const bool picture = material.emission_picture.image != scene::kNone,
               textured = picture || material.emission_texture.image != scene::kNone;
    const double least = triangle.luminance * (picture ? kLeastOfPicture : kLeastPart);
    for (uint32_t part = 0; part < parts(e.halvings); ++part) {
        e.part = uint8_t(part);
        for (int k = 0; k < 3; ++k) {
            glm::dvec3 corner(0);
            corner[k] = 1;
            const glm::dvec3 weights = in_triangle(e.halvings, part, corner);
            e.corners[size_t(k)] = weights.x * a + weights.y * b + weights.z * c;
        }
        if (textured && !whole) e.luminance = luminance_on(surfaces, e, least, e.corners[0] + e.outwards);
        if (list_.size() == kMost)
            throw Error("light between surfaces: more than " + std::to_string(kMost) +
                        " triangles or parts of them emit, with those of node " + std::to_string(e.node) + " '" +
                        one_line(scene.nodes[e.node].name) + "'");
        list_.push_back(e);
    }
}

std::optional<size_t> Emitters::find(const rays::Hit& hit) const {
    const std::tuple key(hit.node, hit.primitive, hit.triangle);
    const auto at = std::ranges::lower_bound(list_, key, {}, key_of);
    if (at == list_.end() || key_of(*at) != key) return std::nullopt;
    return size_t(at - list_.begin()) + part_at(at->halvings, hit.weights);
}

Emitters::Place Emitters::place_on(size_t emitter, glm::dvec2 chance) const {
    const Emitter& e = list_[emitter];
    const glm::dvec3 weights = triangle_weights(chance);
    Place place{.hit = {.share = 1, .node = e.node, .primitive = e.primitive, .triangle = e.triangle}};
    place.hit.weights = in_triangle(e.halvings, e.part, weights);
    for (int k = 0; k < 3; ++k) place.point += weights[k] * e.corners[size_t(k)];
    return place;
}

// As many groups as nodes that emit, or kGroups: choosing takes time by their number.
void Emitters::make_groups() {
    constexpr size_t kGroups = 2048;
    size_t most = 16;
    while (list_.size() / most > kGroups) most *= 4;  // parts beside each other
    double sum = 0;
    for (size_t i = 0; i < list_.size(); ++i) {
        if (groups_.empty() || list_[i].node != list_[groups_.back().first].node || groups_.back().count == most)
            groups_.push_back({i, 0, {}, 0, 0, true});
        ++groups_.back().count;
        group_of_.push_back(uint32_t(groups_.size() - 1));
        powers_up_to_.push_back(sum += list_[i].luminance * list_[i].area);
    }
    for (Group& group : groups_) {
        const std::span<const Emitter> all(&list_[group.first], group.count);
        glm::dvec3 low(1e300), high(-1e300);
        for (const Emitter& e : all) {
            group.power += e.luminance * e.area;
            for (const glm::dvec3 corner : e.corners) low = glm::min(low, corner), high = glm::max(high, corner);
        }
        group.centre = 0.5 * (low + high), group.radius = 0.5 * glm::distance(low, high);
        for (const Emitter& e : all)
            group.flat &= !e.double_sided && glm::dot(e.outwards, all[0].outwards) > 1 - 1e-9 &&
                          std::abs(glm::dot(all[0].outwards, e.corners[0] - all[0].corners[0])) < 1e-6 * group.radius;
    }
    make_group_lanes();
}

void Emitters::make_group_lanes() {
    constexpr double kLeastRadius = 1e-6, kMostPower = 1e20;  // m, cd: within the range of floats
    group_lanes_.resize(lanes_for(groups_.size()), GroupLanes{.plane = all_of(-1), .radius = all_of(1)});
    for (size_t g = 0; g < groups_.size(); ++g) {
        const Group& group = groups_[g];
        GroupLanes& lanes = group_lanes_[g / kLanes];
        const size_t i = g % kLanes;
        lanes.centre.set(i, glm::vec3(group.centre - origin()));
        lanes.radius[i] = float(std::max(group.radius, kLeastRadius));
        lanes.power[i] = float(std::min(group.power, kMostPower));
        if (!group.flat) continue;
        const Emitter& first = list_[group.first];
        lanes.outwards.set(i, glm::vec3(first.outwards)), lanes.flat[i] = 1;
        lanes.plane[i] = float(glm::dot(first.outwards, first.corners[0] - origin()));
    }
}

EmitterChoice::EmitterChoice(const Emitters& emitters, const Patch& patch, std::span<const float> seen)
    : emitters_(emitters), ends_(emitters.groups().size()) {
    const Lanes3 from = all_of(glm::vec3(patch.middle - emitters.origin())), up = all_of(glm::vec3(patch.normal)),
                 half = all_of(glm::vec3(patch.half));
    const auto across = float(patch.across()), thick = float(patch.thick()), turned = float(patch.turned);
    const Lanes zero{};
    double sum = 0;
    for (size_t first = 0; first < ends_.size(); first += kLanes) {
        const Emitters::GroupLanes& group = emitters.group_lanes()[first / kLanes];
        const Lanes3 to = group.centre - from;
        const Lanes distance2 = dot(to, to) + 1e-20f, distance = distance2 * inverse_root(distance2);
        const Lanes above = dot(to, up) + group.radius + thick + turned * distance;
        const Lanes before = dot(group.outwards, from) - group.plane + dot(half, abs(group.outwards));
        // Of a flat one the cosine counts, from close by not fully; what is near gives no more than its luminance.
        const Lanes radius = group.radius + across, near = max(distance - radius, zero), about = near + radius;
        const Lanes leaving = group.flat * min(before + 0.5f * radius, about) + (1 - group.flat) * about;
        const Lanes lux = group.power * min(above, about) * leaving / (about * about * (near * near + radius * radius));
        const Lanes counts = above > zero ? (before > zero ? lux : zero) : zero;
        for (size_t g = first; g < std::min(first + kLanes, ends_.size()); ++g)
            ends_[g] = sum += double(counts[g - first]) * (seen.empty() ? 1 : double(seen[g]));
    }
}

EmitterChoice::EmitterChoice(const Emitters& emitters) : emitters_(emitters) {
    double sum = 0;
    for (const Emitters::Group& group : emitters.groups()) ends_.push_back(sum += group.power);
}

size_t EmitterChoice::choose(double& share) const {
    const auto pick = [&share](auto ends, double begin) {
        const double sum = ends.back() - begin, at = begin + share * sum;
        const auto found = std::min(std::ranges::upper_bound(ends, at), ends.end() - 1);
        const double below = found == ends.begin() ? begin : *(found - 1);
        share = std::clamp((at - below) / std::max(*found - below, 1e-300), 0.0, 1.0);
        return size_t(found - ends.begin());
    };
    const Emitters::Group& group = emitters_.groups()[pick(std::span(ends_), 0.0)];
    const std::span all = emitters_.powers_up_to();
    return group.first + pick(all.subspan(group.first, group.count), group.first == 0 ? 0.0 : all[group.first - 1]);
}

double EmitterChoice::probability(size_t emitter) const {
    const size_t number = emitters_.group_of(emitter);
    const double group = (ends_[number] - (number == 0 ? 0 : ends_[number - 1])) / ends_.back();
    const Emitters::Emitter& e = emitters_.list()[emitter];
    return group * e.luminance * e.area / emitters_.groups()[number].power;
}

double EmitterChoice::density(size_t emitter, glm::dvec3 to) const {
    const Emitters::Emitter& e = emitters_.list()[emitter];
    const double distance2 = glm::dot(to, to);
    const double leaving = std::max(std::abs(glm::dot(e.outwards, to)) / std::sqrt(distance2), kLeastLeaving);
    return probability(emitter) / e.area * distance2 / leaving;
}

}  // namespace vesper::transport
