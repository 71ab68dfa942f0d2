// One picture as OpenEXR in every layout. SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <ImfTiledOutputFile.h>

#include "io/hdr_image.h"

namespace vesper::test {

struct ExrLayout {
    Imf::Compression compression = Imf::ZIP_COMPRESSION;
    bool tiles = false, mipmap = false, multi_part = false, grey = false;
    int x0 = 0, y0 = 0;  ///< of the data window; the display window stays where it is
    double white_luminance = 0;
};

/// Writes a picture with 32-bit floats.
inline void write_layout(const std::filesystem::path& file, const io::HdrImage& image, const ExrLayout& layout) {
    const int w = int(image.width), h = int(image.height);
    Imf::Header header(w, h);
    header.compression() = layout.compression;
    header.dataWindow() = {{layout.x0, layout.y0}, {layout.x0 + w - 1, layout.y0 + h - 1}};
    if (layout.white_luminance > 0) Imf::addWhiteLuminance(header, float(layout.white_luminance));
    Imf::FrameBuffer pixels;
    const char* names[] = {layout.grey ? "Y" : "R", "G", "B"};
    std::vector<float> values = image.rgb;
    const ptrdiff_t step = 3 * sizeof(float);
    for (int c = 0; c < (layout.grey ? 1 : 3); ++c) {
        header.channels().insert(names[c], Imf::Channel(Imf::FLOAT));
        char* base = reinterpret_cast<char*>(values.data() + c) - step * (layout.x0 + ptrdiff_t(layout.y0) * w);
        pixels.insert(names[c], Imf::Slice(Imf::FLOAT, base, size_t(step), size_t(step * w)));
    }
    if (layout.multi_part) {
        header.setName("first"), header.setType(Imf::SCANLINEIMAGE);
        Imf::Header second = header;
        second.setName("second");
        const Imf::Header headers[] = {header, second};
        Imf::MultiPartOutputFile out(file.c_str(), headers, 2);
        for (const int part : {0, 1}) {
            if (part == 1) std::fill(values.begin(), values.end(), 7.0f);  // not to be shown
            Imf::OutputPart output(out, part);
            output.setFrameBuffer(pixels);
            output.writePixels(h);
        }
    } else if (layout.tiles) {
        header.setTileDescription({32, 16, layout.mipmap ? Imf::MIPMAP_LEVELS : Imf::ONE_LEVEL});
        Imf::TiledOutputFile out(file.c_str(), header);
        out.setFrameBuffer(pixels);
        for (int level = 0; level < out.numLevels(); ++level)
            out.writeTiles(0, out.numXTiles(level) - 1, 0, out.numYTiles(level) - 1, level);
    } else {
        Imf::OutputFile out(file.c_str(), header);
        out.setFrameBuffer(pixels);
        out.writePixels(h);
    }
}

/// Writes luminance and chroma of half the resolution, in halves.
inline void write_chroma(const std::filesystem::path& file, const io::HdrImage& image) {
    std::vector<Imf::Rgba> pixels;
    for (size_t i = 0; i < image.rgb.size(); i += 3)
        pixels.emplace_back(image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]);
    Imf::RgbaOutputFile out(file.c_str(), int(image.width), int(image.height), Imf::WRITE_YC);
    out.setFrameBuffer(pixels.data(), 1, image.width);
    out.writePixels(int(image.height));
}

}  // namespace vesper::test
