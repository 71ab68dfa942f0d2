// Radiance pictures, in. Format: G. Ward, "Real Pixels", Graphics Gems II (1991), and the Radiance manual's "File
// Formats". stb_image was looked at: it gives black where a file ends early, and knows neither EXPOSURE, PRIMARIES,
// XYZE nor the older run lengths. SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string_view>

#include "base/budget.h"
#include "base/error.h"
#include "base/one_line.h"
#include "io/hdr_parts.h"

namespace vesper::io::hdr {
namespace {

using Rgbe = std::array<uint8_t, 4>;

class Bytes {
public:
    explicit Bytes(std::span<const uint8_t> bytes) : rest_(bytes) {}
    uint8_t next() {
        if (rest_.empty()) throw Error("Radiance: is cut off");
        const uint8_t byte = rest_.front();
        rest_ = rest_.subspan(1);
        return byte;
    }
    uint8_t peek(size_t ahead) const { return ahead < rest_.size() ? rest_[ahead] : 0; }
    std::string line() {
        std::string text;
        for (uint8_t byte = next(); byte != '\n'; byte = next()) {
            if (text.size() >= 4096) throw Error("Radiance: a line of the header has no end");
            text += static_cast<char>(byte);
        }
        if (!text.empty() && text.back() == '\r') text.pop_back();
        return text;
    }
    size_t left() const { return rest_.size(); }

private:
    std::span<const uint8_t> rest_;
};

/// Without blanks before and after it.
std::string word_of(const std::string& text) {
    const size_t first = std::min(text.find_first_not_of(" \t"), text.size());
    return text.substr(first, text.find_last_not_of(" \t") + 1 - first);
}

/// Exactly `count` finite numbers.
std::optional<std::vector<double>> numbers(const std::string& text, size_t count) {
    std::vector<double> values;
    std::string_view rest = text;
    while (true) {
        rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
        if (rest.empty()) break;
        std::string_view word = rest.substr(0, rest.find_first_of(" \t"));
        rest.remove_prefix(word.size());
        if (word.starts_with('+')) word.remove_prefix(1);
        double value = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value) || values.size() == count)
            return std::nullopt;
        values.push_back(value);
    }
    if (values.size() != count) return std::nullopt;
    return values;
}

/// One axis of the resolution line, such as "-Y 480".
struct Axis {
    char sign = 0, name = 0;
    int64_t size = 0;

    /// Column or row, from the top left, of the index-th pixel along it. Y points up.
    size_t place(size_t index) const {
        return (sign == '-') == (name == 'Y') ? index : static_cast<size_t>(size) - 1 - index;
    }
};

struct Description {
    Header header;
    double exposure = 1;
    std::array<double, 3> correction{1, 1, 1};  ///< COLORCORR
    std::vector<std::string> notes;             ///< of values that were passed over, each once
    std::optional<Primaries> primaries;
    bool radiance = false;  ///< one of Radiance's programs made it
    bool xyz = false;
    Axis lines, along;  ///< from line to line, and along one
};

/// Whether a line of the header is the command of one of the programs that take colours without PRIMARIES for
/// Radiance's own.
bool is_radiance_command(const std::string& line) {
    static constexpr std::string_view kPrograms[]{
        "rpict",   "rtpict",  "rvu",        "rview",  "rtrace", "rcontrib",   "rtcontrib",
        "rxpict",  "rxtrace", "rpiece",     "pfilt",  "pcomb",  "pcompos",    "pcond",
        "pinterp", "pvalue",  "dctimestep", "rmtxop", "rcomb",  "falsecolor", "ra_xyze"};
    const std::string command = word_of(line);
    const bool in_quotes = command.starts_with('"');
    const std::string program =
        in_quotes ? command.substr(1, command.find('"', 1) - 1) : command.substr(0, command.find_first_of(" \t"));
    std::string_view name = std::string_view(program).substr(program.find_last_of("/\\") + 1);
    if (name.ends_with(".exe")) name.remove_suffix(4);
    return std::find(std::begin(kPrograms), std::end(kPrograms), name) != std::end(kPrograms);
}

/// `count` positive numbers; else nothing, with a note.
std::optional<std::vector<double>> positive_numbers(Description& made, const std::string& name,
                                                    const std::string& value, size_t count) {
    auto factors = numbers(value, count);
    if (factors && std::all_of(factors->begin(), factors->end(), [](double v) { return v > 0; })) return factors;
    const std::string note = "Radiance: " + name + "=" + one_line(value, 60) +
                             (count == 1 ? " is not a positive number" : " are not three positive numbers") +
                             ": read as if it were not there";
    if (std::find(made.notes.begin(), made.notes.end(), note) == made.notes.end()) made.notes.push_back(note);
    return std::nullopt;
}

void read_variable(Description& made, const std::string& name, const std::string& value) {
    if (name == "FORMAT") {
        const std::string format = word_of(value);
        made.xyz = format == "32-bit_rle_xyze";
        if (!made.xyz && format != "32-bit_rle_rgbe") throw Error("Radiance: FORMAT=" + value + " is not known");
    } else if (name == "EXPOSURE") {  // cumulative: each program that scaled the picture added a line
        if (const auto factor = positive_numbers(made, name, value, 1)) made.exposure *= factor->front();
    } else if (name == "COLORCORR") {
        if (const auto factors = positive_numbers(made, name, value, 3))  // cumulative, too
            for (size_t c = 0; c < 3; ++c) made.correction[c] *= (*factors)[c];
    } else if (name == "PRIMARIES") {
        const auto p = numbers(value, 8);
        if (!p) throw Error("Radiance: PRIMARIES=" + value + " are not eight numbers");
        // Some programs write eight zeros for "I do not know".
        if (std::any_of(p->begin(), p->end(), [](double v) { return v != 0; }))
            made.primaries = Primaries{{(*p)[0], (*p)[1]}, {(*p)[2], (*p)[3]}, {(*p)[4], (*p)[5]}, {(*p)[6], (*p)[7]}};
    } else if (name == "VIEW" || (name == "SOFTWARE" && value.find("RADIANCE") != std::string::npos)) {
        made.radiance = true;
    }
}

Description read_description(Bytes& bytes) {
    Description made;
    bytes.line();  // #?RADIANCE
    for (std::string line = bytes.line(); !line.empty(); line = bytes.line()) {
        const size_t equals = line.find('=');
        made.radiance |= is_radiance_command(line);
        // What is said of pictures that this one was made of is indented, comments start with #.
        if (equals == std::string::npos || equals == 0 || line[0] == ' ' || line[0] == '\t' || line[0] == '#') continue;
        if (made.header.size() >= 1000) throw Error("Radiance: more than 1000 lines of header");
        made.header.emplace_back(line.substr(0, equals), line.substr(equals + 1));
        read_variable(made, made.header.back().first, made.header.back().second);
    }
    for (const double correction : made.correction)
        if (const double factor = made.exposure * correction; !(factor >= 1e-12 && factor <= 1e12))
            throw Error("Radiance: the EXPOSUREs and COLORCORRs multiply to no exposure of a picture");
    const std::string size = bytes.line();
    Axis &a = made.lines, &b = made.along;
    int lines = 0, along = 0, end = 0;
    const bool read = std::sscanf(size.c_str(), "%c%c %9d %c%c %9d%n", &a.sign, &a.name, &lines, &b.sign, &b.name,
                                  &along, &end) == 6 &&
                      size.find_first_not_of(' ', static_cast<size_t>(end)) == std::string::npos;
    const auto sound = [](const Axis& axis) {
        return (axis.sign == '+' || axis.sign == '-') && (axis.name == 'X' || axis.name == 'Y');
    };
    if (!read || !sound(a) || !sound(b) || a.name == b.name)
        throw Error("Radiance: '" + size + "' where -Y HEIGHT +X WIDTH, or another order of the two axes, is expected");
    a.size = lines;
    b.size = along;
    return made;
}

/// One row in the newer coding: the four components one after the other, each in runs.
void read_runs(Bytes& bytes, std::vector<Rgbe>& row) {
    for (size_t c = 0; c < 4; ++c) {
        for (size_t x = 0; x < row.size();) {
            const size_t code = bytes.next(), count = code > 128 ? code - 128 : code;
            if (count == 0 || count > row.size() - x) throw Error("Radiance: a run does not fit its row");
            const uint8_t same = code > 128 ? bytes.next() : 0;
            for (size_t i = 0; i < count; ++i) row[x++][c] = code > 128 ? same : bytes.next();
        }
    }
}

/// One row of plain pixels; (1, 1, 1, n) repeats the pixel before it n times, a second one in a row 256 n times.
void read_plain(Bytes& bytes, std::vector<Rgbe>& row) {
    unsigned shift = 0;
    for (size_t x = 0; x < row.size();) {
        Rgbe pixel;
        for (uint8_t& byte : pixel) byte = bytes.next();
        if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
            const size_t count = shift < 24 ? size_t{pixel[3]} << shift : row.size() + 1;
            if (x == 0 || count > row.size() - x) throw Error("Radiance: a run does not fit its row");
            std::fill_n(row.begin() + static_cast<std::ptrdiff_t>(x), count, row[x - 1]);
            x += count;
            shift += 8;
        } else {
            row[x++] = pixel;
            shift = 0;
        }
    }
}

}  // namespace

HdrImage decode_radiance(std::span<const uint8_t> file, const HdrLimits& limits) {
    Bytes bytes(file);
    Description made = read_description(bytes);
    const Axis &lines = made.lines, &along = made.along;
    const bool rows = lines.name == 'Y';
    const int64_t width = rows ? along.size : lines.size, height = rows ? lines.size : along.size;
    check_size("Radiance: picture", width, height, limits);
    const glm::dmat3 matrix = to_rec709(made.xyz ? kXyz : made.primaries.value_or(made.radiance ? kRadiance : kRec709));
    const auto count = static_cast<size_t>(lines.size), length = static_cast<size_t>(along.size);
    if (bytes.left() / 4 < count) throw Error("Radiance: is cut off");  // a line takes four bytes at the very least
    HdrImage image{static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
    spend(uint64_t{count} * length * 3 * sizeof(float));
    image.rgb.resize(count * length * 3);
    std::vector<Rgbe> line(length);
    for (size_t i = 0; i < count; ++i) {
        check_time();
        const bool runs =
            length >= 8 && length < 32768 && bytes.peek(0) == 2 && bytes.peek(1) == 2 && bytes.peek(2) < 128;
        if (runs) {
            const size_t marked = size_t{bytes.peek(2)} << 8 | bytes.peek(3);
            if (marked != length)
                throw Error("Radiance: a row of " + std::to_string(marked) + " px in a picture of " +
                            std::to_string(length));
            for (int k = 0; k < 4; ++k) bytes.next();
            read_runs(bytes, line);
        } else {
            read_plain(bytes, line);
        }
        for (size_t j = 0; j < length; ++j) {
            const size_t x = rows ? along.place(j) : lines.place(i), y = rows ? lines.place(i) : along.place(j);
            float* out = image.rgb.data() + 3 * (y * image.width + x);
            const double unit = line[j][3] ? std::ldexp(1.0, line[j][3] - 136) / made.exposure : 0;
            for (size_t c = 0; c < 3; ++c) out[c] = static_cast<float>((line[j][c] + 0.5) * unit / made.correction[c]);
        }
    }
    transform(image, matrix);
    if (made.xyz) image.white_luminance = 1;  // lm/sr/m^2, where RGBE has W/sr/m^2
    image.header = std::move(made.header);
    image.exposure = made.exposure;
    image.notes = std::move(made.notes);
    return image;
}

}  // namespace vesper::io::hdr
