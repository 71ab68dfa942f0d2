// Surfaces that are the glass of lamps. SPDX-License-Identifier: MIT
#include "scene/lamp_glass.h"

#include <cmath>

#include "base/budget.h"
#include "scene/named_parts.h"

namespace vesper::test {
namespace {

using scene::GlassLamp;

/// Squares of 0.1 m, one below each of `count` places on a line of 0.7 m steps along an axis and a little off it.
struct LitLine {
    NamedParts street;
    std::vector<GlassLamp> lamps;

    LitLine(int axis, int count) {
        const uint32_t root = street.node("root"), shown = street.node("sheet", root), glass = street.material("glass");
        for (int i = 0; i < count; ++i) {
            glm::dvec3 at(0, 5, 0.3 * (i % 7));
            at[axis] += 0.7 * ((i * 37) % count);
            street.show(shown, glass, glm::vec3(at) - glm::vec3(0.05f, 0.2f, 0.05f), {0.1f, 0, 0}, {0, 0, 0.1f});
            lamps.push_back({street.node("lamp", root, at), at, {0, -1, 0}, {}, {}});
        }
        // One surface that reaches by all lamps.
        std::vector<scene::Primitive>& parts = street.scene.meshes[0].primitives;
        for (size_t i = 1; i < parts.size(); ++i) {
            const auto first = uint32_t(parts[0].vertices.size());
            for (const scene::Vertex& vertex : parts[i].vertices)
                parts[0].vertices.push_back(vertex), parts[0].bounds.add(vertex.position);
            for (const uint32_t index : parts[i].indices) parts[0].indices.push_back(first + index);
        }
        parts.resize(1);
    }
    std::vector<GlassLamp> lit() const {
        std::vector<GlassLamp> made = lamps;
        scene::add_glass(street.scene, scene::world_transforms(street.scene, 0), {0},
                         {.name = {}, .materials = {}, .luminance = 50}, nullptr, made);
        return made;
    }
};

/// The area of triangles whose nearest lamp of all is this one, within reach, m^2.
double area_by_search(const LitLine& line, size_t lamp) {
    const scene::Primitive& p = line.street.scene.meshes[0].primitives[0];
    double area = 0;
    for (size_t i = 0; i < p.indices.size(); i += 3) {
        glm::dvec3 corners[3];
        for (size_t c = 0; c < 3; ++c) corners[c] = glm::dvec3(p.vertices[p.indices[i + c]].position);
        const glm::dvec3 centre = (corners[0] + corners[1] + corners[2]) / 3.0;
        size_t nearest = 0;
        for (size_t k = 1; k < line.lamps.size(); ++k)
            if (glm::distance(line.lamps[k].position, centre) < glm::distance(line.lamps[nearest].position, centre))
                nearest = k;
        if (nearest == lamp && glm::distance(line.lamps[lamp].position, centre) <= scene::kGlassReach)
            area += glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0])) / 2;
    }
    return area;
}

TEST(LampGlass, EachSurfaceIsOfItsNearestLamp) {
    for (int axis = 0; axis < 3; ++axis) {
        const LitLine line(axis, 40);
        const std::vector<GlassLamp> lit = line.lit();
        for (size_t i = 0; i < lit.size(); ++i) {
            const double area = area_by_search(line, i);
            EXPECT_NEAR(lit[i].front.area + lit[i].back.area, area, 1e-6) << axis << " " << i;
            EXPECT_NEAR(lit[i].front.lamp + lit[i].back.lamp, 50 * area, 1e-4) << axis << " " << i;
        }
    }
}

TEST(LampGlass, ASurfaceBeyondReachIsOfNone) {
    LitLine line(0, 3);
    for (GlassLamp& lamp : line.lamps) lamp.position.y += 2;
    for (const GlassLamp& lamp : line.lit()) EXPECT_EQ(lamp.front.area + lamp.back.area, 0);
}

// The time of a budget ends the work on the triangles of one surface.
TEST(LampGlass, TimeIsLimited) {
    const LitLine line(0, 60);
    Budget budget("reading s.gltf");
    budget.end = 0;
    EXPECT_THROW(line.lit(), OverLimit);
}

}  // namespace
}  // namespace vesper::test
