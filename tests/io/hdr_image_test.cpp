// OpenEXR pictures of every kind, read back; what is not read; damaged files. SPDX-License-Identifier: MIT
#include "io/hdr_image.h"

#include <algorithm>
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

#include "io/new_file.h"
#include "io/read_file.h"
#include "support/complaints.h"
#include "support/exr_files.h"
#include "support/hdr_files.h"
#include "support/temp_folder.h"

namespace vesper::test {
namespace {

using io::read_exr;
namespace fs = std::filesystem;

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
    const Values rgb = io::read_hdr_image(folder / "x.exr").rgb;
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

// As programs that do not follow the standard's capitals name them.
TEST(HdrExr, ReadsOtherNamesOfColours) {
    const TempFolder folder;
    const auto read = [&](const std::vector<std::string>& names, Values values, const std::string& layer = {}) {
        write(folder / "x.exr", Imf::Header(1, 1), std::move(values), names);
        return read_exr(folder / "x.exr", {}, layer);
    };
    expect_values(read({"r", "g", "b", "a"}, {4, 3, 2, 1}), {4, 3, 2});
    expect_values(read({"red", "green", "blue"}, {4, 3, 2}), {4, 3, 2});
    expect_values(read({"Red", "GREEN", "bLUE", "Alpha"}, {4, 3, 2, 1}), {4, 3, 2});
    expect_values(read({"R", "green", "b"}, {4, 3, 2}), {4, 3, 2});
    expect_values(read({"R", "G", "B", "r", "g", "b"}, {4, 3, 2, 9, 9, 9}), {4, 3, 2});
    expect_values(read({"R", "red", "green"}, {4, 9, 3}), {4, 3, 0});
    for (const char* name : {"y", "luminance", "Luminance", "LUMINANCE"})
        expect_values(read({name, "a"}, {4, 1}), {4, 4, 4});
    expect_values(read({"x", "z", "luminance"}, {8, 9, 4}), {4, 4, 4});
    expect_values(read({"Y", "y", "luminance"}, {4, 8, 9}), {4, 4, 4});
    expect_values(read({"y", "ry", "by"}, {4, 0.5f, -0.5f}), {6, (4 - 6 * 0.2126f - 2 * 0.0722f) / 0.7152f, 2}, 1e-3);

    const std::vector<std::string> layers{"depth.Z", "key.fill.red", "key.fill.green", "key.fill.blue"};
    expect_values(read(layers, {8, 4, 3, 2}), {4, 3, 2});
    expect_values(read(layers, {8, 4, 3, 2}, "key.fill"), {4, 3, 2});
    expect_values(read({"r", "g", "b", "key.luminance"}, {4, 3, 2, 7}, "key"), {7, 7, 7});
    expect_values(read({"r", "g", "b", "key.luminance"}, {4, 3, 2, 7}), {4, 3, 2});
    expect_values(read({"key.r", "key.g", "key.b", "fill.y"}, {4, 3, 2, 7}, "fill"), {7, 7, 7});
    EXPECT_TRUE(contains(refusal(folder / "x.exr"), "choose one of fill, key"));
}

// Normals, speeds, places and colours of other kinds.
TEST(HdrExr, TakesNoVectorForAColourByItsLetters) {
    const TempFolder folder;
    for (const std::vector<std::string>& names : {std::vector<std::string>{"x", "y", "z"},
                                                  {"speed.x", "speed.y"},
                                                  {"a", "b", "l"},
                                                  {"r", "g"},
                                                  {"N.y", "N.z"}}) {
        write(folder / "x.exr", Imf::Header(1, 1), {1, 2, 3}, names);
        EXPECT_TRUE(contains(refusal(folder / "x.exr"), "no channels R, G, B or Y of a picture")) << names.front();
    }
}

TEST(HdrExr, ReadsLayersByName) {
    const TempFolder folder;
    write(folder / "one.exr", Imf::Header(1, 1), {5, 9, 7, 8}, {"key.Z", "key.light.R", "key.light.G", "key.light.B"});
    expect_values(read_exr(folder / "one.exr"), {9, 7, 8});
    expect_values(io::read_hdr_image(folder / "one.exr", {}, "key.light"), {9, 7, 8});
    EXPECT_TRUE(contains(refusal(folder / "one.exr", {}, "key"), "no layer key; it has key.light"));

    write(folder / "two.exr", Imf::Header(1, 1), {5, 9}, {"left.Y", "right.Y"});
    EXPECT_TRUE(contains(refusal(folder / "two.exr"), "choose one of left, right"));
    expect_values(read_exr(folder / "two.exr", {}, "right"), {9, 9, 9});

    write(folder / "main.exr", Imf::Header(1, 1), {1, 2, 3, 9}, {"R", "G", "B", "left.Y"});
    expect_values(read_exr(folder / "main.exr"), {1, 2, 3});
    expect_values(read_exr(folder / "main.exr", {}, "left"), {9, 9, 9});
    folder.write("x.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\nabcd");
    EXPECT_TRUE(contains(refusal(folder / "x.hdr", {}, "left"), "no layers"));

    const io::HdrImage image{1, 1, {4, 5, 6}};
    write_layout(folder / "parts.exr", image, {.multi_part = true});
    expect_values(read_exr(folder / "parts.exr"), {4, 5, 6});
    expect_values(read_exr(folder / "parts.exr", {}, "second"), {7, 7, 7});
}

/// Luminance of every pixel and chroma of every `step`-th, as floats.
void write_yc(const fs::path& file, Imf::Header header, std::vector<float> y, std::vector<float> ry,
              std::vector<float> by, int step) {
    const Imath::Box2i w = header.dataWindow();
    const int width = w.max.x - w.min.x + 1, height = w.max.y - w.min.y + 1;
    Imf::FrameBuffer frame;
    const auto add = [&](const char* name, std::vector<float>& values, int s) {
        header.channels().insert(name, Imf::Channel(Imf::FLOAT, s, s));
        const auto row = std::ptrdiff_t(sizeof(float)) * (width / s);
        frame.insert(name, Imf::Slice(Imf::FLOAT,
                                      reinterpret_cast<char*>(values.data()) -
                                          std::ptrdiff_t(sizeof(float)) * (w.min.x / s) - row * (w.min.y / s),
                                      sizeof(float), size_t(row), s, s));
    };
    add("Y", y, 1), add("RY", ry, step), add("BY", by, step);
    Imf::OutputFile out(file.c_str(), header);
    out.setFrameBuffer(frame);
    out.writePixels(height);
}

// Chroma that is the same everywhere has nothing between its pixels: R = (RY + 1) Y, B = (BY + 1) Y, and the luminance
// is that of the file, to the last bits of a float. Halves would lose 5e-4.
TEST(HdrExr, ChromaKeepsTheWholeLuminance) {
    const TempFolder folder;
    for (const int step : {1, 2}) {
        const int width = 150, height = 140;
        std::vector<float> y;
        for (int i = 0; i < width * height; ++i) y.push_back(1e5f + float(i) * 0.25f);
        const std::vector<float> ry(y.size() / size_t(step * step), 0.25f), by(ry.size(), -0.5f);
        Imf::Header header(Imath::Box2i{{0, 0}, {width - 1, height - 1}},
                           Imath::Box2i{{-2, 4}, {width - 3, height + 3}});
        write_yc(folder / "yc.exr", header, y, ry, by, step);
        const io::HdrImage image = read_exr(folder / "yc.exr");
        for (int v = 0; v < height; ++v)
            for (int u = 0; u < width; ++u) {
                const float* rgb = image.rgb.data() + 3 * (v * width + u);
                const bool inside = u < width - 2 && v >= 4;
                const double Y = inside ? double(y[size_t((v - 4) * width + u + 2)]) : 0;
                ASSERT_NEAR(rgb[0], 1.25 * Y, 3e-6 * Y) << u << ", " << v;  // the filter's weights have six digits
                ASSERT_NEAR(rgb[2], 0.5 * Y, 3e-6 * Y);
                ASSERT_NEAR(0.212639 * double(rgb[0]) + 0.715169 * double(rgb[1]) + 0.072192 * double(rgb[2]), Y,
                            3e-6 * Y);  // weights have six digits
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
    const io::HdrImage image = read_exr(folder / "yc.exr");
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
        const io::HdrImage image = read_exr(folder / "x.exr");
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

// X, Y and Z in no layer are colours, in a layer or a named part normals or places: no picture.
TEST(HdrExr, TellsTristimulusValuesFromVectors) {
    const TempFolder folder;
    write(folder / "xyz.exr", Imf::Header(2, 1), {0.950456f, 1.0f, 1.089058f, 0.412391f, 0.212639f, 0.019331f},
          {"X", "Y", "Z"});
    expect_values(read_exr(folder / "xyz.exr"), {1, 1, 1, 1, 0, 0}, 3e-4);
    write(folder / "render.exr", Imf::Header(1, 1), {1, 2, 3, 9, 9, 9},
          {"View.Combined.R", "View.Combined.G", "View.Combined.B", "View.Normal.X", "View.Normal.Y", "View.Normal.Z"});
    expect_values(read_exr(folder / "render.exr"), {1, 2, 3});
    expect_values(read_exr(folder / "render.exr", {}, "View.Normal"), {9 * 1.2048f, 9 * 0.9483f, 9 * 0.9088f},
                  1e-3);  // who asks for it has CIE values
    write(folder / "normal.exr", Imf::Header(1, 1), {9, 9, 9}, {"N.X", "N.Y", "N.Z"});
    EXPECT_TRUE(
        contains(refusal(folder / "normal.exr"), "no channels R, G, B or Y of a picture; it has N.X, N.Y, N.Z"));
}

TEST(HdrExr, ReadsOurOwnLayers) {
    const TempFolder folder;
    const Values whole = {1, 2, 3, 4, 5, 6}, lamps = {-1, 0, 1e-4f, 70000, 8, 9};
    io::write_exr_layers(folder / "x.exr", 2, 1, std::vector<io::ExrLayerPixels>{{"", whole}, {"lamps", lamps}},
                         {{"vesper:unit", "lx"}});
    expect_values(io::read_exr(folder / "x.exr"), whole);
    const io::HdrImage layer = io::read_exr(folder / "x.exr", {}, "lamps");
    expect_values(layer, lamps);
    EXPECT_EQ(layer.white_luminance, 0.0);
    EXPECT_NE(std::ranges::find(layer.header, std::pair<std::string, std::string>("vesper:unit", "lx")),
              layer.header.end());
    EXPECT_THROW(io::write_exr_layers(folder / "y.exr", 2, 2, std::vector<io::ExrLayerPixels>{{"lamps", lamps}}, {}),
                 Error);
}

TEST(HdrExr, ReadsOurOwnWithHeaderAndUnit) {
    const TempFolder folder;
    const Values rgba = {1e-4f, 1, 1e8f, 1, 65504, 70000, 0, 1};
    io::write_exr(folder / "x.exr", 2, 1, rgba, {{"vesper:camera", "driver"}});
    const io::HdrImage image = io::read_hdr_image(folder / "x.exr");
    expect_values(image, {1e-4f, 1, 1e8f, 65504, 70000, 0});
    EXPECT_EQ(image.white_luminance, 1.0);
    EXPECT_NE(std::find(image.header.begin(), image.header.end(),
                        std::pair<std::string, std::string>("vesper:camera", "driver")),
              image.header.end());
    write(folder / "y.exr", Imf::Header(1, 1), {1, 1, 1});
    EXPECT_EQ(io::read_hdr_image(folder / "y.exr").white_luminance, 0.0);
    for (const float white :
         {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN(), -5.0f, 1e20f, 0.0f, 80.0f}) {
        Imf::Header header(1, 1);
        Imf::addWhiteLuminance(header, white);
        write(folder / "z.exr", header, {1, 1, 1});
        if (white >= 0 && white < 100)
            EXPECT_EQ(io::read_hdr_image(folder / "z.exr").white_luminance, double(white));
        else
            EXPECT_TRUE(contains(refusal(folder / "z.exr"), "z.exr: OpenEXR: whiteLuminance")) << white;
    }
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
    EXPECT_THROW(io::read_radiance(folder / "x.exr"), Error);
}

// OpenEXR 3.1 would take what a new picture has: 64 x 64 pixels.
TEST(HdrExr, WhatAHeaderMustHaveIsThere) {
    const TempFolder folder;
    write(folder / "x.exr", Imf::Header(9, 5), ramp(9, 5));
    const std::vector<uint8_t> whole = io::read_file(folder / "x.exr", 1 << 20);
    for (const std::string name : {"channels", "compression", "dataWindow", "displayWindow"}) {
        std::vector<uint8_t> other = whole;
        const std::string mark = name + '\0';
        const auto found = std::search(other.begin(), other.end(), mark.begin(), mark.end());
        ASSERT_NE(found, other.end()) << name;
        *found = 'x';
        io::replace_file(folder / "other.exr", other);
        EXPECT_TRUE(contains(refusal(folder / "other.exr"), "its header has no '" + name + "'")) << name;
    }
}

TEST(HdrExr, FewDataFillNoHugePicture) {
    const TempFolder folder;
    Imf::Header header(32768, 8001);
    header.dataWindow() = {{0, 0}, {3, 2}};
    write(folder / "x.exr", header, ramp(4, 3));
    EXPECT_TRUE(contains(refusal(folder / "x.exr"), "its data cover 4 x 3 pixels"));
}

// OpenEXR reads a value by its type and goes on after that, wherever the file says that it ends: what it then takes for
// the next one's size may be gigabytes.
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
    const std::vector<uint8_t> whole = io::read_file(folder / "x.exr", 1 << 20);
    for (const std::string type : {"int", "m44f", "stringvector", "floatvector", "preview", "chlist", "compression",
                                   "box2i", "v2f", "float", "lineOrder"}) {
        const std::string mark = '\0' + type + '\0';
        const auto found = std::find_end(whole.begin(), whole.end(), mark.begin(), mark.end());
        ASSERT_NE(found, whole.end()) << type;
        std::vector<uint8_t> longer = whole;
        const size_t at = size_t(found - whole.begin()) + mark.size(), size = longer[at] + 256 * longer[at + 1];
        ++longer[at];
        longer.insert(longer.begin() + std::ptrdiff_t(at + 4 + size), 0);
        io::replace_file(folder / "longer.exr", longer);
        EXPECT_TRUE(contains(refusal(folder / "longer.exr"), "has not the size of a " + type)) << type;
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
    for (const auto compression :
         {Imf::NO_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::B44_COMPRESSION}) {
        Imf::Header header(32, 40);
        header.compression() = compression;
        write_yc(folder / "x.exr", header, y, c, c, 2);
        expect_survives(folder, folder / "x.exr", false);
    }
}

}  // namespace
}  // namespace vesper::test
