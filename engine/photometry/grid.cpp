// Grids of intensity in CSV files. SPDX-License-Identifier: MIT
#include "photometry/grid.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>

#include "base/lower.h"
#include "io/read_file.h"
#include "photometry/table.h"

namespace vesper::photometry {
namespace {

constexpr size_t kMaxColumns = kMaxAngles + 2;  // a vertical angle before the others, nothing behind the last separator

/// The goniometry a word names: A, "type B", gamma\C; type A for other words, nothing for what is none.
std::optional<Goniometry> goniometry_of(std::string_view cell) {
    std::string word = lower(cell);
    if (word.find("gamma") != word.npos) return Goniometry::CGamma;
    if (word.starts_with("type")) word = lower(trimmed(std::string_view(word).substr(4)));
    if (word == "c" || (word.starts_with("c") && !std::isalpha(static_cast<unsigned char>(word[1]))))
        return Goniometry::CGamma;
    if (word == "b") return Goniometry::TypeB;
    if (number_of(word)) return std::nullopt;
    return Goniometry::TypeA;
}

enum class Column : uint8_t { Horizontal, Vertical, C, Gamma, Candela };

/// What a column of a list holds, by its heading; nothing for other names and other units.
std::optional<Column> column_of(std::string_view heading) {
    static const std::map<std::string, Column, std::less<>> kNames{{"h", Column::Horizontal},
                                                                   {"horizontal", Column::Horizontal},
                                                                   {"v", Column::Vertical},
                                                                   {"vertical", Column::Vertical},
                                                                   {"c", Column::C},
                                                                   {"gamma", Column::Gamma},
                                                                   {"γ", Column::Gamma},
                                                                   {"cd", Column::Candela},
                                                                   {"candela", Column::Candela},
                                                                   {"intensity", Column::Candela},
                                                                   {"i", Column::Candela}};
    static const std::set<std::string, std::less<>> kBeside{"deg",   "degree",   "degrees", "angle",
                                                            "plane", "luminous", "in"};
    std::optional<Column> column;
    for (const std::string& word : words_of(heading)) {
        if (kBeside.contains(word)) continue;
        const auto name = kNames.find(word);
        if (name == kNames.end() || (column && *column != name->second)) return std::nullopt;
        column = name->second;
    }
    return column;
}

/// Whether a corner cell, "rows\\columns", names the horizontal angle first.
bool names_rows_horizontal(std::string_view corner) {
    const size_t at = corner.find_first_of("\\/|");
    if (at == corner.npos) return false;
    const auto rows = column_of(corner.substr(0, at)), columns = column_of(corner.substr(at + 1));
    return (rows == Column::Horizontal && columns == Column::Vertical) ||
           (rows == Column::C && columns == Column::Gamma);
}

/// Which columns of a list are the horizontal angle, the vertical one and the intensity.
struct ListColumns {
    size_t horizontal = 0, vertical = 0, candela = 0;
    Goniometry goniometry = Goniometry::TypeA;
};

ListColumns list_columns_of(const std::vector<std::string_view>& header, const LineReader& lines) {
    std::map<Column, size_t> at;
    for (size_t i = 0; i < header.size(); ++i) {
        const auto column = column_of(header[i]);
        if (!column) lines.fail("the heading " + quoted(header[i]) + " is none of H, V and cd, nor of C, gamma and cd");
        at[*column] = i;
    }
    const bool c = at.contains(Column::C);
    const Column horizontal = c ? Column::C : Column::Horizontal, vertical = c ? Column::Gamma : Column::Vertical;
    if (!at.contains(horizontal) || !at.contains(vertical) || !at.contains(Column::Candela))
        lines.fail("the headings are not H, V and cd, nor C, gamma and cd");
    return {at[horizontal], at[vertical], at[Column::Candela], c ? Goniometry::CGamma : Goniometry::TypeA};
}

/// A CSV file as rows of cells, without comments and empty lines.
class Rows {
public:
    explicit Rows(LineReader& lines) : lines_(lines) {}

    /// The cells of the next row; none at the end of the file.
    const std::vector<std::string_view>& next() {
        cells_.clear();
        while (const auto line = lines_.next()) {
            std::string_view text = trimmed(*line);
            if (text.starts_with('#')) read_comment(text.substr(1));
            if (text.empty() || text.starts_with('#')) continue;
            if (separator_ == 0)
                separator_ = line->find(';') != line->npos ? ';' : line->find('\t') != line->npos ? '\t' : ',';
            split(separator_ == '\t' ? *line : text);
            break;
        }
        return cells_;
    }
    double number(size_t cell, const char* what) const {
        const auto value = number_of(cells_[cell], separator_ != ',');
        if (!value) lines_.fail(quoted(cells_[cell]) + " stands where " + what + " is expected");
        return *value;
    }
    /// What a comment said.
    std::optional<Goniometry> goniometry() const { return goniometry_; }

private:
    void read_comment(std::string_view text) {
        const size_t colon = text.find(':');
        if (colon == text.npos || lower(trimmed(text.substr(0, colon))) != "goniometry") return;
        const std::string word = lower(trimmed(text.substr(colon + 1)));
        if (word != "a" && word != "b" && word != "c") lines_.fail("the goniometry is none of A, B and C");
        goniometry_ = goniometry_of(word);
    }
    void split(std::string_view text) {
        cells_ = fields_of(text, separator_, kMaxColumns);
        if (cells_.size() > kMaxColumns) lines_.fail("more columns than are read");
        if (cells_.size() > 1 && cells_.back().empty()) cells_.pop_back();  // a separator at the end
    }

    LineReader& lines_;
    char separator_ = 0;
    std::vector<std::string_view> cells_;
    std::optional<Goniometry> goniometry_;
};

/// Where each part of the table is, for messages.
struct Places {
    size_t horizontal = 0, vertical = 0, candela = 0;
};

/// Turns angles that descend round, and their intensities with them.
void turn_round(Distribution& table) {
    const size_t columns = table.horizontal.size(), rows = table.vertical.size();
    const bool h = columns > 1 && table.horizontal[0] > table.horizontal[1];
    const bool v = rows > 1 && table.vertical[0] > table.vertical[1];
    const auto width = static_cast<ptrdiff_t>(rows);
    if (v) {
        std::reverse(table.vertical.begin(), table.vertical.end());
        for (auto plane = table.candela.begin(); plane != table.candela.end(); plane += width)
            std::reverse(plane, plane + width);
    }
    if (!h) return;
    std::reverse(table.horizontal.begin(), table.horizontal.end());
    for (size_t i = 0; i < columns / 2; ++i) {
        const auto left = table.candela.begin() + static_cast<ptrdiff_t>(i * rows);
        std::swap_ranges(left, left + width, table.candela.end() - static_cast<ptrdiff_t>((i + 1) * rows));
    }
}

/// One row of angles, then a row for each vertical angle.
Places read_matrix(Distribution& made, Rows& rows, const std::vector<std::string_view>& header,
                   const LineReader& lines) {
    for (size_t i = 1; i < header.size(); ++i) made.horizontal.push_back(rows.number(i, "a horizontal angle"));
    const Places places{lines.line(), lines.line() + 1, lines.line() + 1};
    const size_t columns = made.horizontal.size();
    std::vector<double> by_row;
    while (true) {
        const auto& cells = rows.next();
        if (cells.empty()) break;
        if (cells.size() != columns + 1)
            lines.fail(std::to_string(cells.size() - 1) + " intensities under " + std::to_string(columns) +
                       " horizontal angles");
        made.vertical.push_back(rows.number(0, "a vertical angle"));
        if (made.vertical.size() > kMaxAngles || made.vertical.size() * columns > kMaxCells)
            lines.fail("more rows than are read");
        for (size_t i = 1; i < cells.size(); ++i) by_row.push_back(rows.number(i, "an intensity in cd"));
    }
    made.candela.resize(by_row.size());
    for (size_t v = 0; v < made.vertical.size(); ++v)
        for (size_t h = 0; h < columns; ++h) made.candela[h * made.vertical.size() + v] = by_row[v * columns + h];
    turn_round(made);
    return places;
}

std::vector<double> distinct(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    return values;
}

/// Rows of two angles and an intensity.
Places read_list(Distribution& made, Rows& rows, const ListColumns& columns_at, const LineReader& lines) {
    struct Sample {
        double horizontal, vertical, candela;
        size_t line;
    };
    const size_t first = lines.line() + 1;
    std::vector<Sample> samples;
    while (true) {
        const auto& cells = rows.next();
        if (cells.empty()) break;
        if (cells.size() != 3) lines.fail("has " + std::to_string(cells.size()) + " cells: 3 are expected");
        if (samples.size() == kMaxCells) lines.fail("more rows than are read");
        samples.push_back({rows.number(columns_at.horizontal, "a horizontal angle"),
                           rows.number(columns_at.vertical, "a vertical angle"),
                           rows.number(columns_at.candela, "an intensity in cd"), lines.line()});
    }
    for (const Sample& sample : samples) {
        made.horizontal.push_back(sample.horizontal);
        made.vertical.push_back(sample.vertical);
    }
    made.horizontal = distinct(std::move(made.horizontal));
    made.vertical = distinct(std::move(made.vertical));
    const size_t columns = made.horizontal.size(), height = made.vertical.size();
    const std::string reason = objection_to_size(static_cast<double>(columns), static_cast<double>(height));
    if (!reason.empty()) lines.fail_at(first, reason);
    if (samples.size() < columns * height)
        lines.fail_at(first, std::to_string(columns) + " horizontal and " + std::to_string(height) +
                                 " vertical angles, but only " + std::to_string(samples.size()) +
                                 " intensities: the grid has holes");
    made.candela.assign(columns * height, NAN);
    const auto index = [](const std::vector<double>& angles, double angle) {
        return static_cast<size_t>(std::lower_bound(angles.begin(), angles.end(), angle) - angles.begin());
    };
    for (const Sample& sample : samples) {
        double& cell =
            made.candela[index(made.horizontal, sample.horizontal) * height + index(made.vertical, sample.vertical)];
        if (!std::isnan(cell)) lines.fail_at(sample.line, "this pair of angles was there before");
        cell = sample.candela;
    }
    return {first, first, first};
}

}  // namespace

Distribution parse_grid_csv(std::span<const uint8_t> text, const std::string& name) {
    LineReader lines(text, name);
    Rows rows(lines);
    Distribution made;
    const std::vector<std::string_view> header = rows.next();
    if (header.size() < 2) lines.fail("no row of horizontal angles");
    if (names_tan_gamma(header[0])) lines.fail("the corner cell is tan gamma: this is an r-table, not a lamp");
    const auto stated = goniometry_of(header[0]);
    if (!stated) lines.fail("the corner cell holds a number: nothing, or A, B or C is expected");
    Places places;
    if (header.size() == 3 && !number_of(header[1]) && !number_of(header[2])) {
        const ListColumns columns = list_columns_of(header, lines);
        made.goniometry = columns.goniometry;
        places = read_list(made, rows, columns, lines);
    } else {
        for (const std::string& word : words_of(header[0]))
            for (const char* unit : {"lx", "lux", "lm", "klm", "kcd", "mcd"})
                if (word == unit) lines.fail("the corner cell names " + quoted(unit) + ": intensities are read in cd");
        if (names_rows_horizontal(header[0]))
            lines.fail("the corner cell " + quoted(header[0]) +
                       " says that each row has one horizontal angle: rows of V or gamma are expected");
        made.goniometry = *stated;
        places = read_matrix(made, rows, header, lines);
    }
    if (rows.goniometry()) made.goniometry = *rows.goniometry();
    finish_table(made, false, [&](TablePart part, const std::string& fault) {
        lines.fail_at(part == TablePart::Horizontal ? places.horizontal
                      : part == TablePart::Vertical ? places.vertical
                                                    : places.candela,
                      fault);
    });
    return made;
}

Distribution read_grid_csv(const std::filesystem::path& file) {
    Distribution made = parse_grid_csv(io::read_file(file, kMaxTableBytes), file.string());
    made.name = readable(file.stem().string());
    return made;
}

Distribution read_grid_exr(const std::filesystem::path& file) {
    Distribution made = parse_grid_exr(io::read_file(file, kMaxTableBytes), file.string());
    made.name = readable(file.stem().string());
    return made;
}

}  // namespace vesper::photometry
