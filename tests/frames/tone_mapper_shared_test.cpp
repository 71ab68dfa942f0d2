// Every HDR picture of the shared set, on the device against the references. SPDX-License-Identifier: MIT
#include <filesystem>

#include <gtest/gtest.h>

#include "io/hdr_image.h"
#include "render/tone_mapper.h"
#include "support/reference_chain.h"
#include "support/shared_data.h"

namespace vesper::test {
namespace {

namespace fs = std::filesystem;

TEST(ToneMapperShared, EveryPictureEqualsTheReference) {
    const fs::path root = shared_data("hdr");
    if (!is_here(root)) GTEST_SKIP() << "the shared set is not here";
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(root))
        if (entry.path().extension() == ".exr" || entry.path().extension() == ".hdr") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    gpu::Device device;
    render::ToneMapper mapper(device);
    size_t shown = 0;
    for (const fs::path& file : files) {
        io::HdrImage image;
        try {
            image = io::read_hdr_image(file);
        } catch (const Error& error) {
            EXPECT_EQ(file.filename(), "Trunks.exr") << error.what();
            continue;
        }
        // As if white were 93 cd/m^2, in float as the device has it: 100 would put drawn pictures of one luminance
        // exactly on the edge of two bins, where rounding decides for all their pixels at once.
        const float scale = image.white_luminance > 0 ? float(image.white_luminance) : 93;
        std::vector<glm::vec4> pixels;
        for (size_t i = 0; i < image.rgb.size(); i += 3)
            pixels.emplace_back(scale * image.rgb[i], scale * image.rgb[i + 1], scale * image.rgb[i + 2], 1);
        const VkExtent2D extent{image.width, image.height};
        for (const auto& [wanted, tone] : {std::pair{render::Operator::Irawan, shared::kToneCurve},
                                           {render::Operator::Ward, shared::kToneCurve},
                                           {render::Operator::Pattanaik, shared::kToneColour},
                                           {render::Operator::Reinhard, shared::kToneReinhard}}) {
            render::ToneChainSettings settings;
            settings.tone_operator = wanted;
            mapper.reset_adaptation();
            const render::ToneMapped got =
                mapper.map(settings, {.extent = extent, .values = image.rgb, .scale = scale}, 0);
            const auto want = reference_codes(pixels, extent, settings, tone, got.foveal_level, 0);
            EXPECT_LE(pixels_off(got.display, want), pixels.size() / 10000) << file.filename() << " tone " << tone;
        }
        ++shown;
    }
    EXPECT_GT(shown, 35u);
}

}  // namespace
}  // namespace vesper::test
