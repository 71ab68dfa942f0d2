// The ground around roads. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "base/budget.h"
#include "roads/lit_road_parts.h"

namespace vesper::roads {
namespace {

constexpr double kCell = 3;         // m
constexpr double kHorizon = 6000;   // m
constexpr double kFlatFace = 0.02;  // m that a larger face may lie off the nodes it covers
constexpr uint32_t kLargest = 32;   // cells along a face

struct GroundBuilder {
    RoadBuild& build;
    RoadMesh mesh{build.network};

    RoadMesh::Corner corner(uint32_t column, uint32_t row) const {
        return {build.ground.node(column, row), build.ground.normal(column, row)};
    }

    bool is_flat(uint32_t c0, uint32_t r0, uint32_t c1, uint32_t r1) const {
        const Ground& g = build.ground;
        const double z00 = g.node(c0, r0).z, z10 = g.node(c1, r0).z, z01 = g.node(c0, r1).z, z11 = g.node(c1, r1).z;
        for (uint32_t r = r0; r <= r1; ++r)
            for (uint32_t c = c0; c <= c1; ++c) {
                const double x = double(c - c0) / (c1 - c0), y = double(r - r0) / (r1 - r0);
                // The two triangles over the diagonal from (0, 0) to (1, 1).
                const double z =
                    x > y ? z00 + (z10 - z00) * x + (z11 - z10) * y : z00 + (z01 - z00) * y + (z11 - z01) * x;
                if (std::abs(z - g.node(c, r).z) > kFlatFace) return false;
            }
        return true;
    }

    void face(uint32_t c0, uint32_t r0, uint32_t size) {
        const uint32_t c1 = std::min(c0 + size, build.ground.columns() - 1),
                       r1 = std::min(r0 + size, build.ground.rows() - 1);
        if (c0 >= c1 || r0 >= r1) return;
        if (size == 1 || is_flat(c0, r0, c1, r1))
            return mesh.quad(RoadMaterial::Grass, corner(c0, r0), corner(c1, r0), corner(c1, r1), corner(c0, r1));
        const uint32_t half = size / 2;
        face(c0, r0, half), face(c0 + half, r0, half), face(c0, r0 + half, half), face(c0 + half, r0 + half, half);
    }

    /// From the edge of the grid out to the horizon, as high as the edge.
    void horizon() {
        const Ground& g = build.ground;
        const glm::dvec3 first = g.node(0, 0), last = g.node(g.columns() - 1, g.rows() - 1);
        const glm::dvec2 middle = glm::dvec2(first + last) / 2.0, half = glm::dvec2(last - first) / 2.0;
        const glm::dvec2 scale = (half + kHorizon) / half;
        const auto far = [&](uint32_t c, uint32_t r) {
            const glm::dvec3 p = g.node(c, r);
            return RoadMesh::Corner{glm::dvec3(middle + (glm::dvec2(p) - middle) * scale, p.z)};
        };
        const auto edge = [&](uint32_t c0, uint32_t r0, uint32_t c1, uint32_t r1) {
            mesh.quad(RoadMaterial::Grass, far(c0, r0), far(c1, r1), corner(c1, r1), corner(c0, r0));
        };
        const uint32_t right = g.columns() - 1, top = g.rows() - 1;
        for (uint32_t c = 0; c < right; c += kLargest)
            edge(c, 0, std::min(c + kLargest, right), 0), edge(std::min(c + kLargest, right), top, c, top);
        for (uint32_t r = 0; r < top; r += kLargest)
            edge(0, std::min(r + kLargest, top), 0, r), edge(right, r, right, std::min(r + kLargest, top));
    }
};

}  // namespace

Ground make_ground(const RoadNetwork&, const std::vector<CutSection>& cuts, double margin) {
    glm::dvec2 low(INFINITY), high(-INFINITY);
    for (const CutSection& cut : cuts)
        for (const auto& row : cut.rows)
            for (const LaneEdges& edges : row)
                low = glm::min(low, glm::dvec2(edges.outer.position)),
                high = glm::max(high, glm::dvec2(edges.outer.position));
    if (!(low.x <= high.x)) low = high = glm::dvec2(0);
    Ground ground(low - margin, high + margin, kCell);
    const double step = ground.cell() / 2;
    for (const CutSection& cut : cuts)
        for (size_t i = 0; i + 1 < cut.rows.size(); ++i)
            for (size_t l = 0; l < cut.rows[i].size(); ++l) {
                const LaneEdges &a = cut.rows[i][l], &b = cut.rows[i + 1][l];
                const double length = std::max(glm::distance(a.inner.position, b.inner.position),
                                               glm::distance(a.outer.position, b.outer.position));
                const double width = std::max(glm::distance(a.inner.position, a.outer.position),
                                              glm::distance(b.inner.position, b.outer.position));
                const auto along = static_cast<int>(std::clamp(std::ceil(length / step), 1.0, 1000.0)),
                           across = static_cast<int>(std::clamp(std::ceil(width / step), 1.0, 1000.0));
                for (int x = 0; x <= along; ++x) {
                    check_time();
                    for (int y = 0; y <= across; ++y)
                        ground.stay_below(glm::mix(glm::mix(a.inner.position, b.inner.position, double(x) / along),
                                                   glm::mix(a.outer.position, b.outer.position, double(x) / along),
                                                   double(y) / across));
                }
            }
    ground.spread();
    return ground;
}

void build_ground(RoadBuild& build) {
    GroundBuilder builder{build};
    for (uint32_t row = 0; row + 1 < build.ground.rows(); row += kLargest)
        for (uint32_t column = 0; column + 1 < build.ground.columns(); column += kLargest) {
            builder.face(column, row, kLargest);
            builder.mesh.place(build.scene, build.materials, "ground");
        }
    builder.horizon();
    builder.mesh.place(build.scene, build.materials, "ground");
}

}  // namespace vesper::roads
