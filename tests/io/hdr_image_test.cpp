// HDR pictures of every kind, read back; what is not read; damaged files. SPDX-License-Identifier: MIT
#include "io/hdr_image.h"

#include <array>
#include <cmath>
#include <limits>

#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfFloatVectorAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIntAttribute.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <ImfPreviewImage.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <ImfTiledOutputFile.h>

#include "io/atomic_file.h"
#include "scene/scene_files.h"
#include "support/exr_files.h"

namespace vesper::test {
namespace {

namespace fs = std::filesystem;
using Values = std::vector<float>;

/// A picture with some structure over four decades; whole numbers, which every pixel type holds.
Values ramp(int width, int height) {
    Values rgb;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c)
                rgb.push_back(static_cast<float>(std::lround(std::pow(10.0, 4.0 * x / width)) % 1900 / (1 + c) + y));
    return rgb;
}

/// Frame buffer over interleaved values of one type, its first pixel at the data window's corner.
template <typename T>
Imf::FrameBuffer frame_of(std::vector<T>& values, Imf::PixelType type, const Imath::Box2i& window,
                          const std::vector<std::string>& names) {
    Imf::FrameBuffer frame;
    const auto step = static_cast<std::ptrdiff_t>(names.size() * sizeof(T)),
               row = step * (window.max.x - window.min.x + 1);
    for (size_t c = 0; c < names.size(); ++c)
        frame.insert(
            names[c],
            Imf::Slice(type, reinterpret_cast<char*>(values.data() + c) - step * window.min.x - row * window.min.y,
                       static_cast<size_t>(step), static_cast<size_t>(row)));
    return frame;
}

void write(const fs::path& file, Imf::Header header, std::vector<float> values,
           const std::vector<std::string>& names = {"R", "G", "B"}, Imf::PixelType type = Imf::FLOAT) {
    for (const std::string& name : names) header.channels().insert(name, Imf::Channel(type));
    const Imath::Box2i window = header.dataWindow();
    std::vector<half> halves(values.begin(), values.end());
    std::vector<uint32_t> integers;
    for (const float v : values) integers.push_back(v >= 0 && v < 1e9f ? static_cast<uint32_t>(v) : 0);
    const Imf::FrameBuffer frame = type == Imf::FLOAT  ? frame_of(values, type, window, names)
                                   : type == Imf::HALF ? frame_of(halves, type, window, names)
                                                       : frame_of(integers, type, window, names);
    if (!header.hasTileDescription()) {
        Imf::OutputFile out(file.c_str(), header);
        out.setFrameBuffer(frame);
        out.writePixels(window.max.y - window.min.y + 1);
        return;
    }
    Imf::TiledOutputFile out(file.c_str(), header);
    out.setFrameBuffer(frame);
    for (int level = 0; level < out.numLevels(); ++level)
        out.writeTiles(0, out.numXTiles(level) - 1, 0, out.numYTiles(level) - 1, level);
}

void expect_values(const HdrImage& image, const Values& wanted, double relative = 0) {
    ASSERT_EQ(image.rgb.size(), wanted.size());
    ASSERT_EQ(image.rgb.size(), size_t{3} * image.width * image.height);
    for (size_t i = 0; i < wanted.size(); ++i)
        ASSERT_NEAR(image.rgb[i], wanted[i], relative * (std::abs(static_cast<double>(wanted[i])) + 1)) << i;
}

std::string refusal(const fs::path& file, const HdrLimits& limits = {}, const std::string& layer = {}) {
    try {
        read_hdr_image(file, limits, layer);
    } catch (const Error& error) {
        EXPECT_TRUE(contains(error.what(), file.filename().string())) << error.what();
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        return error.what();
    }
    return {};
}

TEST(HdrExr, ReadsEveryCompressionAndType) {
    const TempFolder folder;
    const Values picture = ramp(97, 70);
    for (int compression = 0; compression < Imf::NUM_COMPRESSION_METHODS; ++compression)
        for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT, Imf::UINT}) {
            Imf::Header header(97, 70);
            header.compression() = static_cast<Imf::Compression>(compression);
            write(folder / "x.exr", header, picture, {"R", "G", "B"}, type);
            const bool lossy = compression >= Imf::B44_COMPRESSION;
            expect_values(read_exr(folder / "x.exr"), picture,
                          lossy                                                         ? 0.15
                          : type == Imf::FLOAT && compression == Imf::PXR24_COMPRESSION ? 1e-4
                                                                                        : 0);
        }
}

TEST(HdrExr, ReadsTilesAndTheLargestLevelOnly) {
    const TempFolder folder;
    const Values picture = ramp(97, 70);
    for (const Imf::LevelMode mode : {Imf::ONE_LEVEL, Imf::MIPMAP_LEVELS}) {
        Imf::Header header(97, 70);
        header.setTileDescription({16, 24, mode});
        write(folder / "x.exr", header, picture, {"R", "G", "B"});
        expect_values(read_exr(folder / "x.exr"), picture);
    }
}

TEST(HdrExr, KeepsWhatFloatsCanHold) {
    const TempFolder folder;
    const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    write(folder / "x.exr", Imf::Header(2, 1), {1e-30f, 1e8f, -3, inf, nan, 0});
    const Values rgb = read_hdr_image(folder / "x.exr").rgb;
    EXPECT_EQ(rgb[0], 1e-30f);
    EXPECT_EQ(rgb[1], 1e8f);
    EXPECT_EQ(rgb[2], -3);
    EXPECT_EQ(rgb[3], inf);
    EXPECT_TRUE(std::isnan(rgb[4]));
}

TEST(HdrExr, ReadsGreyMissingChannelsAndChroma) {
    const TempFolder folder;
    write(folder / "y.exr", Imf::Header(2, 1), {5, 7}, {"Y"});
    expect_values(read_exr(folder / "y.exr"), {5, 5, 5, 7, 7, 7});
    write(folder / "gz.exr", Imf::Header(2, 1), {5, 100, 7, 200}, {"G", "Z"});
    expect_values(read_exr(folder / "gz.exr"), {0, 5, 0, 0, 7, 0});
    write(folder / "z.exr", Imf::Header(2, 1), {5, 7}, {"Z\xff\n"});
    EXPECT_TRUE(contains(refusal(folder / "z.exr"), "it has Z??"));

    std::vector<Imf::Rgba> colours;
    Values wanted;
    for (int i = 0; i < 64 * 64; ++i) {
        colours.emplace_back(3.0f, 2.0f, 0.5f);
        wanted.insert(wanted.end(), {3.0f, 2.0f, 0.5f});
    }
    {
        Imf::RgbaOutputFile out((folder / "yc.exr").c_str(), 64, 64, Imf::WRITE_YC);
        out.setFrameBuffer(colours.data(), 1, 64);
        out.writePixels(64);
    }
    expect_values(read_exr(folder / "yc.exr"), wanted, 0.005);
}

TEST(HdrExr, ReadsLayersByName) {
    const TempFolder folder;
    write(folder / "one.exr", Imf::Header(1, 1), {5, 9, 7, 8}, {"key.Z", "key.light.R", "key.light.G", "key.light.B"});
    expect_values(read_exr(folder / "one.exr"), {9, 7, 8});
    expect_values(read_hdr_image(folder / "one.exr", {}, "key.light"), {9, 7, 8});
    EXPECT_TRUE(contains(refusal(folder / "one.exr", {}, "key"), "no layer key; it has key.light"));

    write(folder / "two.exr", Imf::Header(1, 1), {5, 9}, {"left.Y", "right.Y"});
    EXPECT_TRUE(contains(refusal(folder / "two.exr"), "choose one of left, right"));
    expect_values(read_exr(folder / "two.exr", {}, "right"), {9, 9, 9});

    write(folder / "main.exr", Imf::Header(1, 1), {1, 2, 3, 9}, {"R", "G", "B", "left.Y"});
    expect_values(read_exr(folder / "main.exr"), {1, 2, 3});
    expect_values(read_exr(folder / "main.exr", {}, "left"), {9, 9, 9});
    folder.write("x.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\nabcd");
    EXPECT_TRUE(contains(refusal(folder / "x.hdr", {}, "left"), "no layers"));

    const HdrImage image{1, 1, {4, 5, 6}};
    write_layout(folder / "parts.exr", image, {.multi_part = true});
    expect_values(read_exr(folder / "parts.exr"), {4, 5, 6});
    expect_values(read_exr(folder / "parts.exr", {}, "second"), {7, 7, 7});
}

/// Luminance of every pixel and chroma of every `step`-th, as floats.
void write_yc(const fs::path& file, Imf::Header header, std::vector<float> y, std::vector<float> ry, std::vector<float> by, int step) {
    const Imath::Box2i w = header.dataWindow();
    const int width = w.max.x - w.min.x + 1, height = w.max.y - w.min.y + 1;
    Imf::FrameBuffer frame;
    const auto add = [&](const char* name, std::vector<float>& values, int s) {
        header.channels().insert(name, Imf::Channel(Imf::FLOAT, s, s));
        const auto row = std::ptrdiff_t(sizeof(float)) * (width / s);
        frame.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()) - std::ptrdiff_t(sizeof(float)) * (w.min.x / s) - row * (w.min.y / s), sizeof(float), size_t(row), s, s));
    };
    add("Y", y, 1), add("RY", ry, step), add("BY", by, step);
    Imf::OutputFile out(file.c_str(), header);
    out.setFrameBuffer(frame);
    out.writePixels(height);
}

// Chroma that is the same everywhere has nothing between its pixels: R = (RY + 1) Y, B = (BY + 1) Y, and the luminance is that of
// the file, to the last bits of a float. Halves would lose 5e-4.
TEST(HdrExr, ChromaKeepsTheWholeLuminance) {
    const TempFolder folder;
    for (const int step : {1, 2}) {
        const int width = 150, height = 140;
        std::vector<float> y;
        for (int i = 0; i < width * height; ++i) y.push_back(1e5f + float(i) * 0.25f);
        const std::vector<float> ry(y.size() / size_t(step * step), 0.25f), by(ry.size(), -0.5f);
        Imf::Header header(Imath::Box2i{{0, 0}, {width - 1, height - 1}}, Imath::Box2i{{-2, 4}, {width - 3, height + 3}});
        write_yc(folder / "yc.exr", header, y, ry, by, step);
        const HdrImage image = read_exr(folder / "yc.exr");
        for (int v = 0; v < height; ++v)
            for (int u = 0; u < width; ++u) {
                const float* rgb = image.rgb.data() + 3 * (v * width + u);
                const bool inside = u < width - 2 && v >= 4;
                const double Y = inside ? double(y[size_t((v - 4) * width + u + 2)]) : 0;
                ASSERT_NEAR(rgb[0], 1.25 * Y, 3e-6 * Y) << u << ", " << v;  // the filter's weights have six digits
                ASSERT_NEAR(rgb[2], 0.5 * Y, 3e-6 * Y);
                ASSERT_NEAR(0.212639 * double(rgb[0]) + 0.715169 * double(rgb[1]) + 0.072192 * double(rgb[2]), Y, 3e-6 * Y);  // weights have six digits
            }
    }
    const std::vector<float> y(64, 1.0f), few(4, 0.0f);
    write_yc(folder / "yc.exr", Imf::Header(8, 8), y, few, few, 4);
    EXPECT_TRUE(contains(refusal(folder / "yc.exr"), "one in 4 x 4"));
}

// Between its pixels chroma is what OpenEXR's own reader makes of it, in halves.
TEST(HdrExr, ChromaIsFilteredAsByOpenExr) {
    const TempFolder folder;
    const int width = 96, height = 80;
    std::vector<float> y, ry, by;
    for (int v = 0; v < height; ++v)
        for (int u = 0; u < width; ++u) {
            y.push_back(float(1 + 0.5 * std::sin(u * 0.7) + 0.3 * std::cos(v * 0.9)));
            if (u % 2 || v % 2) continue;
            ry.push_back(float(0.3 * std::sin(u * 0.35 + v * 0.1)));
            by.push_back(float(0.2 * std::cos(v * 0.4 - u * 0.05)));
        }
    write_yc(folder / "yc.exr", Imf::Header(width, height), y, ry, by, 2);
    const HdrImage image = read_exr(folder / "yc.exr");
    std::vector<Imf::Rgba> wanted(size_t(width * height));
    Imf::RgbaInputFile own((folder / "yc.exr").c_str());
    own.setFrameBuffer(wanted.data(), 1, width);
    own.readPixels(0, height - 1);
    for (size_t i = 0; i < wanted.size(); ++i) {
        ASSERT_NEAR(image.rgb[3 * i], wanted[i].r, 2e-3) << i % width << ", " << i / width;
        ASSERT_NEAR(image.rgb[3 * i + 1], wanted[i].g, 2e-3);
        ASSERT_NEAR(image.rgb[3 * i + 2], wanted[i].b, 2e-3);
    }
}

TEST(HdrExr, CoversTheDisplayWindow) {
    const TempFolder folder;
    const auto read = [&](Imath::Box2i display, Imath::Box2i data, const Values& values) {
        Imf::Header header(display, data);
        write(folder / "x.exr", header, values, {"Y"});
        const HdrImage image = read_exr(folder / "x.exr");
        Values grey;
        for (size_t i = 0; i < image.rgb.size(); i += 3) grey.push_back(image.rgb[i]);
        return grey;
    };
    const auto box = [](int x0, int y0, int x1, int y1) { return Imath::Box2i({x0, y0}, {x1, y1}); };
    EXPECT_EQ(read(box(0, 0, 2, 1), box(1, 1, 3, 2), {1, 2, 3, 4, 5, 6}), (Values{0, 0, 0, 0, 1, 2}));
    EXPECT_EQ(read(box(-5, -5, -4, -4), box(-6, -5, -4, -4), {1, 2, 3, 4, 5, 6}), (Values{2, 3, 5, 6}));
    EXPECT_EQ(read(box(0, 0, 1, 0), box(10, 10, 11, 10), {1, 2}), (Values{0, 0}));
}

TEST(HdrExr, ConvertsPrimariesToRec709) {
    const TempFolder folder;
    Imf::Header xyz(2, 1);
    Imf::addChromaticities(xyz, {{1, 0}, {0, 1}, {0, 0}, {1.0f / 3, 1.0f / 3}});
    // The white of Rec. 709 and its red primary, in X, Y, Z (IEC 61966-2-1).
    write(folder / "x.exr", xyz, {0.950456f, 1.0f, 1.089058f, 0.412391f, 0.212639f, 0.019331f});
    expect_values(read_exr(folder / "x.exr"), {1, 1, 1, 1, 0, 0}, 3e-4);
    Imf::Header wide(1, 1);
    Imf::addChromaticities(wide, {{0.708f, 0.292f}, {0.170f, 0.797f}, {0.131f, 0.046f}, {0.3127f, 0.3290f}});
    write(folder / "x.exr", wide, {1, 0, 0});
    expect_values(read_exr(folder / "x.exr"), {1.6605f, -0.1246f, -0.0182f}, 2e-4);  // ITU-R BT.2087
    Imf::Header flat(1, 1);
    Imf::addChromaticities(flat, {{0.3f, 0.3f}, {0.3f, 0.3f}, {0.1f, 0.1f}, {0.3f, 0.3f}});
    write(folder / "x.exr", flat, {1, 0, 0});
    EXPECT_TRUE(contains(refusal(folder / "x.exr"), "primaries"));
}

TEST(HdrExr, ReadsOurOwnWithHeaderAndUnit) {
    const TempFolder folder;
    const Values rgba = {1e-4f, 1, 1e8f, 1, 65504, 70000, 0, 1};
    write_exr(folder / "x.exr", 2, 1, rgba, {{"vesper:camera", "driver"}});
    const HdrImage image = read_hdr_image(folder / "x.exr");
    expect_values(image, {1e-4f, 1, 1e8f, 65504, 70000, 0});
    EXPECT_EQ(image.white_luminance, 1.0);
    EXPECT_NE(std::find(image.header.begin(), image.header.end(),
                        std::pair<std::string, std::string>("vesper:camera", "driver")),
              image.header.end());
    write(folder / "y.exr", Imf::Header(1, 1), {1, 1, 1});
    EXPECT_EQ(read_hdr_image(folder / "y.exr").white_luminance, 0.0);
}

TEST(HdrExr, RefusesDeepPicturesOtherFilesAndLargeOnes) {
    const TempFolder folder;
    {
        Imf::Header header(1, 1);
        header.channels().insert("R", Imf::Channel(Imf::FLOAT));
        header.setType(Imf::DEEPSCANLINE);
        header.compression() = Imf::ZIPS_COMPRESSION;
        Imf::DeepScanLineOutputFile out((folder / "deep.exr").c_str(), header);
        unsigned count = 1;
        float value = 3, *pointer = &value;
        Imf::DeepFrameBuffer frame;
        frame.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(&count), 4, 4));
        frame.insert("R",
                     Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(&pointer), sizeof pointer, sizeof pointer, 4));
        out.setFrameBuffer(frame);
        out.writePixels(1);
    }
    EXPECT_TRUE(contains(refusal(folder / "deep.exr"), "deep"));
    folder.write("x.txt", "hello");
    EXPECT_TRUE(contains(refusal(folder / "x.txt"), "neither OpenEXR nor Radiance"));
    EXPECT_NE(refusal(folder / "missing.exr"), "");
    write(folder / "x.exr", Imf::Header(20, 10), ramp(20, 10));
    EXPECT_EQ(refusal(folder / "x.exr", {20, 200}), "");
    EXPECT_TRUE(contains(refusal(folder / "x.exr", {19, 200}), "limit for one side"));
    EXPECT_TRUE(contains(refusal(folder / "x.exr", {20, 199}), "more pixels"));
    EXPECT_THROW(read_radiance(folder / "x.exr"), Error);
}

// OpenEXR reads a value by its type and goes on after that, wherever the file says that it ends: what it then takes for the next one's size
// may be gigabytes.
TEST(HdrExr, ValuesInHeadersAreAsLongAsTheirTypes) {
    const TempFolder folder;
    Imf::Header header(9, 5);
    header.insert("of one", Imf::IntAttribute(1));
    header.insert("of more", Imf::M44fAttribute(Imath::M44f()));
    header.insert("of texts", Imf::StringVectorAttribute({"a", "", "bcd"}));
    header.insert("of floats", Imf::FloatVectorAttribute({1, 2, 3}));
    header.insert("of a text", Imf::StringAttribute("as long as it says"));
    const Imf::PreviewRgba pixels[6];
    header.setPreviewImage(Imf::PreviewImage(3, 2, pixels));
    write(folder / "x.exr", header, ramp(9, 5));
    EXPECT_EQ(refusal(folder / "x.exr"), "");
    const std::vector<uint8_t> whole = read_file(folder / "x.exr", 1 << 20);
    for (const std::string type : {"int", "m44f", "stringvector", "floatvector", "preview", "chlist", "compression", "box2i", "v2f", "float", "lineOrder"}) {
        const std::string mark = '\0' + type + '\0';
        const auto found = std::find_end(whole.begin(), whole.end(), mark.begin(), mark.end());
        ASSERT_NE(found, whole.end()) << type;
        std::vector<uint8_t> longer = whole;
        const size_t at = size_t(found - whole.begin()) + mark.size(), size = longer[at] + 256 * longer[at + 1];
        ++longer[at];
        longer.insert(longer.begin() + std::ptrdiff_t(at + 4 + size), 0);
        replace_file(folder / "longer.exr", longer);
        EXPECT_TRUE(contains(refusal(folder / "longer.exr"), "has not the size of a " + type)) << type;
    }
}

/// Every shorter file, and every file with one byte changed, gives a picture or an Error.
void expect_survives(const TempFolder& folder, const fs::path& good, bool every_cut_is_seen) {
    const std::vector<uint8_t> whole = read_file(good, 1 << 24);
    const auto attempt = [&](std::span<const uint8_t> bytes) {
        replace_file(folder / "damaged", bytes);
        try {
            read_hdr_image(folder / "damaged", {4096, 1 << 20});
        } catch (const Error&) {
            return false;
        }
        return true;
    };
    ASSERT_TRUE(attempt(whole));
    const size_t step = 1 + whole.size() / 200;
    for (size_t size = 0; size < whole.size(); size += step) {
        const bool read = attempt(std::span(whole).first(size));
        EXPECT_FALSE(read && every_cut_is_seen) << good << " cut at " << size;
    }
    for (size_t i = 4; i < whole.size(); i += i < 400 ? 1 : step)
        for (const int change : {0x80, 0xff}) {
            std::vector<uint8_t> changed = whole;
            changed[i] ^= static_cast<uint8_t>(change);
            attempt(changed);
        }
}

TEST(HdrExr, SurvivesCutAndChangedFiles) {
    const TempFolder folder;
    for (int compression = 0; compression < Imf::NUM_COMPRESSION_METHODS; ++compression) {
        Imf::Header header(24, 40);
        header.compression() = static_cast<Imf::Compression>(compression);
        write(folder / "x.exr", header, ramp(24, 40), {"R", "G", "B"}, Imf::HALF);
        expect_survives(folder, folder / "x.exr", false);
    }
    Imf::Header tiles(24, 24);
    tiles.setTileDescription({16, 16, Imf::MIPMAP_LEVELS});
    write(folder / "x.exr", tiles, ramp(24, 24));
    expect_survives(folder, folder / "x.exr", false);
    write(folder / "x.exr", Imf::Header(9, 5), ramp(9, 5), {"a.R", "a.G", "a.B"});
    expect_survives(folder, folder / "x.exr", false);
    const std::vector<float> y(32 * 40, 3.0f), c(y.size() / 4, 0.5f);
    for (const auto compression : {Imf::NO_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::B44_COMPRESSION}) {
        Imf::Header header(32, 40);
        header.compression() = compression;
        write_yc(folder / "x.exr", header, y, c, c, 2);
        expect_survives(folder, folder / "x.exr", false);
    }
}

const std::string kRgbe = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n";

/// The value of a mantissa with an exponent byte.
float rgbe(int mantissa, int exponent) {
    return static_cast<float>((mantissa + 0.5) * std::ldexp(1.0, exponent - 136));
}

HdrImage radiance(const std::string& header, const std::string& pixels) {
    const TempFolder folder;
    folder.write("x.hdr", header + pixels);
    return read_hdr_image(folder / "x.hdr");
}

TEST(HdrRadiance, ReadsPlainPixelsAndBothKindsOfRuns) {
    const std::string plain("\x80\x40\x20\x81\xff\xff\xff\x00", 8);
    expect_values(radiance(kRgbe, "\n-Y 2 +X 1\n" + plain), {rgbe(128, 129), rgbe(64, 129), rgbe(32, 129), 0, 0, 0});
    // The older runs: a pixel, repeated twice; and 1 + 2 + 256 times.
    const Values grey3 = radiance(kRgbe, "\n-Y 1 +X 3\n" + std::string("\x80\x80\x80\x81\x01\x01\x01\x02", 8)).rgb;
    EXPECT_EQ(grey3, Values(9, rgbe(128, 129)));
    const Values grey259 =
        radiance(kRgbe, "\n-Y 1 +X 259\n" + std::string("\x80\x80\x80\x81\x01\x01\x01\x02\x01\x01\x01\x01", 12)).rgb;
    EXPECT_EQ(grey259, Values(3 * 259, rgbe(128, 129)));
    // The newer runs, component by component: eight times 200; 1 ... 8; 4 of 9 then 4 of 10; exponent 130.
    const std::string row(
        "\x02\x02\x00\x08"
        "\x88\xc8"
        "\x08\x01\x02\x03\x04\x05\x06\x07\x08"
        "\x84\x09\x84\x0a"
        "\x88\x82",
        4 + 2 + 9 + 4 + 2);
    Values wanted;
    for (int x = 0; x < 8; ++x)
        wanted.insert(wanted.end(), {rgbe(200, 130), rgbe(x + 1, 130), rgbe(x < 4 ? 9 : 10, 130)});
    expect_values(radiance("#?RGBE\n", "\n-Y 1 +X 8\n" + row), wanted);
}

// The six pixels of a picture 3 wide and 2 high, its rows 1 2 3 and 4 5 6, in the order of every resolution line.
TEST(HdrRadiance, ReadsEveryOrderOfPixels) {
    const std::pair<const char*, std::array<int, 6>> orders[]{
        {"-Y 2 +X 3", {1, 2, 3, 4, 5, 6}}, {"-Y 2 -X 3", {3, 2, 1, 6, 5, 4}}, {"+Y 2 +X 3", {4, 5, 6, 1, 2, 3}}, {"+Y 2 -X 3", {6, 5, 4, 3, 2, 1}},
        {"+X 3 -Y 2", {1, 4, 2, 5, 3, 6}}, {"+X 3 +Y 2", {4, 1, 5, 2, 6, 3}}, {"-X 3 -Y 2", {3, 6, 2, 5, 1, 4}}, {"-X 3 +Y 2", {6, 3, 5, 2, 4, 1}}};
    for (const auto& [line, order] : orders) {
        std::string pixels;
        for (const int value : order) pixels += std::string(3, char(10 * value)) + char(130);
        const HdrImage image = radiance(kRgbe, std::string("\n") + line + "\n" + pixels);
        EXPECT_EQ(image.width, 3u) << line;
        Values wanted;
        for (int value = 1; value <= 6; ++value) wanted.insert(wanted.end(), 3, rgbe(10 * value, 130));
        EXPECT_EQ(image.rgb, wanted) << line;
    }
}

TEST(HdrRadiance, UndoesExposureAndPrimaries) {
    const std::string one("\n-Y 1 +X 1\n\x80\x40\x20\x81", 15);
    const HdrImage exposed = radiance(kRgbe + "EXPOSURE=4\nVIEW= -vtv\nEXPOSURE= 0.5 \n", one);
    expect_values(exposed, {rgbe(128, 128), rgbe(64, 128), rgbe(32, 128)});
    EXPECT_EQ(exposed.header.size(), 4u);
    EXPECT_EQ(exposed.white_luminance, 0.0);
    const Values plain = {rgbe(128, 129), rgbe(64, 129), rgbe(32, 129)};
    expect_values(radiance(kRgbe + "PRIMARIES=0 0 0 0 0 0 0 0\n", one), plain);
    expect_values(radiance(kRgbe + "PRIMARIES=.64 .33 .3 .6 .15 .06 .3127 .3290\n", one), plain);
    expect_values(radiance(kRgbe + "PRIMARIES=.64 .33 .15 .06 .3 .6 .3127 .3290\n", one),
                  {plain[0], plain[2], plain[1]}, 1e-6);
    // XYZ of a colour: x = X 3.2405 - Y 1.5371 - Z 0.4985 and so on (IEC 61966-2-1)
    const double X = static_cast<double>(plain[0]), Y = static_cast<double>(plain[1]),
                 Z = static_cast<double>(plain[2]);
    expect_values(radiance("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n", one),
                  {static_cast<float>(3.2405 * X - 1.5371 * Y - 0.4985 * Z),
                   static_cast<float>(-0.9693 * X + 1.8760 * Y + 0.0416 * Z),
                   static_cast<float>(0.0556 * X - 0.2040 * Y + 1.0572 * Z)},
                  1e-3);
}

TEST(HdrRadiance, RefusesWithAReason) {
    const auto reason = [](const std::string& text) {
        const TempFolder folder;
        folder.write("x.hdr", text);
        return refusal(folder / "x.hdr", {1000, 1000000});
    };
    EXPECT_TRUE(contains(reason(kRgbe + "\n+Y 1 +Y 1\nabcd"), "-Y HEIGHT +X WIDTH"));
    EXPECT_TRUE(contains(reason(kRgbe + "\n*X 1 -Y 1\nabcd"), "-Y HEIGHT +X WIDTH"));
    EXPECT_TRUE(contains(reason(kRgbe + "\n-Y 1 +X 1 x\nabcd"), "-Y HEIGHT +X WIDTH"));
    EXPECT_TRUE(contains(reason(kRgbe + "\n-Y 0 +X 1\nabcd"), "no pixels"));
    EXPECT_TRUE(contains(reason(kRgbe + "\n-Y 999999 +X 999999\nabcd"), "limit for one side"));
    EXPECT_TRUE(contains(reason(kRgbe + "\n-Y 999 +X 999\nabcd"), "cut off"));
    EXPECT_TRUE(contains(reason(kRgbe + "EXPOSURE=0\n\n-Y 1 +X 1\nabcd"), "EXPOSURE"));
    EXPECT_TRUE(contains(reason(kRgbe + "PRIMARIES=1 2 3\n\n-Y 1 +X 1\nabcd"), "PRIMARIES"));
    EXPECT_TRUE(contains(reason(kRgbe + "PRIMARIES=.1 .1 .1 .1 .1 .1 .1 .1\n\n-Y 1 +X 1\nabcd"), "primaries"));
    EXPECT_TRUE(contains(reason("#?RADIANCE\nFORMAT=other\n\n-Y 1 +X 1\nabcd"), "FORMAT"));
    EXPECT_TRUE(
        contains(reason(kRgbe + "\n-Y 1 +X 8\n" + std::string("\x02\x02\x00\x09\x88\xc8", 6)), "a row of 9 px"));
    EXPECT_TRUE(contains(reason(kRgbe + "\n-Y 1 +X 8\n" + std::string("\x02\x02\x00\x08\x89\xc8", 6)), "run"));
    EXPECT_TRUE(contains(reason(kRgbe + "\n-Y 1 +X 1\n" + std::string("\x01\x01\x01\x01", 4)), "run"));
}

TEST(HdrRadiance, SurvivesCutAndChangedFiles) {
    const TempFolder folder;
    std::string pixels;
    for (int y = 0; y < 5; ++y)
        pixels += std::string(
            "\x02\x02\x00\x08"
            "\x88\xc8"
            "\x08\x01\x02\x03\x04\x05\x06\x07\x08"
            "\x84\x09\x84\x0a"
            "\x88\x82",
            21);
    folder.write("x.hdr", kRgbe + "EXPOSURE=2\nPRIMARIES=.64 .33 .3 .6 .15 .06 .3127 .3290\n\n-Y 5 +X 8\n" + pixels);
    expect_survives(folder, folder / "x.hdr", true);
}

}  // namespace
}  // namespace vesper::test
