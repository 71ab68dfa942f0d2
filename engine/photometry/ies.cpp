// Reading IES LM-63 files. Numbers are free-format after the TILT line: any mix of blanks, commas and line ends.
// SPDX-License-Identifier: MIT
#include "photometry/ies.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <utility>

#include "base/error.h"
#include "base/lower.h"
#include "io/named_file.h"
#include "io/read_file.h"
#include "photometry/table.h"

namespace vesper::photometry {
namespace {

constexpr size_t kMaxHeaderLines = 10'000;

/// Numbers from the lines of a file.
class Numbers {
public:
    /// `decimal_comma`: a comma between two digits is a decimal point; it separates numbers otherwise.
    Numbers(LineReader& lines, bool decimal_comma) : lines_(lines), decimal_comma_(decimal_comma) {}

    double next(const char* what) {
        const std::string_view token = next_token();
        if (token.empty()) lines_.fail(std::string("the file ends where ") + what + " is expected");
        const auto value = number_of(token, decimal_comma_);
        if (!value) lines_.fail(quoted(token) + " stands where " + what + " is expected");
        return *value;
    }
    double next(const char* what, double low, double high) {
        const double value = next(what);
        if (!(value >= low && value <= high)) lines_.fail(std::string(what) + " is out of range");
        return value;
    }
    std::vector<double> list(double count, const char* what) {
        std::vector<double> values;
        for (double i = 0; i < count; ++i) values.push_back(next(what));
        return values;
    }
    /// Whether yet another number follows; text after the last one is nobody's concern.
    bool more() { return number_of(next_token(), decimal_comma_).has_value(); }
    size_t line() const { return lines_.line(); }
    /// The numbers from here to the end, at most `most`; they are read again by next().
    std::vector<double> rest(size_t most) const {
        LineReader lines = lines_;
        Numbers ahead(lines, decimal_comma_);
        ahead.text_ = text_, ahead.at_ = at_;
        std::vector<double> values;
        while (values.size() < most) {
            const auto value = number_of(ahead.next_token(), decimal_comma_);
            if (!value) break;
            values.push_back(*value);
        }
        return values;
    }

private:
    std::string_view next_token() {
        const std::string_view separators(decimal_comma_ ? " \t\v\f" : " \t\v\f,");
        while (true) {
            at_ = std::min(text_.find_first_not_of(separators, at_), text_.size());
            if (at_ == text_.size()) {
                const auto line = lines_.next();
                if (!line) return {};
                text_ = trimmed(*line);
                at_ = 0;
                continue;
            }
            const size_t end = std::min(text_.find_first_of(separators, at_), text_.size());
            std::string_view token = text_.substr(at_, end - at_);
            at_ = end;
            while (token.starts_with(',')) token.remove_prefix(1);
            while (token.ends_with(',')) token.remove_suffix(1);
            if (!token.empty()) return token;
        }
    }

    LineReader& lines_;
    bool decimal_comma_;
    std::string_view text_;
    size_t at_ = 0;
};

struct IesHeader {
    int year = 1986;   ///< of LM-63; files without version line are of 1986
    std::string tilt;  ///< what follows "TILT="

    /// Whether the field after the ballast factor multiplies: the ballast-lamp photometric factor, up to LM-63-1995.
    bool has_ballast_lamp_factor() const { return year <= 1995; }
};

/// What follows "TILT=", also written "TILT = ".
std::optional<std::string_view> tilt_of(std::string_view line) {
    constexpr std::string_view kWord = "TILT";
    line = trimmed(line);
    if (upper(line.substr(0, kWord.size())) != kWord) return std::nullopt;
    line = trimmed(line.substr(kWord.size()));
    if (!line.starts_with('=')) return std::nullopt;
    return trimmed(line.substr(1));
}

/// The year of a version line: "IESNA91", "IESNA:LM-63-2002", "IES:LM-63-2019", "IESNA LM63 95"; the last where it
/// names another or none. Nothing: a label.
std::optional<int> year_of(std::string_view line) {
    std::string text;
    for (const char c : upper(line))
        if (std::isalnum(static_cast<unsigned char>(c))) text += c;
    const size_t standard = text.find("LM63");
    if (!text.starts_with("IES") || (standard == text.npos && !text.starts_with("IESNA"))) return std::nullopt;
    const std::string rest = text.substr(standard == text.npos ? 5 : standard + 4);
    if (standard == text.npos && (rest.empty() || !std::isdigit(static_cast<unsigned char>(rest.front()))))
        return std::nullopt;
    const std::string year = rest.substr(0, rest.find_first_not_of("0123456789"));
    constexpr std::pair<const char*, int> kYears[]{{"86", 1986}, {"1986", 1986}, {"91", 1991}, {"1991", 1991},
                                                   {"95", 1995}, {"1995", 1995}, {"02", 2002}, {"2002", 2002}};
    for (const auto& [name, number] : kYears)
        if (year == name) return number;
    return 2019;
}

void read_keyword(Distribution& made, std::string_view line) {
    const size_t end = line.find(']');
    if (!line.starts_with('[') || end == line.npos) return;  // a free label of 1986
    std::string key = upper(readable(line.substr(1, end - 1))), text = readable(line.substr(end + 1));
    if (key == "MORE" && !made.metadata.empty())
        made.metadata.back().second += "\n" + text;
    else
        made.metadata.emplace_back(std::move(key), std::move(text));
}

IesHeader read_header(LineReader& lines, Distribution& made) {
    IesHeader header;
    std::string label;
    bool first = true;
    for (size_t i = 0; i < kMaxHeaderLines; ++i) {
        const auto line = lines.next();
        if (!line) lines.fail("the file ends without a line TILT=: this is no IES file");
        const std::string_view text = trimmed(*line);
        if (const auto tilt = tilt_of(text)) {
            header.tilt = std::string(*tilt);
            for (const char* key : {"LUMCAT", "LUMINAIRE"})
                for (const auto& [name, value] : made.metadata)
                    if (name == key && !value.empty()) made.name = value.substr(0, value.find('\n'));
            if (made.name.empty()) made.name = label;
            return header;
        }
        if (text.empty()) continue;
        const std::optional<int> year = first ? year_of(text) : std::nullopt;
        first = false;
        if (year)
            header.year = *year;
        else if (label.empty() && !text.starts_with('['))
            label = readable(text);
        read_keyword(made, text);
    }
    lines.fail("no line TILT= in the first " + std::to_string(kMaxHeaderLines) + " lines: this is no IES file");
}

/// The factor a table of tilts has for the lamp as it was measured, at tilt 0.
double read_tilt_table(Numbers& numbers, LineReader& lines) {
    const double geometry = numbers.next("the lamp-to-luminaire geometry");
    if (geometry != 1 && geometry != 2 && geometry != 3)
        lines.fail("the lamp-to-luminaire geometry is none of 1, 2 and 3");
    const double count = numbers.next("the number of tilt angles", 1, kMaxAngles);
    if (count != std::floor(count)) lines.fail("the number of tilt angles is not whole");
    const std::vector<double> angles = numbers.list(count, "a tilt angle");
    const std::vector<double> factors = numbers.list(count, "a tilt factor");
    for (size_t i = 1; i < angles.size(); ++i)
        if (!(angles[i] > angles[i - 1])) lines.fail("the tilt angles do not ascend");
    for (const double factor : factors)
        if (!(factor >= 0 && factor <= 100)) lines.fail("a tilt factor is not in 0 to 100");
    size_t high = 0;
    while (high + 1 < angles.size() && angles[high] < 0) ++high;
    if (high == 0 || angles[high] <= 0) return factors[high];
    const double weight = -angles[high - 1] / (angles[high] - angles[high - 1]);
    return factors[high - 1] + weight * (factors[high] - factors[high - 1]);
}

double read_tilt_file(const LineReader& lines, const std::string& file, const std::filesystem::path& folder) {
    if (file.empty() || std::filesystem::path(file).filename() != std::filesystem::path(file))
        lines.fail("TILT=" + file + " is neither NONE, nor INCLUDE, nor the name of a file beside this one");
    try {
        const std::filesystem::path named = io::named_file(folder, file);
        const std::vector<uint8_t> bytes = io::read_file(named, kMaxTableBytes);
        LineReader table(bytes, named.string());
        Numbers numbers(table, false);
        return read_tilt_table(numbers, table);
    } catch (const Error& error) {
        lines.fail("TILT=" + file + ": " + error.what());
    }
}

/// The luminous opening by the signs of LM-63: negative dimensions are diameters of something round.
LuminousOpening opening_of(double width, double length, double height, int year) {
    // From 2002 on (Table 1): cylinders that lie along or across, and discs that stand, which have no area from below.
    if (year >= 2002 && height < 0 && (width < 0) != (length < 0))
        return {std::abs(length), std::abs(width), std::abs(height), false};
    LuminousOpening opening{std::abs(length), std::abs(width), std::abs(height), width < 0 || length < 0};
    if (opening.round && opening.length == 0) opening.length = opening.width;  // 1995: one diameter will do
    if (opening.round && opening.width == 0) opening.width = opening.length;
    if (!opening.round && height < 0) {  // a lying cylinder: seen from below as long as it is, as wide as it is high
        if (opening.width == 0 && opening.length > 0) opening.width = opening.height;
        if (opening.length == 0 && opening.width > 0) opening.length = opening.height;
    }
    return opening;
}

/// Refuses a file without the line of three numbers between the opening and the angles. As numbers are free-format, it
/// is told by exactly so many following as angles and intensities need, the first of which ascend as vertical angles
/// do.
void check_electrical_line(const LineReader& lines, const Numbers& numbers, size_t verticals, size_t horizontals) {
    const size_t wanted = verticals + horizontals + verticals * horizontals;
    const std::vector<double> rest = numbers.rest(wanted + 1);
    const auto end = rest.begin() + static_cast<ptrdiff_t>(std::min(verticals, rest.size()));
    const bool ascends = std::adjacent_find(rest.begin(), end, std::greater_equal<>()) == end;
    if (rest.empty() || (rest.size() == wanted && ascends))
        lines.fail_at(numbers.line() + 1,
                      "the electrical line is missing (ballast factor, ballast-lamp factor, input watts)");
}

void read_numbers(Distribution& made, LineReader lines, const IesHeader& header, bool decimal_comma,
                  const std::optional<std::filesystem::path>& folder) {
    Numbers numbers(lines, decimal_comma);
    double factor = 1;
    if (upper(header.tilt) == "INCLUDE")
        factor = read_tilt_table(numbers, lines);
    else if (upper(header.tilt) != "NONE" && folder)
        factor = read_tilt_file(lines, header.tilt, *folder);

    const auto positive = [&](const char* what) {
        const double value = numbers.next(what);
        if (!(value > 0)) lines.fail(std::string(what) + " must be more than 0");
        return value;
    };
    // Some files of absolute photometry have 0 or -1 lamps, as they have -1 lm.
    const double lamps = numbers.next("the number of lamps");
    if (!(lamps >= -1 && lamps <= 1e6 && lamps == std::floor(lamps)))
        lines.fail("the number of lamps must be a whole number from 1");
    const double lumens = numbers.next("the lumens per lamp");
    factor *= positive("the candela multiplier");
    const double verticals = numbers.next("the number of vertical angles");
    const double horizontals = numbers.next("the number of horizontal angles");
    const std::string reason = objection_to_size(horizontals, verticals);
    if (!reason.empty()) lines.fail(reason);
    const double type = numbers.next("the photometric type"), units = numbers.next("the type of units");
    if (type != 1 && type != 2 && type != 3) lines.fail("the photometric type is none of 1 (C), 2 (B) and 3 (A)");
    if (units != 1 && units != 2) lines.fail("the type of units is neither 1 (feet) nor 2 (metres)");
    made.goniometry = type == 1 ? Goniometry::CGamma : type == 2 ? Goniometry::TypeB : Goniometry::TypeA;
    const double metres = units == 1 ? 0.3048 : 1;
    const double width = numbers.next("the width of the opening"), length = numbers.next("the length of the opening");
    made.opening =
        opening_of(width * metres, length * metres, numbers.next("the height of the opening") * metres, header.year);
    check_electrical_line(lines, numbers, static_cast<size_t>(verticals), static_cast<size_t>(horizontals));
    factor *= positive("the ballast factor");
    const char* after = "the number after the ballast factor";
    const double second = header.has_ballast_lamp_factor() ? positive(after) : numbers.next(after);
    if (header.has_ballast_lamp_factor()) factor *= second;
    if (!(factor > 0 && factor < 1e9)) lines.fail("multiplier, ballast and tilt factors multiply to nothing useful");
    numbers.next("the input watts");
    made.lamp_flux = lumens > 0 ? lumens * std::max(1.0, lamps) : 0;  // -1: absolute photometry

    size_t starts[3];
    made.vertical = numbers.list(verticals, "a vertical angle");
    starts[static_cast<size_t>(TablePart::Vertical)] = numbers.line();
    made.horizontal = numbers.list(horizontals, "a horizontal angle");
    starts[static_cast<size_t>(TablePart::Horizontal)] = numbers.line();
    made.candela = numbers.list(verticals * horizontals, "an intensity");
    starts[static_cast<size_t>(TablePart::Candela)] = numbers.line();
    if (numbers.more())
        lines.fail("more intensities than the " + std::to_string(made.vertical.size()) + " x " +
                   std::to_string(made.horizontal.size()) + " stated");
    for (double& candela : made.candela) candela *= factor;
    finish_table(made, true, [&](TablePart part, const std::string& fault) {
        lines.fail_at(starts[static_cast<size_t>(part)], fault);
    });
    note_flux(made);
}

}  // namespace

Distribution parse_ies(std::span<const uint8_t> text, const std::string& name,
                       const std::optional<std::filesystem::path>& folder) {
    LineReader lines(text, name);
    Distribution made;
    const IesHeader header = read_header(lines, made);
    // Commas separate numbers, but some programs print them for decimal points. Where no point appears they are tried
    // as such: a file that they separate then has too few numbers.
    const std::string_view rest = lines.rest();
    if (rest.find(',') != rest.npos && rest.find('.') == rest.npos) {
        try {
            Distribution decimal = made;
            read_numbers(decimal, lines, header, true, folder);
            return decimal;
        } catch (const Error&) {
        }
    }
    read_numbers(made, lines, header, false, folder);
    return made;
}

Distribution read_ies(const std::filesystem::path& file) {
    Distribution made = parse_ies(io::read_file(file, kMaxTableBytes), file.string(), file.parent_path());
    if (made.name.empty()) made.name = readable(file.stem().string());
    return made;
}

}  // namespace vesper::photometry
