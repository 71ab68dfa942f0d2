// Grids of intensity in OpenEXR files. SPDX-License-Identifier: MIT
#include <new>
#include <stdexcept>

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStringAttribute.h>

#include "base/error.h"
#include "base/one_line.h"
#include "io/exr_stream.h"
#include "photometry/grid.h"
#include "photometry/table.h"

namespace vesper::photometry {
namespace {

/// Throws Error unless the file can be given to OpenEXR, which allocates what a header states.
void check_header(std::span<const uint8_t> bytes) {
    bool sized = false;
    io::see_exr_attributes(bytes, [&](std::string_view name, std::span<const uint8_t> value) {
        if (name != "dataWindow") return;
        if (value.size() != 16) throw Error("has no sound data window");
        const auto corner = [&](size_t i) { return static_cast<int32_t>(io::exr_word(value, 4 * i)); };
        const std::string reason =
            objection_to_size(double{1} + corner(2) - corner(0), double{1} + corner(3) - corner(1));
        if (!reason.empty()) throw Error(reason);
        sized = true;
    });
    if (const uint32_t word = io::exr_word(bytes, 4);
        (word & io::kExrVersion) != 2 || (word & (io::kExrTiled | io::kExrDeep | io::kExrParts)) != 0)
        throw Error("is tiled, deep, of several parts or of another version: one part of scan lines is read");
    if (!sized) throw Error("states no data window");
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
    io::ExrStream stream(name, bytes);
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

bool is_grid_exr(std::span<const uint8_t> start) {
    bool grid = false;
    try {
        io::see_exr_attributes(start, [&](std::string_view name, std::span<const uint8_t> value) {
            const std::string_view text(reinterpret_cast<const char*>(value.data()), value.size());
            grid |= name == "horizontalFirst" || name == "verticalTop" ||
                    (name == "channels" && text.starts_with(std::string_view("cd\0", 3)));
        });
    } catch (const Error&) {  // no OpenEXR file, or its start alone
    }
    return grid;
}

Distribution parse_grid_exr(std::span<const uint8_t> bytes, const std::string& name) {
    try {
        check_header(bytes);
    } catch (const Error& error) {
        throw Error(one_line(name + ": " + error.what()));
    }
    try {
        return read_checked(bytes, name);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        throw Error(one_line(name + ": OpenEXR: " + error.what()));
    }
}

}  // namespace vesper::photometry
