// OpenEXR, in. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>
#include <cstring>

#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfEnvmap.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>

#include "base/error.h"
#include "io/hdr_parts.h"

namespace vesper::hdr {
namespace {

class MemoryStream : public Imf::IStream {
public:
    MemoryStream(const std::string& name, std::span<const uint8_t> bytes) : IStream(name.c_str()), bytes_(bytes) {}
    bool read(char target[], int count) override {
        if (count < 0 || position_ > bytes_.size() || static_cast<size_t>(count) > bytes_.size() - position_)
            throw Error("is cut off");
        std::memcpy(target, bytes_.data() + position_, static_cast<size_t>(count));
        position_ += static_cast<uint64_t>(count);
        return position_ < bytes_.size();
    }
    uint64_t tellg() override { return position_; }
    void seekg(uint64_t position) override { position_ = position; }
    void clear() override {}

private:
    std::span<const uint8_t> bytes_;
    uint64_t position_ = 0;
};

struct Window {
    int64_t x0, y0, x1, y1;  // inclusive
    explicit Window(const Imath::Box2i& box) : x0(box.min.x), y0(box.min.y), x1(box.max.x), y1(box.max.y) {}
    int64_t width() const { return x1 - x0 + 1; }
    int64_t height() const { return y1 - y0 + 1; }
};

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
    for (int64_t first = y0; first <= y1 && x0 <= x1; first += kRows) {
        const int64_t last = std::min(first + kRows - 1, y1);
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

/// R, G and B as they are, or Y three times.
void read_channels(HdrImage& image, Imf::MultiPartInputFile& file, const Window& data, const Window& display,
                   bool grey) {
    Imf::InputPart part(file, 0);
    std::vector<float> block;
    read_rows(image, data, display, block, [&](int first, int last) {
        const int64_t x_stride = 3 * sizeof(float), y_stride = x_stride * data.width();
        Imf::FrameBuffer pixels;
        const char* names[] = {grey ? "Y" : "R", "G", "B"};
        for (int c = 0; c < (grey ? 1 : 3); ++c)
            pixels.insert(names[c], Imf::Slice(Imf::FLOAT, origin(block.data() + c, data.x0, first, x_stride, y_stride),
                                               static_cast<size_t>(x_stride), static_cast<size_t>(y_stride)));
        part.setFrameBuffer(pixels);
        part.readPixels(first, last);
        if (grey)
            for (size_t i = 0; i + 2 < block.size(); i += 3) block[i + 1] = block[i + 2] = block[i];
    });
}

/// Luminance and subsampled chroma, as OpenEXR's own reader makes colours of it.
void read_chroma(HdrImage& image, MemoryStream& stream, const Window& data, const Window& display) {
    stream.seekg(0);
    Imf::RgbaInputFile file(stream);
    std::vector<Imf::Rgba> colours;
    std::vector<float> block;
    read_rows(image, data, display, block, [&](int first, int last) {
        colours.resize(block.size() / 3);
        const int64_t width = data.width(), size = sizeof(Imf::Rgba);
        file.setFrameBuffer(reinterpret_cast<Imf::Rgba*>(origin(colours.data(), data.x0, first, size, size * width)), 1,
                            static_cast<size_t>(width));
        file.readPixels(first, last);
        for (size_t i = 0; i < colours.size(); ++i) {
            block[3 * i] = colours[i].r;
            block[3 * i + 1] = colours[i].g;
            block[3 * i + 2] = colours[i].b;
        }
    });
}

Header texts_of(const Imf::Header& exr) {
    Header header;
    for (auto it = exr.begin(); it != exr.end(); ++it) {
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute())) {
            header.emplace_back(it.name(), text->value());
        } else if (const auto* number = dynamic_cast<const Imf::FloatAttribute*>(&it.attribute())) {
            char digits[32];
            std::snprintf(digits, sizeof digits, "%.9g", static_cast<double>(number->value()));
            header.emplace_back(it.name(), digits);
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

std::string list_of(const Imf::ChannelList& channels) {
    std::string list;
    for (auto it = channels.begin(); it != channels.end(); ++it)
        list += (list.empty() ? "" : ", ") + std::string(it.name());
    return list;
}

}  // namespace

HdrImage decode_exr(std::span<const uint8_t> bytes, const std::string& name, const HdrLimits& limits) {
    // OpenEXR takes memory for tables and buffers while it opens a file; this setting of the whole library is its only
    // way to refuse before that. The same value every time.
    constexpr int kMaxSide = 1 << 18;
    Imf::Header::setMaxImageSize(kMaxSide, kMaxSide);
    Imf::Header::setMaxTileSize(kMaxSide, kMaxSide);
    MemoryStream stream(name, bytes);
    Imf::MultiPartInputFile file(stream);
    const Imf::Header& exr = file.header(0);
    if (exr.hasType() && Imf::isDeepData(exr.type())) throw Error("OpenEXR: deep pictures are not read");
    const Window data(exr.dataWindow()), display(exr.displayWindow());
    check_size("OpenEXR: data window", data.width(), data.height(), limits);
    check_size("OpenEXR: display window", display.width(), display.height(), limits);
    if (exr.hasTileDescription())
        check_size("OpenEXR: tile", exr.tileDescription().xSize, exr.tileDescription().ySize,
                   {limits.max_side, std::min(limits.max_pixels, uint64_t{1} << 24)});

    HdrImage image{static_cast<uint32_t>(display.width()), static_cast<uint32_t>(display.height())};
    const Imf::ChannelList& channels = exr.channels();
    const bool colour = channels.findChannel("R") || channels.findChannel("G") || channels.findChannel("B");
    const bool grey = channels.findChannel("Y"), chroma = channels.findChannel("RY") || channels.findChannel("BY");
    const glm::dmat3 matrix = to_rec709(primaries_of(exr));
    if (colour || (grey && !chroma))
        read_channels(image, file, data, display, !colour);
    else if (grey)
        read_chroma(image, stream, data, display);
    else
        throw Error("OpenEXR: none of the channels R, G, B, Y; it has " + list_of(channels));
    if (colour || chroma) transform(image, matrix);  // a luminance alone is the same grey for all primaries
    image.header = texts_of(exr);
    if (Imf::hasWhiteLuminance(exr)) image.white_luminance = static_cast<double>(Imf::whiteLuminance(exr));
    return image;
}

}  // namespace vesper::hdr
