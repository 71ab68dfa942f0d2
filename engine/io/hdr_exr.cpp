// OpenEXR, in. SPDX-License-Identifier: MIT
#include <algorithm>

#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfEnvmap.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfRgbaYca.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>

#include "base/budget.h"
#include "base/decimal.h"
#include "base/error.h"
#include "io/exr_chroma.h"
#include "io/exr_layers.h"
#include "io/exr_stream.h"
#include "io/hdr_parts.h"

namespace vesper::io::hdr {
namespace {

// OpenEXR takes memory for tables and buffers while it opens a file; this setting of the whole library is its only way
// to refuse before that. Made once, as threads may read pictures at the same time.
void limit_openexr() {
    static const bool limited = [] {
        constexpr int kMaxSide = 1 << 18;
        Imf::Header::setMaxImageSize(kMaxSide, kMaxSide);
        Imf::Header::setMaxTileSize(kMaxSide, kMaxSide);
        return true;
    }();
    static_cast<void>(limited);
}

constexpr int64_t kMostUncovered =
    int64_t{1} << 25;  // px that no data fill: a picture of 8K; files of some bytes must not ask for more

struct Window {
    int64_t x0, y0, x1, y1;  // inclusive
    explicit Window(const Imath::Box2i& box) : x0(box.min.x), y0(box.min.y), x1(box.max.x), y1(box.max.y) {}
    int64_t width() const { return x1 - x0 + 1; }
    int64_t height() const { return y1 - y0 + 1; }
};

/// cd/m^2 of white; 0, which some programs write, says nothing.
double white_luminance_of(const Imf::Header& exr) {
    const auto white = static_cast<double>(Imf::whiteLuminance(exr));
    if (!(white >= 0 && white <= 1e12)) throw Error("OpenEXR: whiteLuminance " + decimal(white) + " is no luminance");
    return white;
}

/// Where pixel (0, 0) would lie if (x, y) lies at `memory`.
char* origin(void* memory, int64_t x, int64_t y, int64_t x_stride, int64_t y_stride) {
    return reinterpret_cast<char*>(reinterpret_cast<intptr_t>(memory) - x * x_stride - y * y_stride);
}

/// Reads blocks of whole rows of the data window with `read(first, last)`, which leaves them in `block` (3 floats per
/// pixel), and copies what the display window shows. Memory for the picture is taken when the first block was good.
template <typename Read>
void read_rows(HdrImage& image, const Window& data, const Window& display, std::vector<float>& block,
               const Read& read) {
    constexpr int64_t kRows = 64;
    const int64_t x0 = std::max(data.x0, display.x0), x1 = std::min(data.x1, display.x1);
    const int64_t y0 = std::max(data.y0, display.y0), y1 = std::min(data.y1, display.y1);
    block.resize(static_cast<size_t>(data.width() * std::min(kRows, data.height()) * 3));
    const size_t values = size_t{3} * image.width * image.height;
    spend(values * sizeof(float));
    const TemporaryMemory of_block(block.size() * sizeof(float));
    for (int64_t first = y0; first <= y1 && x0 <= x1; first += kRows) {
        const int64_t last = std::min(first + kRows - 1, y1);
        check_time();
        read(static_cast<int>(first), static_cast<int>(last));
        image.rgb.resize(values);
        for (int64_t y = first; y <= last; ++y) {
            const float* from = block.data() + 3 * ((y - first) * data.width() + x0 - data.x0);
            float* to = image.rgb.data() + 3 * ((y - display.y0) * display.width() + x0 - display.x0);
            std::copy(from, from + 3 * (x1 - x0 + 1), to);
        }
    }
    image.rgb.resize(values);
}

/// R, G and B or X, Y and Z as they are, or Y three times.
void read_channels(HdrImage& image, Imf::InputPart& part, const ExrLayer& layer, const Window& data,
                   const Window& display) {
    const bool grey = layer.kind == ExrLayer::Kind::Grey;
    std::vector<float> block;
    read_rows(image, data, display, block, [&](int first, int last) {
        const int64_t x_stride = 3 * sizeof(float), y_stride = x_stride * data.width();
        Imf::FrameBuffer pixels;
        for (size_t c = 0; c < (grey ? 1 : 3); ++c)
            pixels.insert(layer.channels[c],
                          Imf::Slice(Imf::FLOAT, origin(block.data() + c, data.x0, first, x_stride, y_stride),
                                     static_cast<size_t>(x_stride), static_cast<size_t>(y_stride)));
        part.setFrameBuffer(pixels);
        part.readPixels(first, last);
        if (grey)
            for (size_t i = 0; i + 2 < block.size(); i += 3) block[i + 1] = block[i + 2] = block[i];
    });
}

/// Luminance and chroma that may be subsampled, at the precision of the file.
void read_chroma(HdrImage& image, Imf::InputPart& part, const ExrLayer& layer, const Window& data,
                 const Window& display) {
    const Imf::Header& exr = part.header();
    const Imath::V3f weights =
        Imf::RgbaYca::computeYw(Imf::hasChromaticities(exr) ? Imf::chromaticities(exr) : Imf::Chromaticities());
    const glm::dvec3 yw(weights.x, weights.y, weights.z);
    ChromaPlane planes[2];
    for (size_t c = 0; c < 2; ++c)
        if (const Imf::Channel* channel = exr.channels().findChannel(layer.channels[c + 1]))
            planes[c].step = {channel->xSampling, channel->ySampling};
    for (const ChromaPlane& plane : planes)
        if (!plane.is_sound())
            throw Error("OpenEXR: chroma of one in " + std::to_string(plane.step.x) + " x " +
                        std::to_string(plane.step.y) + " pixels; 1 and 2 are read");

    std::vector<float> luminance, block, line[2];
    read_rows(image, data, display, block, [&](int first, int last) {
        // Rows that the chroma between two rows is made of, from one that has chroma.
        const int64_t around = ChromaPlane::kReach;
        const int64_t from = data.y0 + std::max<int64_t>(first - data.y0 - around, 0) / 2 * 2,
                      to = std::min(last + around, data.y1);
        const int64_t width = data.width(), size = sizeof(float);
        luminance.resize(static_cast<size_t>(width * (to - from + 1)));
        Imf::FrameBuffer pixels;
        pixels.insert(layer.channels[0],
                      Imf::Slice(Imf::FLOAT, origin(luminance.data(), data.x0, from, size, size * width),
                                 static_cast<size_t>(size), static_cast<size_t>(size * width)));
        for (size_t c = 0; c < 2; ++c) {
            ChromaPlane& plane = planes[c];
            plane.resize(width, to - from + 1);
            const int64_t row = size * plane.width;
            pixels.insert(
                layer.channels[c + 1],
                Imf::Slice(Imf::FLOAT,
                           origin(plane.values.data(), data.x0 / plane.step.x, from / plane.step.y, size, row),
                           static_cast<size_t>(size), static_cast<size_t>(row), plane.step.x, plane.step.y, 0.0));
        }
        part.setFrameBuffer(pixels);
        part.readPixels(static_cast<int>(from), static_cast<int>(to));
        float* out = block.data();
        for (int64_t y = first; y <= last; ++y) {
            for (int c = 0; c < 2; ++c) planes[c].line(y - from, width, line[c]);
            const float* l = luminance.data() + width * (y - from);
            for (size_t x = 0; x < static_cast<size_t>(width); ++x, out += 3) {
                const double Y = static_cast<double>(l[x]), r = (static_cast<double>(line[0][x]) + 1) * Y,
                             b = (static_cast<double>(line[1][x]) + 1) * Y;
                out[0] = static_cast<float>(r);
                out[1] = static_cast<float>((Y - r * yw.x - b * yw.z) / yw.y);
                out[2] = static_cast<float>(b);
            }
        }
    });
}

Header texts_of(const Imf::Header& exr) {
    Header header;
    for (auto it = exr.begin(); it != exr.end(); ++it) {
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute())) {
            header.emplace_back(it.name(), text->value());
        } else if (const auto* number = dynamic_cast<const Imf::FloatAttribute*>(&it.attribute())) {
            header.emplace_back(it.name(), decimal(static_cast<double>(number->value()), 9));
        }
    }
    if (Imf::hasEnvmap(exr)) header.emplace_back("envmap", Imf::envmap(exr) == Imf::ENVMAP_CUBE ? "cube" : "latlong");
    return header;
}

Primaries primaries_of(const Imf::Header& exr) {
    if (!Imf::hasChromaticities(exr)) return kRec709;
    const Imf::Chromaticities& c = Imf::chromaticities(exr);
    const auto xy = [](const Imath::V2f& v) { return glm::dvec2(v.x, v.y); };
    return {xy(c.red), xy(c.green), xy(c.blue), xy(c.white)};
}

}  // namespace

HdrImage decode_exr(std::span<const uint8_t> bytes, const std::string& name, const HdrLimits& limits,
                    const std::string& wanted) {
    limit_openexr();
    see_exr_attributes(bytes, [](std::string_view, std::span<const uint8_t>) {});
    ExrStream stream(name, bytes);
    Imf::MultiPartInputFile file(stream);
    const ExrLayer layer = choose_layer(file, wanted);
    const Imf::Header& exr = file.header(layer.part);
    const Window data(exr.dataWindow()), display(exr.displayWindow());
    check_size("OpenEXR: data window", data.width(), data.height(), limits);
    check_size("OpenEXR: display window", display.width(), display.height(), limits);
    if (display.width() * display.height() - data.width() * data.height() > kMostUncovered)
        throw Error("OpenEXR: its data cover " + std::to_string(data.width()) + " x " + std::to_string(data.height()) +
                    " pixels of a picture of " + std::to_string(display.width()) + " x " +
                    std::to_string(display.height()) + "; at most " + std::to_string(kMostUncovered) +
                    " may be left black");
    if (exr.hasTileDescription())
        check_size("OpenEXR: tile", exr.tileDescription().xSize, exr.tileDescription().ySize,
                   {limits.max_side, std::min(limits.max_pixels, uint64_t{1} << 24)});

    // OpenEXR unpacks all channels of a block of lines or tiles, wanted or not.
    uint64_t channels = 0;
    for (auto channel = exr.channels().begin(); channel != exr.channels().end(); ++channel) ++channels;
    constexpr uint64_t kLinesOfABlock = 256, kCopies = 2;
    const TemporaryMemory of_blocks(channels * sizeof(float) * kCopies * static_cast<uint64_t>(data.width()) *
                                    std::min(kLinesOfABlock, static_cast<uint64_t>(data.height())));

    HdrImage image{static_cast<uint32_t>(display.width()), static_cast<uint32_t>(display.height())};
    using Kind = ExrLayer::Kind;
    const glm::dmat3 matrix = to_rec709(layer.kind == Kind::Xyz ? kXyz : primaries_of(exr));
    Imf::InputPart part(file, layer.part);
    if (layer.kind == Kind::Chroma)
        read_chroma(image, part, layer, data, display);
    else
        read_channels(image, part, layer, data, display);
    if (layer.kind != Kind::Grey) transform(image, matrix);  // a luminance alone is the same grey for all primaries
    image.header = texts_of(exr);
    if (Imf::hasWhiteLuminance(exr)) image.white_luminance = white_luminance_of(exr);
    return image;
}

}  // namespace vesper::io::hdr
