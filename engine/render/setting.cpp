#include "render/setting.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <optional>

#include "base/error.h"
#include "base/one_line.h"

namespace vesper::render {
namespace {

template <class T>
std::string shortest(T value) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

// All of a text as a number, or nothing.
template <class T>
std::optional<T> number(std::string_view text) {
    T value{};
    const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), value);
    return failed == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

[[noreturn]] void refuse(const Setting& row, const std::string& value) {
    throw Error(row.option() + " " + value + ": " + row.range() + " is expected");
}

}  // namespace

Quality quality_named(std::string_view name) {
    const auto found = std::ranges::find(kQualityNames, name);
    if (found != kQualityNames.end()) return Quality(found - kQualityNames.begin());
    std::string names;
    for (const std::string_view known : kQualityNames) names += (names.empty() ? "" : ", ") + std::string(known);
    const std::string now = name == "draft" ? " any more, it is fast now" : "";
    throw Error("there is no quality " + one_line(std::string(name), 40) + now + ": " + names + " are known");
}

std::string Setting::option() const {
    std::string made(name);
    std::ranges::replace(made, '_', '-');
    return made;
}

bool Setting::differs() const { return std::ranges::adjacent_find(values, std::not_equal_to()) != values.end(); }

double Setting::rounded(double value) const { return kind == SettingKind::Float ? double(float(value)) : value; }

bool Setting::accepts(double value) const {
    const bool whole = kind != SettingKind::Float && kind != SettingKind::Double;
    return rounded(value) >= rounded(low) && rounded(value) <= rounded(high) && (!whole || value == std::floor(value));
}

std::string Setting::range() const {
    if (kind == SettingKind::Switch) return "on or off";
    if (kind == SettingKind::Choice) {
        std::string names;
        for (const std::string_view choice : choices) names += (names.empty() ? "" : ", ") + std::string(choice);
        return "one of " + names;
    }
    const std::string of = unit.empty() ? "" : " " + std::string(unit);
    const std::string numbers = kind == SettingKind::Count ? "a whole number" : "a number";
    return numbers + " from " + shortest(low) + " to " + shortest(high) + of;
}

std::string Setting::text(double value) const {
    switch (kind) {
        case SettingKind::Switch:
            return value != 0 ? "on" : "off";
        case SettingKind::Count:
            return shortest(uint64_t(value));
        case SettingKind::Choice:
            return std::string(choices[size_t(value)]);
        case SettingKind::Float:
            return shortest(float(value));
        case SettingKind::Double:
            break;
    }
    return shortest(value);
}

double Setting::parse(std::string_view given) const {
    if (kind == SettingKind::Switch) {
        if (given == "on" || given == "off") return given == "on";
    } else if (kind == SettingKind::Choice) {
        const auto found = std::ranges::find(choices, given);
        if (found != choices.end()) return double(found - choices.begin());
    } else {
        const std::optional<double> value =
            kind == SettingKind::Count ? std::optional<double>(number<uint64_t>(given)) : number<double>(given);
        if (value && std::isfinite(*value) && accepts(*value)) return rounded(*value);
    }
    refuse(*this, given.empty() ? "''" : one_line(std::string(given), 40));
}

double Setting::checked(double value) const {
    if (!accepts(value)) refuse(*this, shortest(value));
    return rounded(value) + 0.0;  // no -0
}

std::string member_name(std::string_view name) {
    std::string made(name);
    std::ranges::replace(made, '-', '_');
    return made;
}

void throw_no_setting(std::string_view name) { throw Error("there is no setting " + one_line(std::string(name), 40)); }

}  // namespace vesper::render
