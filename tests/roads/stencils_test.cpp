// Paint of stencils. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "roads/lit_roads.h"
#include "roads/road_texts.h"
#include "roads/scene_parts.h"
#include "roads/stencils.h"

namespace vesper::test {
namespace {

std::string shape_of(const std::string& name, const std::string& subtype = "") {
    roads::RoadObject object;
    object.name = name, object.subtype = subtype;
    const auto shape = roads::arrow_of(object);
    if (!shape) return "none";
    return std::string(shape->straight ? "S" : "") + (shape->left ? "L" : "") + (shape->right ? "R" : "");
}

roads::LitRoads lit_of(const std::string& objects) {
    roads::LitRoadOptions options;
    options.lamps.spacing = 0;
    return roads::lit_roads(network_of(road("1", 90, geometry(0, 0, 0, 0, 90, "<line/>"), two_way_section(),
                                            "<objects>" + objects + "</objects>")),
                            options);
}

std::string stencil(const std::string& name, double t, double heading, const std::string& rest = "") {
    return "<object id=\"1\" name=\"" + name + "\" type=\"-1\" s=\"40\"" + quantity("t", t) + quantity("hdg", heading) +
           " zOffset=\"0\" orientation=\"-\" width=\"1.9\" length=\"4\" height=\"0.01\">" + rest + "</object>";
}

/// The middle of the paint by area, X and Z, m.
glm::dvec2 middle_of(const std::vector<Triangle>& paint) {
    glm::dvec2 sum(0);
    double area = 0;
    for (const Triangle& triangle : paint) {
        const double part = glm::length(triangle.across()) / 2;
        const glm::dvec3 middle = (triangle.corners[0] + triangle.corners[1] + triangle.corners[2]) / 3.0;
        sum += part * glm::dvec2(middle.x, middle.z), area += part;
    }
    return sum / area;
}

TEST(Stencils, AreKnownByTheirNames) {
    EXPECT_EQ(shape_of("Stencil_ArrowType4L"), "L");
    EXPECT_EQ(shape_of("Stencil_ArrowType4R02"), "R");
    EXPECT_EQ(shape_of("Stencil_ArrowType2SL"), "SL");
    EXPECT_EQ(shape_of("Stencil_ArrowType1Long"), "S");
    EXPECT_EQ(shape_of("Stencil_ArrowType1L"), "L");
    EXPECT_EQ(shape_of("", "arrowStraightLeftRight"), "SLR");
    EXPECT_EQ(shape_of("", "arrowLeftRight"), "LR");
    EXPECT_EQ(shape_of("Arrow"), "S");
    EXPECT_EQ(shape_of("arrowLeft", "arrow"), "L") << "the name says";
    EXPECT_EQ(shape_of("Stencil_STOP"), "none");
    for (const char* name : {"UTurnArrow", "Arrow_U-Turn_Left", "turn arrow"}) {
        EXPECT_EQ(shape_of(name), "none") << name;
        roads::RoadObject object;
        object.name = name;
        EXPECT_TRUE(roads::is_shapeless(object)) << name;
    }
}

// Closed form: stem, bar and head of a turn in 4 m x 1.9 m.
TEST(Stencils, ArrowsHaveTheAreaOfTheirParts) {
    const double stem = 0.075, across = 0.38 * 4, bar = 0.03 * 4, middle = 1.9 / 4;
    const double head = 0.45 * (1.9 / 2 + middle);
    const double area = 2 * stem * (across + bar + 2) + 2 * bar * (1.9 / 2 - head + middle - stem) + 0.12 * 4 * head;
    const auto paint = triangles_of(lit_of(stencil("Stencil_ArrowType4L", -1.75, 0)).scene, "marking white");
    EXPECT_NEAR(area_of(paint), area, 1e-4);
    for (const Triangle& triangle : paint)
        for (const glm::dvec3& c : triangle.corners) {
            EXPECT_NEAR(c.y, 0.009, 1e-4) << "on the road";
            EXPECT_TRUE(c.x > 38 - 1e-3 && c.x < 42 + 1e-3 && c.z > 0.8 - 1e-3 && c.z < 2.7 + 1e-3);
        }
}

// The head is ahead of the middle, and the paint of a turn lies to its side. Lane -1 leads to +X, lane 1 to -X.
TEST(Stencils, ArrowsPointAsTheirLaneLeads) {
    constexpr double kHalfTurn = 3.14159265358979;
    for (const double heading : {0.0, kHalfTurn}) {
        const auto right_lane =
            triangles_of(lit_of(stencil("Stencil_ArrowType1", -1.75, heading)).scene, "marking white");
        const auto left_lane =
            triangles_of(lit_of(stencil("Stencil_ArrowType1", 1.75, heading)).scene, "marking white");
        EXPECT_GT(middle_of(right_lane).x, 40.2) << heading;
        EXPECT_LT(middle_of(left_lane).x, 39.8) << heading;
    }
}

TEST(Stencils, FillTheRectangleOfTheirOutline) {
    const std::string frame =
        "<outline><cornerLocal u=\"-1\" v=\"-0.5\" z=\"0\"/><cornerLocal u=\"1\" v=\"-0.5\" z=\"0\"/><cornerLocal "
        "u=\"1\" v=\"0.5\" z=\"0\"/><cornerLocal u=\"-1\" v=\"0.5\" z=\"0\"/></outline>";
    double low = 1e9, high = -1e9;
    for (const Triangle& triangle :
         triangles_of(lit_of(stencil("Stencil_ArrowType1", -1.75, 0, frame)).scene, "marking white"))
        for (const glm::dvec3& c : triangle.corners) low = std::min(low, c.x), high = std::max(high, c.x);
    EXPECT_NEAR(low, 39, 1e-3);
    EXPECT_NEAR(high, 41, 1e-3);
    EXPECT_LT(area_of(triangles_of(lit_of(stencil("Stencil_ArrowType1", -1.75, 0, frame)).scene, "marking white")), 1);
}

TEST(Stencils, OfLettersAreLeftOutAndSaid) {
    const roads::LitRoads lit = lit_of(stencil("Stencil_STOP", -1.75, 0));
    EXPECT_TRUE(triangles_of(lit.scene, "marking white").empty());
    EXPECT_EQ(
        std::count(lit.notes.begin(), lit.notes.end(), "stencils left out, whose shape is not known: Stencil_STOP (1)"),
        1);
}

TEST(Stencils, LinesOfNoWidthHaveTheUsualOne) {
    const std::string line =
        "<object id=\"1\" name=\"StopLine\" type=\"roadMark\" s=\"40\" t=\"-1.75\" hdg=\"0\" "
        "length=\"0.5\" width=\"3\"><markings><marking side=\"front\" width=\"0\" color=\"white\" "
        "zOffset=\"0\" lineLength=\"0\" spaceLength=\"0\" startOffset=\"0\" stopOffset=\"0\"/>"
        "</markings></object>";
    EXPECT_NEAR(area_of(triangles_of(lit_of(line).scene, "marking white")), 3 * 0.1, 1e-3);
}

}  // namespace
}  // namespace vesper::test
