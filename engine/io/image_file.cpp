// Pictures to files: made in memory, then put in place whole. SPDX-License-Identifier: MIT
#include "io/image_file.h"

#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <new>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <png.h>

#include "base/error.h"
#include "base/one_line.h"
#include "io/hdr_parts.h"
#include "io/new_file.h"

namespace vesper::io {
namespace {

void check_size(const std::filesystem::path& file, uint32_t width, uint32_t height, size_t channels, size_t values) {
    if (width == 0 || height == 0 || static_cast<uint64_t>(width) * height * channels != values)
        throw Error(one_line(file.string()) + ": a picture of " + std::to_string(width) + " x " +
                    std::to_string(height) + " px does not have " + std::to_string(values) + " values");
}

struct PngJob {
    std::vector<uint8_t> file;
    std::vector<uint8_t> row;
    std::vector<png_text> texts;  // of the header, whose strings they point to
    char reason[200] = "out of memory";
    std::jmp_buf escape;
};

[[noreturn]] void png_write_fail(png_structp png, png_const_charp message) {
    PngJob& job = *static_cast<PngJob*>(png_get_error_ptr(png));
    std::snprintf(job.reason, sizeof job.reason, "%s", message);
    std::longjmp(job.escape, 1);
}

void png_write_ignore(png_structp, png_const_charp) {}

void png_collect(png_structp png, png_bytep bytes, size_t count) {
    PngJob& job = *static_cast<PngJob*>(png_get_io_ptr(png));
    // No exception may pass through libpng, and no jump out of a handler.
    bool fits = true;
    try {
        job.file.insert(job.file.end(), bytes, bytes + count);
    } catch (const std::bad_alloc&) {
        fits = false;
    }
    if (!fits) png_error(png, "out of memory");
}

void png_flush_nothing(png_structp) {}

std::vector<png_text> png_texts_of(const Header& header) {
    std::vector<png_text> texts;
    for (const auto& [name, value] : header) {
        png_text text{};
        text.compression = PNG_TEXT_COMPRESSION_NONE;
        text.key = const_cast<char*>(name.c_str()), text.text = const_cast<char*>(value.c_str());  // libpng copies both
        text.text_length = value.size();
        texts.push_back(text);
    }
    return texts;
}

/// Puts row `y` into job.row.
using FillRow = void (*)(PngJob& job, uint32_t width, const void* pixels, uint32_t y);

void fill_8bit(PngJob& job, uint32_t width, const void* pixels, uint32_t y) {
    const uint8_t* in = static_cast<const uint8_t*>(pixels) + static_cast<size_t>(y) * width * 4;
    for (size_t x = 0; x < width; ++x) std::memcpy(&job.row[3 * x], in + 4 * x, 3);
}

void fill_10bit(PngJob& job, uint32_t width, const void* pixels, uint32_t y) {
    const uint32_t* in = static_cast<const uint32_t*>(pixels) + static_cast<size_t>(y) * width;
    for (size_t i = 0; i < size_t{3} * width; ++i) {
        const uint32_t code = in[i / 3] >> 10 * (i % 3) & 0x3ff, wide = code << 6 | code >> 4;
        job.row[2 * i] = static_cast<uint8_t>(wide >> 8);
        job.row[2 * i + 1] = static_cast<uint8_t>(wide);
    }
}

bool encode_png(PngJob& job, uint32_t width, uint32_t height, const void* pixels, bool wide, PngColour colour) {
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &job, png_write_fail, png_write_ignore);
    png_infop header = png ? png_create_info_struct(png) : nullptr;
    if (!header || setjmp(job.escape)) {
        png_destroy_write_struct(&png, &header);
        return false;
    }
    png_set_write_fn(png, &job, png_collect, png_flush_nothing);
    png_set_IHDR(png, header, width, height, wide ? 16 : 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (wide) {
        const png_color_8 bits{10, 10, 10, 0, 0};
        png_set_sBIT(png, header, &bits);
    }
    if (colour == kPngSrgb) png_set_sRGB(png, header, PNG_sRGB_INTENT_PERCEPTUAL);
    if (!job.texts.empty()) png_set_text(png, header, job.texts.data(), static_cast<int>(job.texts.size()));
    png_set_compression_level(png, 3);  // a frame of a video is written in a third of the time, at 10 % more bytes
    png_write_info(png, header);
    if (colour != kPngSrgb &&
        colour.transfer != PngColour().transfer) {  // matrix (0: RGB) and full range; libpng 1.6 has no name for it
        const png_byte name[] = "cICP", values[] = {colour.primaries, colour.transfer, 0, 1};
        png_write_chunk(png, name, values, sizeof values);
    }
    const FillRow fill = wide ? fill_10bit : fill_8bit;
    for (uint32_t y = 0; y < height; ++y) {
        fill(job, width, pixels, y);
        png_write_row(png, job.row.data());
    }
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &header);
    return true;
}

/// OpenEXR's own file stream does not notice a disk that fills up while it closes.
class MemoryStream : public Imf::OStream {
public:
    explicit MemoryStream(const std::string& name) : OStream(name.c_str()) {}
    void write(const char bytes[], int count) override {
        const size_t end = position_ + static_cast<size_t>(count);
        if (end > bytes_.size()) bytes_.resize(end);
        std::memcpy(bytes_.data() + position_, bytes, static_cast<size_t>(count));
        position_ = end;
    }
    uint64_t tellp() override { return position_; }
    void seekp(uint64_t position) override { position_ = position; }
    std::span<const uint8_t> bytes() const { return bytes_; }

private:
    std::vector<uint8_t> bytes_;
    uint64_t position_ = 0;
};

}  // namespace

void write_png(const std::filesystem::path& file, uint32_t width, uint32_t height, std::span<const uint8_t> rgba,
               PngColour colour, const Header& texts) {
    check_size(file, width, height, 4, rgba.size());
    PngJob job;
    job.texts = png_texts_of(texts);
    job.row.resize(static_cast<size_t>(width) * 3);
    if (!encode_png(job, width, height, rgba.data(), false, colour))
        throw Error(one_line(file.string()) + ": PNG: " + job.reason);
    replace_file(file, job.file);
}

void write_png_10bit(const std::filesystem::path& file, uint32_t width, uint32_t height,
                     std::span<const uint32_t> words, PngColour colour, const Header& texts) {
    check_size(file, width, height, 1, words.size());
    PngJob job;
    job.texts = png_texts_of(texts);
    job.row.resize(static_cast<size_t>(width) * 6);
    if (!encode_png(job, width, height, words.data(), true, colour))
        throw Error(one_line(file.string()) + ": PNG: " + job.reason);
    replace_file(file, job.file);
}

namespace hdr {

void encode_exr(const std::filesystem::path& file, const ExrPicture& picture, const Header& header) {
    MemoryStream stream(file.string());
    try {
        Imf::Header exr(static_cast<int>(picture.width), static_cast<int>(picture.height));
        exr.compression() = Imf::ZIP_COMPRESSION;
        Imf::addChromaticities(exr, Imf::Chromaticities());  // Rec. 709
        if (picture.white_luminance > 0) Imf::addWhiteLuminance(exr, static_cast<float>(picture.white_luminance));
        for (const auto& [name, text] : header) exr.insert(name, Imf::StringAttribute(text));
        Imf::FrameBuffer pixels;
        for (const ExrPixels& layer : picture.layers)
            for (size_t c = 0; c < 3; ++c) {
                const std::string name = layer.layer + (layer.layer.empty() ? "" : ".") + "RGB"[c];
                exr.channels().insert(name, Imf::Channel(Imf::FLOAT));
                // The slice is only read from, but OpenEXR has one type for both directions.
                char* base = reinterpret_cast<char*>(const_cast<float*>(layer.values + c));
                const size_t step = layer.stride * sizeof(float);
                pixels.insert(name, Imf::Slice(Imf::FLOAT, base, step, step * picture.width));
            }
        Imf::OutputFile out(stream, exr);
        out.setFrameBuffer(pixels);
        out.writePixels(static_cast<int>(picture.height));
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        throw Error(one_line(file.string() + ": OpenEXR: " + error.what()));
    }
    replace_file(file, stream.bytes());
}

}  // namespace hdr

void write_exr(const std::filesystem::path& file, uint32_t width, uint32_t height, std::span<const float> rgba,
               const Header& header) {
    check_size(file, width, height, 4, rgba.size());
    hdr::encode_exr(file, {width, height, {{rgba.data(), 4, {}}}, 1.0}, header);
}

void write_exr(const std::filesystem::path& file, const HdrImage& image) {
    check_size(file, image.width, image.height, 3, image.rgb.size());
    hdr::encode_exr(file, {image.width, image.height, {{image.rgb.data(), 3, {}}}, image.white_luminance},
                    image.header);
}

void write_exr_layers(const std::filesystem::path& file, uint32_t width, uint32_t height,
                      std::span<const ExrLayerPixels> layers, const Header& header) {
    hdr::ExrPicture picture{width, height, {}, 0};
    for (const ExrLayerPixels& layer : layers) {
        check_size(file, width, height, 3, layer.rgb.size());
        picture.layers.push_back({layer.rgb.data(), 3, layer.name});
    }
    hdr::encode_exr(file, picture, header);
}

}  // namespace vesper::io
