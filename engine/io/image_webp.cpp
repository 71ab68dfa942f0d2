// WebP with libwebp, where that was there at the build. SPDX-License-Identifier: MIT
#include "io/image_webp.h"

#include <string>

#include "base/budget.h"
#include "base/error.h"
#include "io/image_file.h"

#ifdef VESPER_WEBP
#include <webp/decode.h>
#endif

namespace vesper::io {

const char* over_limit(uint64_t width, uint64_t height, uint32_t max_side, uint64_t max_texels) {
    if (width > max_side || height > max_side) return "is larger than the limit for one side";
    if (width * height > max_texels)
        return "takes the images over the limit of texels (VESPER_LIMITS=2 allows twice as many)";
    return nullptr;
}

#ifdef VESPER_WEBP

bool reads_webp() { return true; }

Image decode_webp(std::span<const uint8_t> bytes, uint32_t max_side, uint64_t max_texels) {
    WebPBitstreamFeatures header{};
    if (WebPGetFeatures(bytes.data(), bytes.size(), &header) != VP8_STATUS_OK || header.width <= 0 ||
        header.height <= 0)
        throw Error("WebP: is damaged or cut off");
    if (header.has_animation) throw Error("WebP: is animated, which is not read");
    const auto width = static_cast<uint32_t>(header.width), height = static_cast<uint32_t>(header.height);
    if (const char* why = over_limit(width, height, max_side, max_texels))
        throw OverLimit("WebP: picture of " + std::to_string(width) + " x " + std::to_string(height) + " px " + why);
    // Some bytes may hold any number of equal texels. The library keeps a second picture while it works.
    const uint64_t size = uint64_t{width} * height * 4;
    spend(size);
    const TemporaryMemory kept(size);
    Image image;
    image.width = width, image.height = height, image.rgba.resize(size);
    if (!WebPDecodeRGBAInto(bytes.data(), bytes.size(), image.rgba.data(), image.rgba.size(), header.width * 4))
        throw Error("WebP: is damaged or cut off");
    return image;
}

#else

bool reads_webp() { return false; }

Image decode_webp(std::span<const uint8_t>, uint32_t, uint64_t) {
    throw Error("is image/webp: Vesper was built without libwebp");
}

#endif

}  // namespace vesper::io
