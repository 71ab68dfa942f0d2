// Making small PNG files of any kind. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <png.h>

namespace vesper::test {

/// Encodes rows of 8 or 16 bit samples as PNG.
inline std::vector<uint8_t> png_of(uint32_t width, uint32_t height, int depth, int type,
                                   const std::vector<uint8_t>& rows, bool interlaced = false, double gamma = 0) {
    std::vector<uint8_t> file;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop header = png_create_info_struct(png);
    png_set_write_fn(
        png, &file,
        [](png_structp p, png_bytep bytes, size_t count) {
            auto& out = *static_cast<std::vector<uint8_t>*>(png_get_io_ptr(p));
            out.insert(out.end(), bytes, bytes + count);
        },
        nullptr);
    png_set_IHDR(png, header, width, height, depth, type, interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, 0, 0);
    const png_color palette[2] = {{10, 20, 30}, {200, 100, 50}};
    const png_byte alpha[2] = {255, 77};
    if (type == PNG_COLOR_TYPE_PALETTE) {
        png_set_PLTE(png, header, palette, 2);
        png_set_tRNS(png, header, alpha, 2, nullptr);
    }
    if (gamma > 0) png_set_gAMA(png, header, gamma);
    std::vector<png_bytep> pointers;
    for (uint32_t y = 0; y < height; ++y)
        pointers.push_back(const_cast<png_bytep>(rows.data()) + y * (rows.size() / height));
    png_set_rows(png, header, pointers.data());
    png_write_png(png, header, PNG_TRANSFORM_IDENTITY, nullptr);
    png_destroy_write_struct(&png, &header);
    return file;
}

}  // namespace vesper::test
