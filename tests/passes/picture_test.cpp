// Pictures in external images on the device, against their reference; and the contract of the executor for such images.
// SPDX-License-Identifier: MIT
#include "passes/picture_reference.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "render/passes/picture.h"
#include "support/texels.h"

namespace vesper::test::picture_test {
namespace {

/// An image that no graph knows of.
struct Stranger {
    Stranger(const gpu::Device& device, VkFormat format, VkExtent2D extent)
        : arena(device),
          image(gpu::make_image(device, gpu::image_info(format, extent, 1,
                                                        VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                                            VK_IMAGE_USAGE_TRANSFER_SRC_BIT))),
          described{image.get(), format, extent, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL} {
        arena.bind(image.get());
    }
    graph::ExternalImage filled() const {
        graph::ExternalImage f = described;
        f.before = f.after;
        return f;
    }
    gpu::Arena arena;
    gpu::OwnedImage image;
    graph::ExternalImage described;
};

template <class T>
void fill(PassRig& rig, const Stranger& stranger, const std::vector<T>& texels) {
    graph::FrameGraph graph;
    graph.copy("fill", graph.upload("texels", texels), graph.target("stranger", stranger.described));
    rig.run(graph);
}

std::vector<glm::vec4> map(PassRig& rig, const Stranger& stranger, float scale) {
    graph::FrameGraph graph;
    const graph::Resource picture = graph.external("stranger", stranger.filled());
    const graph::Resource scene = render::add_picture(rig.frame(graph, stranger.described.extent), picture, scale);
    const graph::Resource kept = keep<glm::vec4>(graph, scene);
    rig.run(graph);
    return rig.got<glm::vec4>(kept);
}

std::vector<glm::vec4> texels_of(VkExtent2D extent) {
    std::vector<glm::vec4> texels;
    for (uint32_t i = 0; i < extent.width * extent.height; ++i)
        texels.emplace_back(std::pow(10.0f, -4 + 0.13f * float(i % 60)), float(i), 0.25f, float(i % 2));
    return texels;
}

// One product of floats: half a unit in the last place.
void expect_reference(const std::vector<glm::vec4>& got, const std::vector<glm::vec4>& texels, float scale) {
    ASSERT_EQ(got.size(), texels.size());
    for (size_t i = 0; i < got.size(); ++i) {
        const glm::dvec4 want = reference::add_picture(glm::dvec3(texels[i]), double(scale));
        for (int c = 0; c < 4; ++c)
            ASSERT_NEAR(double(got[i][c]), want[c], 6e-8 * std::abs(want[c])) << "texel " << i << ", " << c;
    }
}

TEST(Picture, IsTheReferenceAtAwkwardSizes) {
    PassRig rig;
    for (const VkExtent2D extent : {VkExtent2D{1, 1}, {7, 5}, {65, 3}, {130, 9}}) {
        const std::vector<glm::vec4> texels = texels_of(extent);
        const Stranger floats(rig.device(), VK_FORMAT_R32G32B32A32_SFLOAT, extent);
        fill(rig, floats, texels);
        expect_reference(map(rig, floats, 179), texels, 179);
        const Stranger halves(rig.device(), VK_FORMAT_R16G16B16A16_SFLOAT, extent);
        const std::vector<uint64_t> packed = to_halves(texels);
        fill(rig, halves, packed);
        expect_reference(map(rig, halves, 0.5f), from_halves(packed), 0.5f);
    }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Picture, WhatIsNotFiniteStaysSo) {
    PassRig rig;
    constexpr float inf = std::numeric_limits<float>::infinity();
    const Stranger floats(rig.device(), VK_FORMAT_R32G32B32A32_SFLOAT, {2, 1});
    fill(rig, floats, std::vector<glm::vec4>{{inf, 1, -inf, 1}, {std::numeric_limits<float>::quiet_NaN(), 2, 3, 1}});
    const auto got = map(rig, floats, 2);
    EXPECT_EQ(got[0], glm::vec4(inf, 2, -inf, 1));
    EXPECT_TRUE(std::isnan(got[1].r));
    EXPECT_EQ(got[1].g, 4);
    EXPECT_EQ(rig.complaints(), "");
}

// More frames than may be under way, without waiting: each doubles what the one before left in the same image.
TEST(Picture, FramesFollowOneAnother) {
    PassRig rig;
    constexpr VkExtent2D extent{33, 17};
    Stranger one(rig.device(), VK_FORMAT_R32G32B32A32_SFLOAT, extent),
        other(rig.device(), VK_FORMAT_R32G32B32A32_SFLOAT, extent);
    fill(rig, one, std::vector<glm::vec4>(33 * 17, glm::vec4(1)));
    graph::Resource kept;
    for (int frame = 0; frame < 7; ++frame) {
        const Stranger &from = frame % 2 ? other : one, &to = frame % 2 ? one : other;
        graph::FrameGraph graph;
        const graph::Resource scene =
            render::add_picture(rig.frame(graph, extent), graph.external("from", from.filled()), 2);
        graph.copy("show", scene, graph.target("to", to.described));
        kept = keep<glm::vec4>(graph, scene);
        rig.executor().submit(graph, {});
        EXPECT_THROW(rig.executor().read(kept), Error) << "it is under way";
    }
    rig.executor().finish();
    for (const glm::vec4& texel : rig.got<glm::vec4>(kept)) ASSERT_EQ(texel, glm::vec4(128, 128, 128, 1));
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Picture, ImagesOfOthersAreReadOrWrittenNotBoth) {
    graph::FrameGraph graph;
    const graph::ExternalImage described{
        VK_NULL_HANDLE, VK_FORMAT_R32G32B32A32_SFLOAT, {2, 2}, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_GENERAL};
    const graph::Resource read = graph.external("read", described),
                          texels = graph.upload("texels", std::vector<float>(16));
    EXPECT_THROW(graph.copy("write", texels, read), Error);
    const graph::Resource written = graph.target("written", described);
    EXPECT_THROW(
        graph.copy("read", written, graph.transient("copy", graph::image_shape(VK_FORMAT_R32G32B32A32_SFLOAT, {2, 2}))),
        Error)
        << "before anything wrote it";
    EXPECT_THROW(graph.compile([](const graph::Shape&, uint32_t) {
        return graph::Footprint{1, 1, 1};
    }),
                 Error)
        << "nothing writes what is to be shown";
}

}  // namespace
}  // namespace vesper::test::picture_test
