// Pictures: out and in again, every kind, and damaged ones. SPDX-License-Identifier: MIT
#include "io/image_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfInputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <png.h>

#include "io/jpeg_files.h"
#include "io/png_files.h"
#include "io/read_file.h"
#include "support/complaints.h"
#include "support/temp_folder.h"

namespace vesper::test {
namespace {

using io::decode_image;

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
    const auto stated = [&](io::PngColour colour) {
        chunks(colour);
        return io::stated_colour(io::read_file(folder / "x.png", 1u << 20));
    };
    EXPECT_EQ(stated({9, 16}), std::optional(io::PngColour{9, 16}));
    EXPECT_EQ(stated(io::kPngSrgb), std::nullopt);
    std::vector<uint8_t> file = io::read_file(folder / "x.png", 1u << 20);
    for (; !file.empty(); file.pop_back()) EXPECT_EQ(io::stated_colour(file), std::nullopt) << file.size();
    chunks({9, 16}), file = io::read_file(folder / "x.png", 1u << 20);
    std::fill(file.begin() + 8, file.begin() + 12, uint8_t{255});
    EXPECT_EQ(io::stated_colour(file), std::nullopt) << "longer than the file";
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

using WideCodes = std::vector<uint16_t>;

// Codes of fewer bits are stretched to 16, and those of 16 are kept.
TEST(ImageFile, ReadsPngWithAllItsBits) {
    const auto wide = [](const std::vector<uint8_t>& file) { return io::decode_wide_png(file, 9).rgba; };
    EXPECT_EQ(wide(png_of(2, 1, 16, PNG_COLOR_TYPE_GRAY, {0x12, 0x34, 0xff, 0xfe})),
              (WideCodes{0x1234, 0x1234, 0x1234, 65535, 65534, 65534, 65534, 65535}));
    EXPECT_EQ(wide(png_of(1, 1, 16, PNG_COLOR_TYPE_RGB_ALPHA, {1, 2, 3, 4, 5, 6, 7, 8})),
              (WideCodes{0x102, 0x304, 0x506, 0x708}));
    EXPECT_EQ(wide(png_of(1, 1, 8, PNG_COLOR_TYPE_RGB, {1, 128, 255})), (WideCodes{257, 128 * 257, 65535, 65535}));
    EXPECT_EQ(wide(png_of(2, 1, 1, PNG_COLOR_TYPE_GRAY, {0x40})),
              (WideCodes{0, 0, 0, 65535, 65535, 65535, 65535, 65535}));
    EXPECT_EQ(wide(png_of(2, 1, 1, PNG_COLOR_TYPE_PALETTE, {0x40})),
              (WideCodes{10 * 257, 20 * 257, 30 * 257, 65535, 200 * 257, 100 * 257, 50 * 257, 77 * 257}));
    Codes rows;
    for (int i = 0; i < 9 * 9 * 2; ++i) rows.push_back(uint8_t(i * 7));
    EXPECT_EQ(wide(png_of(9, 9, 16, PNG_COLOR_TYPE_GRAY, rows, true)),
              wide(png_of(9, 9, 16, PNG_COLOR_TYPE_GRAY, rows)));
    const Codes square = png_of(3, 3, 8, PNG_COLOR_TYPE_GRAY, Codes(9));
    EXPECT_TRUE(contains(complaint_of([&] { io::decode_wide_png(square, 2); }), "PNG: "));
    EXPECT_TRUE(contains(complaint_of([&] { io::decode_wide_png(square, 3, 8); }), "over the limit of texels"));
    EXPECT_EQ(io::decode_wide_png(square, 3, 9).rgba.size(), 36u);
    EXPECT_TRUE(contains(complaint_of([&] { wide({0xff, 0xd8, 0xff, 0xe0}); }), "is no PNG"));
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
