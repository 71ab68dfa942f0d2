// Pictures: out and in again, every kind, and damaged ones. SPDX-License-Identifier: MIT
#include "io/image_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfInputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <png.h>

#include "io/jpeg_files.h"
#include "io/read_file.h"
#include "scene/scene_files.h"

namespace vesper::test {
namespace {

using io::decode_image;

/// Encodes rows of 8 or 16 bit samples as PNG.
std::vector<uint8_t> png_of(uint32_t width, uint32_t height, int depth, int type, const std::vector<uint8_t>& rows,
                            bool interlaced = false, double gamma = 0) {
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

using Codes = std::vector<uint8_t>;

TEST(ImageFile, WritesPngThatReadsBack) {
    const TempFolder folder;
    Codes rgba;
    for (int i = 0; i < 7 * 5; ++i)
        rgba.insert(rgba.end(),
                    {static_cast<uint8_t>(i * 7), static_cast<uint8_t>(255 - i), static_cast<uint8_t>(i), 255});
    io::write_png(folder / "x.png", 7, 5, rgba);
    const Image image = decode_image(io::read_file(folder / "x.png", 1 << 20), 100);
    EXPECT_EQ(image.width, 7u);
    EXPECT_EQ(image.height, 5u);
    EXPECT_EQ(image.rgba, rgba);
    EXPECT_THROW(io::write_png(folder / "x.png", 7, 6, rgba), Error);
    EXPECT_THROW(io::write_png(folder / "no/x.png", 7, 5, rgba), Error);
}

// Chunks of 8 bits: sRGB unless said otherwise.
TEST(ImageFile, SaysWhatTheCodesMean) {
    const TempFolder folder;
    const auto chunks = [&](io::PngColour colour) {
        io::write_png(folder / "x.png", 1, 1, std::vector<uint8_t>(4, 200), colour);
        const std::vector<uint8_t> file = io::read_file(folder / "x.png", 1u << 20);
        return std::string(file.begin(), file.end());
    };
    EXPECT_TRUE(contains(chunks(io::kPngSrgb), "sRGB"));
    EXPECT_FALSE(contains(chunks(io::kPngSrgb), "cICP"));
    EXPECT_TRUE(contains(chunks({9, 16}), std::string("cICP\x09\x10\x00\x01", 8)));
    EXPECT_TRUE(contains(chunks({12, 13}), std::string("cICP\x0c\x0d\x00\x01", 8)));
    EXPECT_FALSE(contains(chunks({12, 13}), "sRGB"));
    EXPECT_FALSE(contains(chunks({}), "sRGB"));
    EXPECT_FALSE(contains(chunks({}), "cICP"));
}

TEST(ImageFile, KeepsTextsInPngs) {
    const TempFolder folder;
    const io::Header texts{{"vesper:sourceScale", "251.3"}, {"vesper:exposure", "0"}};
    const auto file_of = [&](const io::Header& given, bool wide) {
        if (wide)
            io::write_png_10bit(folder / "x.png", 1, 1, std::vector<uint32_t>(1, 7), {9, 16}, given);
        else
            io::write_png(folder / "x.png", 1, 1, std::vector<uint8_t>(4, 200), io::kPngSrgb, given);
        const std::vector<uint8_t> file = io::read_file(folder / "x.png", 1u << 20);
        EXPECT_EQ(decode_image(file, 100).width, 1u);
        return std::string(file.begin(), file.end());
    };
    for (const bool wide : {false, true}) {
        for (const auto& [name, value] : texts)
            EXPECT_TRUE(contains(file_of(texts, wide), "tEXt" + name + std::string(1, 0) + value)) << name << wide;
        EXPECT_FALSE(contains(file_of({}, wide), "tEXt")) << wide;
    }
}

// 10 bits become 16 with the upper ones repeated below; sBIT and, for PQ, cICP say what they are.
TEST(ImageFile, WritesPngOfTenBits) {
    const TempFolder folder;
    const std::vector<uint32_t> words{0u, 1023u | 512u << 10 | 1u << 20 | 3u << 30};
    io::write_png_10bit(folder / "x.png", 2, 1, words, {9, 16});
    const std::vector<uint8_t> file = io::read_file(folder / "x.png", 1u << 20);
    const std::string text(file.begin(), file.end());
    EXPECT_NE(text.find("sBIT\x0a\x0a\x0a"), std::string::npos);
    EXPECT_NE(text.find(std::string("cICP\x09\x10\x00\x01", 8)), std::string::npos);
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop header = png_create_info_struct(png);
    FILE* stream = std::fopen((folder / "x.png").c_str(), "rb");
    png_init_io(png, stream);
    png_read_png(png, header, PNG_TRANSFORM_IDENTITY, nullptr);
    ASSERT_EQ(png_get_bit_depth(png, header), 16);
    const png_bytep row = png_get_rows(png, header)[0];
    const auto value = [&](int i) { return row[2 * i] << 8 | row[2 * i + 1]; };
    for (int i = 0; i < 3; ++i) EXPECT_EQ(value(i), 0);
    EXPECT_EQ(value(3), 65535);
    EXPECT_EQ(value(4), 512 << 6 | 512 >> 4);
    EXPECT_EQ(value(5), 64);
    std::fclose(stream);
    png_destroy_read_struct(&png, &header, nullptr);
    io::write_png_10bit(folder / "y.png", 2, 1, words, io::PngColour());
    const std::vector<uint8_t> other = io::read_file(folder / "y.png", 1u << 20);
    for (const char* chunk : {"cICP", "sRGB"})
        EXPECT_EQ(std::string(other.begin(), other.end()).find(chunk), std::string::npos) << chunk;
    EXPECT_THROW(io::write_png_10bit(folder / "x.png", 3, 1, words, io::PngColour()), Error);
}

TEST(ImageFile, ReadsEveryKindOfPng) {
    EXPECT_EQ(decode_image(png_of(2, 1, 8, PNG_COLOR_TYPE_GRAY, {5, 250}), 9).rgba,
              (Codes{5, 5, 5, 255, 250, 250, 250, 255}));
    EXPECT_EQ(decode_image(png_of(2, 1, 1, PNG_COLOR_TYPE_GRAY, {0x40}), 9).rgba,
              (Codes{0, 0, 0, 255, 255, 255, 255, 255}));
    EXPECT_EQ(decode_image(png_of(1, 1, 8, PNG_COLOR_TYPE_GRAY_ALPHA, {9, 100}), 9).rgba, (Codes{9, 9, 9, 100}));
    EXPECT_EQ(decode_image(png_of(1, 1, 8, PNG_COLOR_TYPE_RGBA, {1, 2, 3, 4}), 9).rgba, (Codes{1, 2, 3, 4}));
    EXPECT_EQ(decode_image(png_of(2, 1, 8, PNG_COLOR_TYPE_PALETTE, {0, 1}), 9).rgba,
              (Codes{10, 20, 30, 255, 200, 100, 50, 77}));
    // 16 bit to the nearest of 8
    EXPECT_EQ(decode_image(png_of(1, 1, 16, PNG_COLOR_TYPE_RGB, {0x80, 0x80, 0x00, 0x90, 0xff, 0xff}), 9).rgba,
              (Codes{128, 1, 255, 255}));
    const Codes square = {1, 2, 3, 4, 5, 6, 7, 8, 9};
    EXPECT_EQ(decode_image(png_of(3, 3, 8, PNG_COLOR_TYPE_GRAY, square, true), 9).rgba,
              decode_image(png_of(3, 3, 8, PNG_COLOR_TYPE_GRAY, square), 9).rgba);
}

TEST(ImageFile, IgnoresGammaChunks) {
    EXPECT_EQ(decode_image(png_of(1, 1, 8, PNG_COLOR_TYPE_RGB, {50, 100, 150}, false, 1.0), 9).rgba,
              (Codes{50, 100, 150, 255}));
}

TEST(ImageFile, ReadsJpegInColourGreyAndInk) {
    const auto close = [](const Image& image, Codes wanted) {
        for (size_t c = 0; c < 4; ++c) EXPECT_NEAR(image.rgba[c], wanted[c], 3);
    };
    const auto flat = [](const Codes& pixel) {
        Codes rows;
        for (int i = 0; i < 64; ++i) rows.insert(rows.end(), pixel.begin(), pixel.end());
        return rows;
    };
    close(decode_image(jpeg_of(8, 8, 3, JCS_RGB, flat({200, 100, 50})), 9), {200, 100, 50, 255});
    close(decode_image(jpeg_of(8, 8, 1, JCS_GRAYSCALE, flat({90})), 9), {90, 90, 90, 255});
    // libjpeg marks CMYK files as Adobe's, whose inks are inverted: 255 is none.
    close(decode_image(jpeg_of(8, 8, 4, JCS_CMYK, flat({255, 128, 0, 255})), 9), {255, 128, 0, 255});
    close(decode_image(jpeg_of(8, 8, 4, JCS_CMYK, flat({255, 255, 255, 51})), 9), {51, 51, 51, 255});
}

TEST(ImageFile, RefusesWhatIsTooLarge) {
    const Codes png = png_of(4, 2, 8, PNG_COLOR_TYPE_GRAY, Codes(8));
    EXPECT_NO_THROW(decode_image(png, 4, 8));
    EXPECT_THROW(decode_image(png, 3), Error);
    EXPECT_THROW(decode_image(png, 4, 7), Error);
    // A header that declares 16384 x 16384, with hardly anything behind it: refused before memory is taken.
    Codes bomb = png_of(1, 1, 8, PNG_COLOR_TYPE_RGBA, Codes(4));
    bomb[18] = 0x40, bomb[22] = 0x40;
    EXPECT_THROW(decode_image(bomb, 16384), Error);
}

// Scans of nothing take some bytes each, and as long to read as others.
TEST(ImageFile, ScansAreBoundedByThePicturesThatMayBe) {
    const Codes grey(16 * 16, 90), jpeg = jpeg_of(16, 16, 1, JCS_GRAYSCALE, grey, {}, false, 40);
    EXPECT_EQ(decode_image(jpeg, 16).rgba.size(), 16u * 16 * 4);
    EXPECT_EQ(decode_image(jpeg, 16, 1000).rgba.size(), 16u * 16 * 4);
    try {
        decode_image(jpeg, 16, 256);
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("17 scans are too many"), std::string::npos) << error.what();
    }
}

TEST(ImageFile, SurvivesCutAndChangedFiles) {
    Codes noise(16 * 16 * 3);
    uint32_t state = 1;
    for (uint8_t& code : noise) code = static_cast<uint8_t>((state = state * 1664525u + 1013904223u) >> 24);
    for (const Codes& whole : {png_of(16, 16, 8, PNG_COLOR_TYPE_RGB, noise), jpeg_of(16, 16, 3, JCS_RGB, noise)}) {
        for (size_t size = 0; size + 2 < whole.size(); ++size)
            EXPECT_THROW(decode_image(std::span(whole).first(size), 100), Error) << size;
        for (size_t i = 0; i < whole.size(); ++i) {
            Codes changed = whole;
            changed[i] ^= 0x55;
            try {
                EXPECT_FALSE(decode_image(changed, 100).rgba.empty());
            } catch (const Error&) {
            }
        }
    }
}

TEST(ImageFile, NamesFormats) {
    const auto type = [](const std::string& text) {
        return io::media_type({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
    };
    EXPECT_EQ(type("\xff\xd8\xff\xe0"), "image/jpeg");
    EXPECT_EQ(type("RIFF1234WEBPVP8 "), "image/webp");
    EXPECT_EQ(type("\xabKTX 20\xbb"), "image/ktx2");
    EXPECT_EQ(type("hello"), "");
    EXPECT_EQ(type(""), "");
}

TEST(ImageFile, WritesExrInCandelas) {
    const TempFolder folder;
    const float values[] = {1e-4f, 1, 1e8f, 1, 65504, 70000, 0, 1};
    io::write_exr(folder / "x.exr", 2, 1, values, {{"vesper.camera", "driver"}});
    Imf::InputFile in((folder / "x.exr").c_str());
    EXPECT_EQ(Imf::whiteLuminance(in.header()), 1.0f);
    EXPECT_EQ(in.header().typedAttribute<Imf::StringAttribute>("vesper.camera").value(), "driver");
    EXPECT_EQ(in.header().compression(), Imf::ZIP_COMPRESSION);
    float read[6] = {};
    Imf::FrameBuffer pixels;
    const char* names[] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(in.header().channels()[names[c]].type, Imf::FLOAT);
        pixels.insert(names[c],
                      Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(read + c), 3 * sizeof(float), 6 * sizeof(float)));
    }
    in.setFrameBuffer(pixels);
    in.readPixels(0);
    for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(read[c], values[c]);
        EXPECT_EQ(read[3 + c], values[4 + c]);
    }
    EXPECT_THROW(io::write_exr(folder / "x.exr", 2, 2, values, {}), Error);
    EXPECT_THROW(io::write_exr("/dev/full", 2, 1, values, {}), Error);
    EXPECT_THROW(io::write_exr(folder / "y.exr", 2, 1, values, {{"channels", "no such thing"}}), Error);
}

}  // namespace
}  // namespace vesper::test
