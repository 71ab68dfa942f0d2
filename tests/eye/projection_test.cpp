// The map of a projector against closed forms. SPDX-License-Identifier: MIT
#include "eye/projection.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "support/complaints.h"

namespace vesper::test::projection_map_test {
namespace {

using eye::Projection, eye::projection_of, vision::BlendMask, vision::WarpMesh, vision::WarpNode;

// Places are stored as floats: half a unit in the last place of what is less than 256 px.
constexpr double kPlace = 256 * 6e-8;

/// A mesh over a picture of this aspect whose node at (s, t), each 0 to 1 from the first to the last, is `node`.
WarpMesh mesh_of(uint32_t columns, uint32_t rows, const std::function<WarpNode(double s, double t)>& node) {
    WarpMesh mesh{"made.data", columns, rows, {}};
    for (uint32_t row = 0; row < rows; ++row)
        for (uint32_t column = 0; column < columns; ++column)
            mesh.nodes.push_back(node(column / (columns - 1.0), row / (rows - 1.0)));
    return mesh;
}

WarpNode straight(double s, double t, double aspect) { return {(2 * s - 1) * aspect, 2 * t - 1, s, t, 1}; }

struct Wanted {
    glm::dvec2 at;
    double factor;  // negative: not drawn
};

/// `wanted` of a place on the projector's picture, each coordinate 0 to 1 from its top left: px of the rendered
/// picture.
void expect_map(const Projection& got, const std::function<Wanted(double x, double y)>& wanted) {
    const auto [width, height] = got.extent;
    ASSERT_EQ(got.pixels.size(), size_t{width} * height);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const shared::ProjectedPixel& pixel = got.pixels[size_t{y} * width + x];
            const Wanted want = wanted((x + 0.5) / width, (y + 0.5) / height);
            const std::string where = std::to_string(x) + ", " + std::to_string(y);
            ASSERT_EQ(pixel.factor < 0, want.factor < 0) << where;
            if (want.factor < 0) continue;
            ASSERT_NEAR(double(pixel.at.x), want.at.x, kPlace) << where;
            ASSERT_NEAR(double(pixel.at.y), want.at.y, kPlace) << where;
            ASSERT_NEAR(double(pixel.factor), want.factor, 1e-7) << where;
        }
}

constexpr VkExtent2D kPicture{200, 90};
constexpr double kWidth = 200, kHeight = 90;
const std::vector<VkExtent2D> kProjectors{{1, 1}, {37, 23}, {200, 90}, {64, 130}};

double aspect_of(VkExtent2D extent) { return double(extent.width) / extent.height; }

TEST(ProjectionMap, WithoutAMeshThePictureFillsTheProjectors) {
    for (const VkExtent2D projector : kProjectors) {
        const Projection got = projection_of(kPicture, projector);
        EXPECT_EQ(got.picture.width, 200u);
        EXPECT_EQ(got.extent.height, projector.height);
        expect_map(got, [](double x, double y) { return Wanted{{x * kWidth, y * kHeight}, 1}; });
    }
    const Projection same = projection_of(kPicture, kPicture);
    EXPECT_EQ(same.pixels[0].at, glm::vec2(0.5f));
    EXPECT_EQ(same.pixels.back().at, glm::vec2(199.5f, 89.5f));
}

TEST(ProjectionMap, AStraightMeshIsNone) {
    for (const VkExtent2D projector : kProjectors)
        for (const auto& [columns, rows] : {std::pair(2u, 2u), {5u, 3u}, {64u, 17u}, {300u, 300u}}) {
            const WarpMesh mesh =
                mesh_of(columns, rows, [&](double s, double t) { return straight(s, t, aspect_of(projector)); });
            expect_map(projection_of(kPicture, projector, &mesh), [](double x, double y) {
                return Wanted{{x * kWidth, y * kHeight}, 1};
            });
        }
    // Where it is the same picture the middles of pixels are exact, so that codes are.
    const WarpMesh mesh = mesh_of(7, 5, [](double s, double t) { return straight(s, t, aspect_of(kPicture)); });
    const Projection got = projection_of(kPicture, kPicture, &mesh);
    for (size_t i = 0; i < got.pixels.size(); ++i) {
        ASSERT_EQ(got.pixels[i].at, glm::vec2(float(i % 200) + 0.5f, float(i / 200) + 0.5f));
        ASSERT_EQ(got.pixels[i].factor, 1);
    }
}

TEST(ProjectionMap, HalfTheSizeLeavesTheRestDark) {
    for (const VkExtent2D projector : kProjectors) {
        const double aspect = aspect_of(projector);
        const WarpMesh mesh = mesh_of(4, 4, [&](double s, double t) {
            return WarpNode{(s - 0.5) * aspect, t - 0.5, s, t, 1};
        });
        expect_map(projection_of(kPicture, projector, &mesh), [](double x, double y) {
            const bool inside = std::abs(x - 0.5) <= 0.25 && std::abs(y - 0.5) <= 0.25;
            return Wanted{{(2 * x - 0.5) * kWidth, (2 * y - 0.5) * kHeight}, inside ? 1.0 : -1.0};
        });
    }
}

TEST(ProjectionMap, MirroredMeshesTurnThePicture) {
    const VkExtent2D projector{37, 23};
    const WarpMesh left_right = mesh_of(3, 4, [&](double s, double t) {
        WarpNode node = straight(s, t, aspect_of(projector));
        node.u = 1 - s;
        return node;
    });
    expect_map(projection_of(kPicture, projector, &left_right), [](double x, double y) {
        return Wanted{{(1 - x) * kWidth, y * kHeight}, 1};
    });
    // The other way round of its nodes: rows from the top, as other programs write them.
    const WarpMesh downwards =
        mesh_of(3, 4, [&](double s, double t) { return straight(s, 1 - t, aspect_of(projector)); });
    expect_map(projection_of(kPicture, projector, &downwards), [](double x, double y) {
        return Wanted{{x * kWidth, y * kHeight}, 1};
    });
}

// A trapezoid of one cell: on either side of the diagonal from its first node to the last, u and v are linear.
TEST(ProjectionMap, KeystoneIsLinearOnEitherSideOfTheDiagonal) {
    const VkExtent2D projector{64, 64};
    constexpr double kNarrow = 0.5;  // the upper edge, of the lower one
    const WarpMesh mesh = mesh_of(2, 2, [&](double s, double t) {
        return WarpNode{(2 * s - 1) * (t == 1 ? kNarrow : 1), 2 * t - 1, s, t, 1};
    });
    expect_map(projection_of(kPicture, projector, &mesh), [&](double left, double top) {
        const double x = 2 * left - 1, y = 1 - 2 * top, half = 1 - (1 - kNarrow) * (y + 1) / 2;
        if (std::abs(x) > half) return Wanted{{}, -1};
        const double v = (y + 1) / 2, diagonal = -1 + (1 + kNarrow) * v;
        // Below it from (-1, -1), (1, -1), (0.5, 1); above it from (-1, -1), (0.5, 1), (-0.5, 1).
        const double u = x >= diagonal ? (x + 1 + (1 - kNarrow) * v) / 2 : (x + 1 - (1 - kNarrow) * v) / (2 * kNarrow);
        return Wanted{{u * kWidth, (1 - v) * kHeight}, 1};
    });
}

TEST(ProjectionMap, CellsWithANodeThatIsNotDrawnAreHoles) {
    const VkExtent2D projector{50, 40};
    const WarpMesh mesh = mesh_of(6, 6, [&](double s, double t) {
        WarpNode node = straight(s, t, aspect_of(projector));
        if (std::lround(5 * s) == 2 && std::lround(5 * t) == 3) node.intensity = -0.01;
        return node;
    });
    expect_map(projection_of(kPicture, projector, &mesh), [](double x, double y) {
        const bool hole = x > 0.2 && x < 0.6 && 1 - y > 0.4 && 1 - y < 0.8;
        return Wanted{{x * kWidth, y * kHeight}, hole ? -1.0 : 1.0};
    });
}

TEST(ProjectionMap, IntensityIsLinearAndTheMaskMultipliesIt) {
    const VkExtent2D projector{37, 23};
    const WarpMesh mesh = mesh_of(9, 4, [&](double s, double t) {
        WarpNode node = straight(s, t, aspect_of(projector));
        node.intensity = 0.25 + 0.5 * s;
        return node;
    });
    BlendMask mask{"mask.png", 37, 23, {}};
    for (size_t i = 0; i < size_t{37} * 23; ++i) mask.factors.push_back(float(i % 5) / 4);
    const auto factor_at = [](double x, double y) {
        const auto i = size_t(y * 23) * 37 + size_t(x * 37);
        return double(i % 5) / 4;
    };
    expect_map(projection_of(kPicture, projector, &mesh, &mask), [&](double x, double y) {
        return Wanted{{x * kWidth, y * kHeight}, (0.25 + 0.5 * x) * factor_at(x, y)};
    });
    expect_map(projection_of(kPicture, projector, nullptr, &mask), [&](double x, double y) {
        return Wanted{{x * kWidth, y * kHeight}, factor_at(x, y)};
    });
    // A dark edge is drawn, and rounding does not make it a hole.
    const WarpMesh dark = mesh_of(9, 4, [&](double s, double t) {
        WarpNode node = straight(s, t, aspect_of(projector));
        node.intensity = 0;
        return node;
    });
    expect_map(projection_of(kPicture, projector, &dark), [&](double x, double y) {
        return Wanted{{x * kWidth, y * kHeight}, 0};
    });
}

// Of cells that overlap the last counts; those without an area have no pixels.
TEST(ProjectionMap, TheLastCellCounts) {
    const VkExtent2D projector{40, 40};
    WarpMesh folded{"folded.data",
                    2,
                    3,
                    {{-1, -1, 0, 0, 1},
                     {1, -1, 1, 0, 1},
                     {-1, 1, 0, 0.5, 1},
                     {1, 1, 1, 0.5, 1},
                     {-1, -1, 0, 1, 0.5},
                     {1, -1, 1, 1, 0.5}}};
    expect_map(projection_of(kPicture, projector, &folded), [](double x, double y) {
        return Wanted{{x * kWidth, (1 - y) * kHeight / 2}, 1 - 0.5 * y};
    });
    const WarpMesh flat = mesh_of(5, 5, [](double s, double) { return WarpNode{s, s, s, s, 1}; });
    expect_map(projection_of(kPicture, projector, &flat), [](double, double) { return Wanted{{}, -1}; });
}

TEST(ProjectionMap, WhatDoesNotFitIsRefused) {
    const BlendMask mask{"mask.png", 37, 22, std::vector<float>(size_t{37} * 22, 1.0f)};
    EXPECT_TRUE(contains(complaint_of([&] {
                             projection_of(kPicture, {37, 23}, nullptr, &mask);
                         }),
                         "mask.png: the blend mask has 37 x 22 px, the projector's picture 37 x 23"));
    for (const VkExtent2D extent : {VkExtent2D{0, 5}, {5, 0}, {16385, 1}}) {
        EXPECT_TRUE(contains(complaint_of([&] { projection_of(extent, {5, 5}); }), "the rendered picture has"));
        EXPECT_TRUE(contains(complaint_of([&] { projection_of({5, 5}, extent); }), "the projector's picture has"));
    }
    const WarpMesh broken{"broken.data", 3, 2, std::vector<WarpNode>(5)};
    EXPECT_TRUE(contains(complaint_of([&] {
                             projection_of(kPicture, {5, 5}, &broken);
                         }),
                         "broken.data: a mesh of 3 x 2 nodes does not have 5"));
}

// Work is bounded: here every cell covers all of the picture.
TEST(ProjectionMap, MeshesInManyLayersAreRefused) {
    const WarpMesh mesh = mesh_of(1024, 1024, [](double s, double t) {
        const auto side = [](double along) { return std::lround(along * 1023) % 2 ? 1.0 : -1.0; };
        return WarpNode{side(s), side(t), s, t, 1};
    });
    EXPECT_TRUE(contains(complaint_of([&] {
                             projection_of(kPicture, {400, 400}, &mesh);
                         }),
                         "made.data: the cells of the mesh lie on one another more than 64 times"));
}

}  // namespace
}  // namespace vesper::test::projection_map_test
