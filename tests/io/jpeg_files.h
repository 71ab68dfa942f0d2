// JPEG files, with and without Exif data. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <jpeglib.h>

namespace vesper::test {

/// Tags of a time and of an aperture, with their types: 5 is a ratio, 10 one with a sign.
struct ExifTags {
    uint32_t time = 0x829a, time_type = 5;  ///< ExposureTime; ShutterSpeedValue is 0x9201, 10
    uint32_t f = 0x829d, f_type = 5;        ///< FNumber; ApertureValue is 0x9202, 5
};

/// The payload of an APP1 marker: a TIFF structure of ExposureTime, FNumber and ISOSpeedRatings (Exif 2.32, 4.6), or of
/// other tags in place of the first two.
inline std::vector<uint8_t> exif_of(uint32_t seconds_over, uint32_t seconds_under, uint32_t f_over, uint32_t f_under,
                                    uint16_t iso, bool big_endian = false, const ExifTags& tags = {}) {
    std::vector<uint8_t> bytes;
    const auto put = [&](uint32_t value, int size) {
        for (int i = 0; i < size; ++i)
            bytes.push_back(static_cast<uint8_t>(value >> 8 * (big_endian ? size - 1 - i : i)));
    };
    const auto entry = [&](uint32_t tag, uint32_t type, uint32_t value, int size) {
        put(tag, 2), put(type, 2), put(1, 4), put(value, size), put(0, 4 - size);
    };
    put(big_endian ? 0x4d4d : 0x4949, 2), put(42, 2), put(8, 4);
    put(1, 2), entry(0x8769, 4, 26, 4), put(0, 4);  // IFD0 at 8: where the Exif IFD is
    put(3, 2), entry(tags.time, tags.time_type, 68, 4), entry(tags.f, tags.f_type, 76, 4), entry(0x8827, 3, iso, 2),
        put(0, 4);                                                                 // at 26
    put(seconds_over, 4), put(seconds_under, 4), put(f_over, 4), put(f_under, 4);  // at 68 and 76
    const std::string start("Exif\0\0", 6);
    bytes.insert(bytes.begin(), start.begin(), start.end());
    return bytes;
}

/// Rows of codes as a JPEG of best quality, with an APP1 marker if there is a payload for one. `halved`: chroma has
/// half the resolution. `scans`: of a progressive one of grey, the first `scans` - 1 frequencies one by one.
inline std::vector<uint8_t> jpeg_of(uint32_t width, uint32_t height, int components, J_COLOR_SPACE space,
                                    const std::vector<uint8_t>& rows, const std::vector<uint8_t>& app1 = {},
                                    bool halved = true, int scans = 0) {
    jpeg_error_mgr errors;
    jpeg_compress_struct jpeg{};
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    unsigned char* memory = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&jpeg, &memory, &size);
    jpeg.image_width = width;
    jpeg.image_height = height;
    jpeg.input_components = components;
    jpeg.in_color_space = space;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, 100, TRUE);
    if (!halved) jpeg.comp_info[0].h_samp_factor = jpeg.comp_info[0].v_samp_factor = 1;
    std::vector<jpeg_scan_info> script(
        size_t(scans), {.comps_in_scan = 1, .component_index = {0}, .Ss = 0, .Se = 0, .Ah = 0, .Al = 0});
    for (int i = 0; i < scans; ++i) script[size_t(i)].Ss = script[size_t(i)].Se = i;
    if (scans) jpeg.scan_info = script.data(), jpeg.num_scans = scans;
    jpeg_start_compress(&jpeg, TRUE);
    if (!app1.empty()) jpeg_write_marker(&jpeg, JPEG_APP0 + 1, app1.data(), static_cast<unsigned>(app1.size()));
    while (jpeg.next_scanline < height) {
        JSAMPROW row =
            const_cast<JSAMPROW>(rows.data()) + size_t{jpeg.next_scanline} * width * static_cast<size_t>(components);
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    std::vector<uint8_t> file(memory, memory + size);
    free(memory);
    return file;
}

/// RGBA codes as a photograph.
inline std::vector<uint8_t> jpeg_with(uint32_t width, uint32_t height, const std::vector<uint8_t>& rgba,
                                      const std::vector<uint8_t>& app1 = {}) {
    std::vector<uint8_t> rgb;
    for (size_t i = 0; i < rgba.size(); ++i)
        if (i % 4 != 3) rgb.push_back(rgba[i]);
    return jpeg_of(width, height, 3, JCS_RGB, rgb, app1, false);
}

}  // namespace vesper::test
