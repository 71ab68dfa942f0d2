// r-tables from text, and the standard ones that are built in. SPDX-License-Identifier: MIT
#include <algorithm>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/lower.h"
#include "base/one_line.h"
#include "io/read_file.h"
#include "photometry/reflection_table.h"
#include "photometry/reflection_table_rtb.h"
#include "photometry/table.h"

namespace vesper::photometry {
namespace {

constexpr uint64_t kMaxBytes = 4u << 20;
constexpr size_t kMaxFields = 513;

/// Name and text of each file of data/road/ that is built in.
constexpr std::pair<std::string_view, std::string_view> kStandard[] = {
#include <road/tables.inc>
};

double value_of(const LineReader& lines, std::string_view field) {
    const auto value = number_of(field);
    if (!value || !(*value >= 0 && *value <= 1e9)) lines.fail(quoted(field) + " is not a number from 0 to 1e9");
    return *value;
}

void read_row(ReflectionTable& table, const LineReader& lines, std::string_view text) {
    const auto fields = fields_of(text, ',', kMaxFields);
    if (fields.size() > kMaxFields) lines.fail("has more than 512 values");
    if (table.beta.empty()) {
        for (size_t i = 1; i < fields.size(); ++i) table.beta.push_back(value_of(lines, fields[i]));
        if (table.beta.empty()) lines.fail("is not a row of beta, separated by commas");
        if (!fields[0].empty() && lower(fields[0]) != "t" && !names_tan_gamma(fields[0]))
            lines.fail("begins with " + quoted(fields[0]) +
                       ": rows of tan gamma, under 'tan_gamma' and a row of beta in degrees, are expected");
        return;
    }
    if (fields.size() != table.beta.size() + 1)
        lines.fail("has " + std::to_string(fields.size()) + " fields, " + std::to_string(table.beta.size() + 1) +
                   " are wanted");
    if (table.tan_gamma.size() == kMaxFields) lines.fail("is one row too many: at most 512 tan gamma are read");
    table.tan_gamma.push_back(value_of(lines, fields[0]));
    for (size_t i = 1; i < fields.size(); ++i)
        table.r.push_back(fields[i].empty() ? 0 : value_of(lines, fields[i]) * 1e-4);
}

ReflectionTable parse(std::string_view text, const std::string& name) {
    ReflectionTable table{.name = name};
    LineReader lines({reinterpret_cast<const uint8_t*>(text.data()), text.size()}, name);
    while (const auto next = lines.next()) {
        const std::string_view line = trimmed(*next);
        if (line.starts_with('#')) {
            const std::string_view comment = trimmed(line.substr(1));
            const std::string_view stated = comment.substr(std::min<size_t>(2, comment.size()));
            if (lower(comment.substr(0, 2)) == "q0" && !stated.empty() && stated.find_first_of(" \t:=") == 0) {
                const std::string_view value =
                    stated.substr(std::min(stated.find_first_not_of(" \t:="), stated.size()));
                if (value.find(' ') == value.npos)
                    table.stated_q0 = value_of(lines, value);  // else a sentence about it
            }
            if (lower(comment) == "wet") table.wet = true;
        } else if (!line.empty()) {
            read_row(table, lines, line);
        }
    }
    return table;
}

// The table, if it can be one.
ReflectionTable checked(ReflectionTable table, const std::string& name) {
    check_reflection_table(table, name);
    if (*std::max_element(table.r.begin(), table.r.end()) < 1e-4)
        throw Error(name + ": no value reaches 1: r times 10^4, in sr^-1, is expected");
    return table;
}

}  // namespace

bool is_reflection_table(std::span<const uint8_t> text) {
    if (is_rtb(text)) return true;
    LineReader lines(text, {});
    while (const auto next = lines.next()) {
        const std::string_view line = trimmed(*next);
        if (!line.empty() && !line.starts_with('#')) return names_tan_gamma(fields_of(line, ',', 1).front());
    }
    return false;
}

ReflectionTable parse_reflection_table(std::span<const uint8_t> text, const std::string& name) {
    const std::string place = one_line(name);
    if (is_rtb(text)) return checked(parse_rtb(text, place), place);
    return checked(parse({reinterpret_cast<const char*>(text.data()), text.size()}, place), place);
}

ReflectionTable read_reflection_table(const std::filesystem::path& file) {
    ReflectionTable table = parse_reflection_table(io::read_file(file, kMaxBytes), file.string());
    table.name = one_line(file.stem().string());
    return table;
}

std::vector<std::string> standard_reflection_tables() {
    std::vector<std::string> names;
    for (const auto& [name, text] : kStandard) names.emplace_back(name);
    return names;
}

ReflectionTable find_reflection_table(const std::string& name_or_file, const std::filesystem::path& folder) {
    for (const auto& [name, text] : kStandard)
        if (name == name_or_file) return checked(parse(text, std::string(name)), std::string(name));
    const std::filesystem::path file = folder / name_or_file;
    if (file.extension().empty() && !std::filesystem::exists(file)) {
        std::string known;
        for (const auto& [name, text] : kStandard) known += (known.empty() ? "" : ", ") + std::string(name);
        throw Error("'" + one_line(name_or_file) + "': is neither a file nor one of the reflection tables " + known);
    }
    return read_reflection_table(file);
}

}  // namespace vesper::photometry
