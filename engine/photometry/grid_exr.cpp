// Grids of intensity in OpenEXR files. SPDX-License-Identifier: MIT
#include <cstring>
#include <stdexcept>

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfStringAttribute.h>

#include "base/error.h"
#include "io/atomic_file.h"
#include "photometry/grid.h"
#include "photometry/table.h"

namespace vesper {
namespace {

class MemoryInput : public Imf::IStream {
public:
    MemoryInput(std::span<const uint8_t> bytes, const std::string& name) : IStream(name.c_str()), bytes_(bytes) {}
    bool read(char to[], int count) override {
        const auto size = static_cast<size_t>(count);
        if (count < 0 || at_ > bytes_.size() || size > bytes_.size() - at_) throw std::runtime_error("is cut off");
        std::memcpy(to, bytes_.data() + at_, size);
        at_ += size;
        return at_ < bytes_.size();
    }
    uint64_t tellg() override { return at_; }
    void seekg(uint64_t position) override { at_ = position; }

private:
    std::span<const uint8_t> bytes_;
    uint64_t at_ = 0;
};

uint32_t word_at(std::span<const uint8_t> bytes, size_t at) {
    return static_cast<uint32_t>(bytes[at]) | static_cast<uint32_t>(bytes[at + 1]) << 8 |
           static_cast<uint32_t>(bytes[at + 2]) << 16 | static_cast<uint32_t>(bytes[at + 3]) << 24;
}

/// Why a file is not to be given to OpenEXR, which allocates what a header states; empty if it may be.
std::string objection_to_header(std::span<const uint8_t> bytes) {
    if (bytes.size() < 8 || word_at(bytes, 0) != 20000630) return "is no OpenEXR file";
    if ((word_at(bytes, 4) & 0xffu) != 2 || (word_at(bytes, 4) & 0x1a00u) != 0)
        return "is tiled, deep, of several parts or of another version: one part of scan lines is read";
    size_t at = 8;
    std::string reason = "states no data window";
    const auto text = [&] {
        std::string made;
        while (at < bytes.size() && bytes[at] != 0 && made.size() < 256) made += static_cast<char>(bytes[at++]);
        ++at;
        return made;
    };
    while (true) {
        const std::string name = text();
        if (at > bytes.size()) return "is cut off in its header";
        if (name.empty()) return reason;
        text();
        if (at > bytes.size() || bytes.size() - at < 4) return "is cut off in its header";
        const uint64_t size = word_at(bytes, at);
        at += 4;
        if (size > bytes.size() - at) return "is cut off in its header";
        if (name == "dataWindow") {
            if (size != 16) return "has no sound data window";
            const auto corner = [&](size_t i) { return static_cast<int32_t>(word_at(bytes, at + 4 * i)); };
            reason = objection_to_size(double{1} + corner(2) - corner(0), double{1} + corner(3) - corner(1));
            if (!reason.empty()) return reason;
        }
        at += size;
    }
}

std::string text_attribute(const Imf::Header& header, const char* name) {
    const auto* text = header.findTypedAttribute<Imf::StringAttribute>(name);
    return text ? text->value() : "";
}

double number_attribute(const Imf::Header& header, const char* name) {
    if (const auto* single = header.findTypedAttribute<Imf::FloatAttribute>(name)) return single->value();
    if (const auto* twice = header.findTypedAttribute<Imf::DoubleAttribute>(name)) return twice->value();
    const auto value = number_of(text_attribute(header, name));
    if (!value) throw std::runtime_error(std::string("has no number in the header attribute ") + name);
    return *value;
}

std::vector<double> steps(double first, double last, size_t count) {
    std::vector<double> angles(count, first);
    for (size_t i = 1; i < count; ++i)
        angles[i] = first + (last - first) * static_cast<double>(i) / static_cast<double>(count - 1);
    return angles;
}

Distribution read_checked(std::span<const uint8_t> bytes, const std::string& name) {
    MemoryInput stream(bytes, name);
    Imf::InputFile file(stream);
    const Imf::Header& header = file.header();
    const auto window = header.dataWindow();
    const auto columns = static_cast<size_t>(window.max.x - window.min.x) + 1;
    const auto rows = static_cast<size_t>(window.max.y - window.min.y) + 1;
    auto channel = header.channels().begin();
    if (channel == header.channels().end() || ++header.channels().begin() != header.channels().end())
        throw std::runtime_error("must have one channel, of cd");
    if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1)
        throw std::runtime_error("its channel is subsampled");

    Distribution made;
    const std::string goniometry = text_attribute(header, "goniometry");
    if (goniometry == "B")
        made.goniometry = Goniometry::TypeB;
    else if (goniometry.empty() || goniometry == "A")
        made.goniometry = Goniometry::TypeA;
    else if (goniometry != "C")
        throw std::runtime_error("its header attribute goniometry is none of A, B and C");
    made.horizontal =
        steps(number_attribute(header, "horizontalFirst"), number_attribute(header, "horizontalLast"), columns);
    made.vertical = steps(number_attribute(header, "verticalTop"), number_attribute(header, "verticalBottom"), rows);
    const bool down = made.vertical.front() > made.vertical.back();

    std::vector<float> pixels(columns * rows);
    Imf::FrameBuffer frame;
    frame.insert(channel.name(), Imf::Slice::Make(Imf::FLOAT, pixels.data(), window));
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
    made.candela.resize(pixels.size());
    for (size_t h = 0; h < columns; ++h)
        for (size_t v = 0; v < rows; ++v)
            made.candela[h * rows + v] = static_cast<double>(pixels[(down ? rows - 1 - v : v) * columns + h]);
    if (down) made.vertical = {made.vertical.rbegin(), made.vertical.rend()};
    finish_table(made, false, [](TablePart, const std::string& fault) { throw std::runtime_error(fault); });
    return made;
}

}  // namespace

Distribution parse_grid_exr(std::span<const uint8_t> bytes, const std::string& name) {
    const std::string reason = objection_to_header(bytes);
    if (!reason.empty()) throw Error(one_line(name + ": " + reason));
    try {
        return read_checked(bytes, name);
    } catch (const std::exception& error) {
        throw Error(one_line(name + ": OpenEXR: " + error.what()));
    }
}

}  // namespace vesper
