#include "gpu_scene/facets.h"

#include <algorithm>
#include <compare>
#include <cstring>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <unordered_map>

namespace vesper::gpu_scene {
namespace {

constexpr float kFlat = 0.9999995f;    // cosine between the normals of one plane: 0.06 degrees
constexpr size_t kMostAtOneEdge = 16;  // triangles that are looked at
constexpr float kSameUv = 1e-5f;
constexpr int kSameColour = 128;    // of 65535
constexpr float kLinearUv = 1e-3f;  // of the longest way over the triangle

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
    FacetFinder(const scene::Primitive& primitive, const scene::Material& material)
        : primitive_(primitive),
          textured_(material.base_colour_texture.image != scene::kNone ||
                    material.emission_texture.image != scene::kNone || material.emission_picture.image != scene::kNone),
          masked_(material.alpha == scene::Material::Alpha::Mask) {
        std::unordered_map<glm::vec3, uint32_t, PlaceHash> known;
        places_.reserve(primitive.vertices.size());
        for (const scene::Vertex& vertex : primitive.vertices)  // a negative zero is the place that zero is
            places_.push_back(known.try_emplace(vertex.position + 0.0f, uint32_t(known.size())).first->second);
        edges_.reserve(primitive.indices.size());
        for (uint32_t i = 0; i < primitive.indices.size() / 3; ++i)
            for (uint32_t k = 0; k < 3; ++k) edges_.push_back(edge(i, k));
        std::sort(edges_.begin(), edges_.end());
        find_regions();
    }

    Facet of(uint32_t triangle) const {
        Facet facet{{vertex(triangle, 0), vertex(triangle, 1), vertex(triangle, 2)}, 3, regions_[triangle]};
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

    // The edges of triangles across one.
    std::span<const Edge> across(const Edge& here) const {
        const auto first = std::lower_bound(edges_.begin(), edges_.end(), Edge{here.to, here.from, 0, 0});
        auto last = first;
        while (last != edges_.end() && last->from == here.to && last->to == here.from &&
               size_t(last - first) < kMostAtOneEdge)
            ++last;
        return {first, last};
    }

    bool is_same(uint32_t a, uint32_t b) const {
        const scene::Vertex &one = primitive_.vertices[a], &other = primitive_.vertices[b];
        for (size_t c = 0; c < 4; ++c)
            if (std::abs(int(one.colour[c]) - int(other.colour[c])) > kSameColour) return false;
        const auto near = [](glm::vec2 here, glm::vec2 there) {
            const glm::vec2 apart = glm::abs(here - there);
            return std::max(apart.x, apart.y) <= kSameUv;
        };
        return !textured_ || (near(one.uv, other.uv) && near(one.emission_uv(), other.emission_uv()));
    }
    // Whether what is drawn goes on across an edge.
    bool goes_on(const Edge& here, const Edge& there) const {
        return is_same(vertex(here.triangle, here.corner), vertex(there.triangle, there.corner + 1)) &&
               is_same(vertex(here.triangle, here.corner + 1), vertex(there.triangle, there.corner));
    }

    void find_regions() {
        regions_.resize(primitive_.indices.size() / 3);
        std::iota(regions_.begin(), regions_.end(), 0u);
        const auto root = [&](uint32_t triangle) {
            while (regions_[triangle] != triangle) triangle = regions_[triangle] = regions_[regions_[triangle]];
            return triangle;
        };
        const auto unite = [&](uint32_t a, uint32_t b) { regions_[root(a)] = root(b); };
        for (const Edge& here : edges_)
            for (const Edge& there : across(here))
                if (goes_on(here, there)) unite(here.triangle, there.triangle);
        std::map<std::array<uint16_t, 4>, uint32_t> coloured;
        for (uint32_t i = 0; i < primitive_.indices.size() && !textured_; ++i)
            unite(i / 3, coloured.try_emplace(primitive_.vertices[primitive_.indices[i]].colour, i / 3).first->second);
        for (uint32_t i = 0; i < regions_.size(); ++i) regions_[i] = root(i);
    }

    // Whether a triangle's texture goes on linearly to a vertex in its plane.
    bool is_linear(uint32_t triangle, uint32_t to) const {
        const auto uv = [&](uint32_t corner) { return primitive_.vertices[vertex(triangle, corner)].uv; };
        const glm::vec3 &a = place(triangle, 0), ab = place(triangle, 1) - a, ac = place(triangle, 2) - a,
                        ad = primitive_.vertices[to].position - a, front = area(triangle);
        const float size = glm::dot(front, front);
        const float along_b = glm::dot(glm::cross(ad, ac), front) / size,
                    along_c = glm::dot(glm::cross(ab, ad), front) / size;
        const glm::vec2 b = uv(1) - uv(0), c = uv(2) - uv(0),
                        off = primitive_.vertices[to].uv - (uv(0) + along_b * b + along_c * c);
        return glm::length(off) <= kLinearUv * std::max(glm::length(b), glm::length(c));
    }

    // The last corner of a convex quadrilateral whose diagonal is this edge of the triangle.
    std::optional<uint32_t> fourth_across(uint32_t triangle, uint32_t corner) const {
        const Edge here = edge(triangle, corner);
        const glm::vec3 front = area(triangle);
        for (const Edge& other : across(here)) {
            const glm::vec3 there = area(other.triangle);
            const uint32_t fourth = vertex(other.triangle, other.corner + 2);
            const bool flat = glm::dot(front, there) > kFlat * glm::length(front) * glm::length(there);
            if (flat && goes_on(here, other) && (!masked_ || is_linear(triangle, fourth)) &&
                is_convex({place(triangle, corner + 2), place(triangle, corner), primitive_.vertices[fourth].position,
                           place(triangle, corner + 1)},
                          front))
                return fourth;
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
    std::vector<uint32_t> places_;   // of vertices
    std::vector<Edge> edges_;        // sorted
    std::vector<uint32_t> regions_;  // of triangles
    bool textured_, masked_;
};

}  // namespace

std::vector<Facet> facets(const scene::Primitive& primitive, const scene::Material& material) {
    const FacetFinder finder(primitive, material);
    std::vector<Facet> found;
    found.reserve(primitive.indices.size() / 3);
    for (uint32_t i = 0; i < primitive.indices.size() / 3; ++i) found.push_back(finder.of(i));
    return found;
}

}  // namespace vesper::gpu_scene
