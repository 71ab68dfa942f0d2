// SPDX-License-Identifier: MIT
#include "vision/blend_mask.h"

#include "base/error.h"
#include "io/image_file.h"
#include "io/in_file.h"
#include "io/read_file.h"

namespace vesper::vision {
namespace {

constexpr uint16_t kFullCode = 65535;

BlendMask mask_of(const io::WideImage& image) {
    BlendMask mask{{}, image.width, image.height, std::vector<float>(size_t{image.width} * image.height)};
    for (size_t i = 0; i < mask.factors.size(); ++i) {
        const uint16_t* rgba = &image.rgba[4 * i];
        const auto fail = [&](const char* reason) {
            throw Error("pixel " + std::to_string(i % image.width) + ", " + std::to_string(i / image.width) + " " +
                        reason);
        };
        if (rgba[0] != rgba[1] || rgba[0] != rgba[2]) fail("has a colour: a blend mask is grey");
        if (rgba[3] != kFullCode) fail("can be seen through: the factor of a blend mask is its grey");
        mask.factors[i] = float(rgba[0]) / float(kFullCode);
    }
    return mask;
}

}  // namespace

BlendMask read_blend_mask(const std::filesystem::path& file) {
    const std::vector<uint8_t> bytes = io::read_file(file, kMaxBlendMaskBytes);
    BlendMask mask = io::in_file(
        file.string(), [&] { return mask_of(io::decode_wide_png(bytes, kMaxBlendMaskSide, kMaxBlendMaskPixels)); });
    mask.name = file.string();
    return mask;
}

}  // namespace vesper::vision
