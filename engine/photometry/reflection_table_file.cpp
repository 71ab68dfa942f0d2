// r-tables from text, and the standard ones that are built in. SPDX-License-Identifier: MIT
#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "io/atomic_file.h"
#include "photometry/reflection_table.h"

namespace vesper {
namespace {

constexpr uint64_t kMaxBytes = 4u << 20;
constexpr size_t kMaxFields = 513;

/// Name and text of each file of data/road/ that is built in.
constexpr std::pair<std::string_view, std::string_view> kStandard[] = {
#include <road/tables.inc>
};

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view kBlank = " \t\r\"";
    const size_t first = text.find_first_not_of(kBlank);
    if (first == text.npos) return {};
    return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::vector<std::string_view> fields_of(std::string_view line) {
    std::vector<std::string_view> fields;
    while (fields.size() <= kMaxFields) {
        const size_t comma = line.find(',');
        fields.push_back(trimmed(line.substr(0, comma)));
        if (comma == line.npos) break;
        line.remove_prefix(comma + 1);
    }
    return fields;
}

class TableReader {
public:
    explicit TableReader(const std::string& name) : name_(name) {}

    void line(std::string_view text) {
        ++number_;
        text = trimmed(text);
        if (text.starts_with('#')) {
            const std::string_view comment = trimmed(text.substr(1));
            if (comment.starts_with("Q0 ")) table_.stated_q0 = value_of(trimmed(comment.substr(3)));
        } else if (!text.empty()) {
            row(text);
        }
    }

    ReflectionTable take() {
        table_.name = name_;
        check_reflection_table(table_, name_);
        return std::move(table_);
    }

private:
    void row(std::string_view text) {
        const auto fields = fields_of(text);
        if (fields.size() > kMaxFields) fail("has more than 512 values");
        if (table_.beta.empty()) {
            for (size_t i = 1; i < fields.size(); ++i) table_.beta.push_back(value_of(fields[i]));
            if (table_.beta.empty()) fail("is not a row of beta, separated by commas");
            return;
        }
        if (fields.size() != table_.beta.size() + 1)
            fail("has " + std::to_string(fields.size()) + " fields, " + std::to_string(table_.beta.size() + 1) +
                 " are wanted");
        if (table_.tan_gamma.size() == kMaxFields) fail("is one row too many: at most 512 tan gamma are read");
        table_.tan_gamma.push_back(value_of(fields[0]));
        for (size_t i = 1; i < fields.size(); ++i)
            table_.r.push_back(fields[i].empty() ? 0 : value_of(fields[i]) * 1e-4);
    }

    double value_of(std::string_view field) const {
        double value = 0;
        const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
        if (error != std::errc() || end != field.data() + field.size() || !(value >= 0 && value <= 1e9))
            fail("'" + one_line(std::string(field), 40) + "' is not a number from 0 to 1e9");
        return value;
    }

    [[noreturn]] void fail(const std::string& reason) const {
        throw Error(name_ + ": line " + std::to_string(number_) + ": " + reason);
    }

    std::string name_;
    size_t number_ = 0;
    ReflectionTable table_;
};

ReflectionTable parse(std::string_view text, const std::string& name) {
    TableReader reader(name);
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    while (!text.empty()) {
        const size_t end = std::min(text.find('\n'), text.size());
        reader.line(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return reader.take();
}

}  // namespace

ReflectionTable parse_reflection_table(std::span<const uint8_t> text, const std::string& name) {
    return parse({reinterpret_cast<const char*>(text.data()), text.size()}, one_line(name));
}

ReflectionTable read_reflection_table(const std::filesystem::path& file) {
    ReflectionTable table = parse_reflection_table(read_file(file, kMaxBytes), file.string());
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
        if (name == name_or_file) return parse(text, std::string(name));
    const std::filesystem::path file = folder / name_or_file;
    if (file.extension().empty() && !std::filesystem::exists(file)) {
        std::string known;
        for (const auto& [name, text] : kStandard) known += (known.empty() ? "" : ", ") + std::string(name);
        throw Error("'" + one_line(name_or_file) + "': is neither a file nor one of the reflection tables " + known);
    }
    return read_reflection_table(file);
}

}  // namespace vesper
