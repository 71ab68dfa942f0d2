// Reading EULUMDAT: one value per line, in an order that never changes. SPDX-License-Identifier: MIT
#include "photometry/eulumdat.h"

#include <algorithm>
#include <cmath>

#include "io/read_file.h"
#include "photometry/table.h"

namespace vesper::photometry {
namespace {

constexpr double kMaxLampSets = 1000;

/// Values from the lines of a file.
class Values {
public:
    explicit Values(LineReader& lines) : lines_(lines) {}

    std::string text(const char* what) { return readable(raw(what)); }
    double number(const char* what) {
        const std::string_view line = raw(what);
        const auto value = number_of(line);
        if (!value) lines_.fail(quoted(line) + " stands where " + what + " is expected");
        return *value;
    }
    /// For what an intensity does not depend on: 0 where the line is empty or holds something else.
    double loose(const char* what) { return number_of(raw(what)).value_or(0); }
    double whole(const char* what, double low, double high) {
        const double value = number(what);
        if (!(value >= low && value <= high && value == std::floor(value)))
            lines_.fail(std::string(what) + " must be a whole number from " + std::to_string(static_cast<int>(low)) +
                        " to " + std::to_string(static_cast<int>(high)));
        return value;
    }
    std::vector<double> list(double count, const char* what) {
        std::vector<double> values;
        for (double i = 0; i < count; ++i) values.push_back(number(what));
        return values;
    }
    void skip(int count, const char* what) {
        for (int i = 0; i < count; ++i) raw(what);
    }

private:
    std::string_view raw(const char* what) {
        const auto line = lines_.next();
        if (!line) lines_.fail(std::string("the file ends where ") + what + " is expected");
        return *line;
    }

    LineReader& lines_;
};

void note(Distribution& made, const char* key, const std::string& text) {
    if (!text.empty()) made.metadata.emplace_back(key, text);
}

/// Flux of the set of lamps chosen, lm.
double read_lamps(Values& values, const LineReader& lines, Distribution& made, size_t chosen) {
    const double sets = values.whole("the number of sets of lamps", 1, kMaxLampSets);
    if (static_cast<double>(chosen) >= sets)
        lines.fail("there are " + std::to_string(static_cast<int>(sets)) + " sets of lamps: none has the number " +
                   std::to_string(chosen));
    double flux = 0;
    for (size_t set = 0; static_cast<double>(set) < sets; ++set) {
        const double lamps = values.number("the number of lamps");
        const std::string type = values.text("the type of lamps");
        const double lumens = values.number("the flux of the lamps");
        const std::string colour = values.text("the colour of the lamps");
        values.skip(2, "colour rendering or watts of the lamps");
        if (set != chosen) continue;
        if (!(lumens > 0 && lumens <= 1e9)) lines.fail("the flux of the lamps is not more than 0");
        flux = lumens;
        made.lamp_flux = lamps < 0 ? 0 : lumens;
        note(made, "LAMP", type);
        note(made, "COLORTEMP", colour);
    }
    return flux;
}

size_t index_of(const std::vector<double>& angles, double wanted, const LineReader& lines, size_t line) {
    for (size_t i = 0; i < angles.size(); ++i)
        if (std::abs(angles[i] - wanted) < 1e-6) return i;
    lines.fail_at(line, "the symmetry stated needs a plane C" + std::to_string(static_cast<int>(wanted)));
}

/// The C angles of the planes a file of that symmetry stores, in their order.
std::vector<double> stored_planes(const std::vector<double>& all, int symmetry, const LineReader& lines, size_t line) {
    switch (symmetry) {
        case 1:  // about the vertical axis
            return {0};
        case 2:  // about C0-C180: C0 to C180
            return {all.begin(), all.begin() + static_cast<ptrdiff_t>(index_of(all, 180, lines, line) + 1)};
        case 3: {  // about C90-C270: C270 over C0 to C90
            const size_t first = index_of(all, 270, lines, line), last = index_of(all, 90, lines, line);
            std::vector<double> planes;
            for (size_t i = first; i < all.size() && all[i] < 360; ++i) planes.push_back(all[i] - 360);
            planes.insert(planes.end(), all.begin(), all.begin() + static_cast<ptrdiff_t>(last + 1));
            return planes;
        }
        case 4:  // about both: C0 to C90
            return {all.begin(), all.begin() + static_cast<ptrdiff_t>(index_of(all, 90, lines, line) + 1)};
        default:
            return all;
    }
}

}  // namespace

Distribution parse_eulumdat(std::span<const uint8_t> text, const std::string& name, size_t lamp_set) {
    LineReader lines(text, name);
    Values values(lines);
    Distribution made;
    note(made, "MANUFAC", values.text("the company"));
    values.skip(1, "the type of luminaire");
    const int symmetry = static_cast<int>(values.whole("the symmetry", 0, 4));
    const double planes = values.whole("the number of C planes", 1, kMaxAngles);
    values.skip(1, "the spacing of C planes");
    const double gammas = values.whole("the number of gamma angles", 2, kMaxAngles);
    values.skip(1, "the spacing of gamma angles");
    note(made, "TEST", values.text("the report number"));
    made.name = values.text("the luminaire's name");
    note(made, "LUMINAIRE", made.name);
    note(made, "LUMCAT", values.text("the luminaire's number"));
    values.skip(1, "the file's name");
    note(made, "ISSUEDATE", values.text("the date"));
    values.skip(3, "a dimension of the luminaire");
    constexpr double kMillimetre = 1e-3;
    made.opening.width = std::abs(values.loose("the length of the luminous area")) * kMillimetre;
    made.opening.length = std::abs(values.loose("the width of the luminous area")) * kMillimetre;
    made.opening.round = made.opening.length == 0 && made.opening.width > 0;  // width 0: the length is a diameter
    if (made.opening.round) made.opening.length = made.opening.width;
    for (const char* what : {"C0", "C90", "C180", "C270"}) {
        const double height = std::abs(values.loose(what)) * kMillimetre;
        made.opening.height = std::max(made.opening.height, height);
    }
    values.skip(2, "the downward flux or the light output ratio");
    const double conversion = values.number("the conversion factor");
    if (!(conversion > 0 && conversion <= 1e6)) lines.fail("the conversion factor must be more than 0");
    values.skip(1, "the tilt during measurement");
    const double flux = read_lamps(values, lines, made, lamp_set);
    values.skip(10, "a direct ratio");

    const size_t c_line = lines.line() + 1;
    const std::vector<double> all = values.list(planes, "a C angle");
    for (size_t i = 1; i < all.size(); ++i)
        if (!(all[i] > all[i - 1])) lines.fail_at(c_line + i, "the C angles do not ascend");
    made.horizontal = stored_planes(all, symmetry, lines, c_line);
    if (symmetry == 0 && planes > 1 && !go_round(all))
        lines.fail_at(c_line, "no symmetry is stated, but the C angles do not go round");
    const size_t gamma_line = lines.line() + 1;
    made.vertical = values.list(gammas, "a gamma angle");
    const std::string reason = objection_to_size(static_cast<double>(made.horizontal.size()), gammas);
    if (!reason.empty()) lines.fail_at(gamma_line, reason);
    const size_t candela_line = lines.line() + 1;
    made.candela =
        values.list(static_cast<double>(made.horizontal.size() * made.vertical.size()), "an intensity in cd/klm");
    // What stands after an empty line is not part of the table: some programs append one of their own.
    const auto after = lines.next();
    if (after && number_of(*after)) lines.fail("more intensities than the symmetry and the angles stated need");
    for (double& candela : made.candela) candela *= flux / 1000 * conversion;
    finish_table(made, false, [&](TablePart part, const std::string& fault) {
        lines.fail_at(part == TablePart::Horizontal ? c_line
                      : part == TablePart::Vertical ? gamma_line
                                                    : candela_line,
                      fault);
    });
    note_flux(made);
    return made;
}

Distribution read_eulumdat(const std::filesystem::path& file, size_t lamp_set) {
    Distribution made = parse_eulumdat(io::read_file(file, kMaxTableBytes), file.string(), lamp_set);
    if (made.name.empty()) made.name = readable(file.stem().string());
    return made;
}

}  // namespace vesper::photometry
