#include "gpu_scene/facets.h"

#include <algorithm>
#include <compare>
#include <cstring>
#include <optional>
#include <unordered_map>

namespace vesper::gpu_scene {
namespace {

constexpr float kFlat = 0.9999995f;    // cosine between the normals of one plane: 0.06 degrees
constexpr size_t kMostAtOneEdge = 16;  // triangles that are looked at

struct PlaceHash {
    size_t operator()(const glm::vec3& place) const {
        std::array<uint32_t, 3> words;
        std::memcpy(words.data(), &place, sizeof words);
        uint64_t hash = 0;
        for (const uint32_t word : words) hash = (hash ^ word) * 0x9e3779b97f4a7c15ull, hash ^= hash >> 29u;
        return hash;
    }
};

// From a corner of a triangle to the next one.
struct Edge {
    uint32_t from, to;  // places
    uint32_t triangle, corner;
    auto operator<=>(const Edge&) const = default;
};

class FacetFinder {
public:
    explicit FacetFinder(const scene::Primitive& primitive) : primitive_(primitive) {
        std::unordered_map<glm::vec3, uint32_t, PlaceHash> known;
        places_.reserve(primitive.vertices.size());
        for (const scene::Vertex& vertex : primitive.vertices)  // a negative zero is the place that zero is
            places_.push_back(known.try_emplace(vertex.position + 0.0f, uint32_t(known.size())).first->second);
        edges_.reserve(primitive.indices.size());
        for (uint32_t i = 0; i < primitive.indices.size() / 3; ++i)
            for (uint32_t k = 0; k < 3; ++k) edges_.push_back(edge(i, k));
        std::sort(edges_.begin(), edges_.end());
    }

    Facet of(uint32_t triangle) const {
        Facet facet{{vertex(triangle, 0), vertex(triangle, 1), vertex(triangle, 2)}, 3};
        float longest = 0;
        for (uint32_t k = 0; k < 3; ++k) {
            const auto fourth = fourth_across(triangle, k);
            const float length = glm::distance(place(triangle, k), place(triangle, k + 1));
            if (!fourth || length <= longest) continue;
            longest = length;
            const uint32_t a = vertex(triangle, 0), b = vertex(triangle, 1), c = vertex(triangle, 2);
            facet.corners = k == 0   ? std::array{a, *fourth, b, c}
                            : k == 1 ? std::array{a, b, *fourth, c}
                                     : std::array{a, b, c, *fourth};
            facet.count = 4;
        }
        return facet;
    }

private:
    uint32_t vertex(uint32_t triangle, uint32_t corner) const { return primitive_.indices[3 * triangle + corner % 3]; }
    const glm::vec3& place(uint32_t triangle, uint32_t corner) const {
        return primitive_.vertices[vertex(triangle, corner)].position;
    }
    Edge edge(uint32_t triangle, uint32_t corner) const {
        return {places_[vertex(triangle, corner)], places_[vertex(triangle, corner + 1)], triangle, corner};
    }
    // Towards the front, of twice the triangle's area.
    glm::vec3 area(uint32_t triangle) const {
        const glm::vec3& a = place(triangle, 0);
        return glm::cross(place(triangle, 1) - a, place(triangle, 2) - a);
    }

    // The last corner of a convex quadrilateral whose diagonal is this edge of the triangle.
    std::optional<uint32_t> fourth_across(uint32_t triangle, uint32_t corner) const {
        const Edge here = edge(triangle, corner);
        const glm::vec3 front = area(triangle);
        auto other = std::lower_bound(edges_.begin(), edges_.end(), Edge{here.to, here.from, 0, 0});
        for (size_t seen = 0;
             other != edges_.end() && other->from == here.to && other->to == here.from && seen < kMostAtOneEdge;
             ++other, ++seen) {
            const glm::vec3 there = area(other->triangle);
            const bool flat = glm::dot(front, there) > kFlat * glm::length(front) * glm::length(there);
            if (flat && is_convex({place(triangle, corner + 2), place(triangle, corner),
                                   place(other->triangle, other->corner + 2), place(triangle, corner + 1)},
                                  front))
                return vertex(other->triangle, other->corner + 2);
        }
        return std::nullopt;
    }

    static bool is_convex(const std::array<glm::vec3, 4>& corners, const glm::vec3& front) {
        for (size_t k = 0; k < 4; ++k) {
            const glm::vec3 in = corners[(k + 1) % 4] - corners[k], out = corners[(k + 2) % 4] - corners[(k + 1) % 4];
            if (!(glm::dot(glm::cross(in, out), front) > 0)) return false;
        }
        return true;
    }

    const scene::Primitive& primitive_;
    std::vector<uint32_t> places_;  // of vertices
    std::vector<Edge> edges_;       // sorted
};

}  // namespace

std::vector<Facet> facets(const scene::Primitive& primitive) {
    const FacetFinder finder(primitive);
    std::vector<Facet> found;
    found.reserve(primitive.indices.size() / 3);
    for (uint32_t i = 0; i < primitive.indices.size() / 3; ++i) found.push_back(finder.of(i));
    return found;
}

}  // namespace vesper::gpu_scene
