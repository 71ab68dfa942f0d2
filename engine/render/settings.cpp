#include "render/settings.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

#include "base/error.h"
#include "base/one_line.h"
#include "render/passes/samples.h"

namespace vesper::render {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

template <class T>
constexpr SettingKind kind_of() {
    if constexpr (std::is_same_v<T, bool>) return SettingKind::Switch;
    if constexpr (std::is_same_v<T, float>) return SettingKind::Float;
    if constexpr (std::is_same_v<T, double>) return SettingKind::Double;
    return SettingKind::Count;
}

template <class T>
constexpr double number_of(T value) {
    if constexpr (std::is_same_v<T, uint64_t>)
        if (value == kUnlimited) return kInfinite;
    return double(value);
}

template <class T>
T value_of(double number) {
    if constexpr (std::is_same_v<T, bool>) return number != 0;
    if constexpr (std::is_same_v<T, uint64_t>) return number < 0x1p63 ? T(number) : kUnlimited;
    return T(number);
}

#define VESPER_ROW(type, name, unit, low, high, draft, standard, exact, help)            \
    Setting{#name,                                                                       \
            unit,                                                                        \
            help,                                                                        \
            kind_of<type>(),                                                             \
            number_of(low),                                                              \
            number_of(high),                                                             \
            {number_of(type(draft)), number_of(type(standard)), number_of(type(exact))}, \
            [](const RenderSettings& from) { return number_of(from.name); },             \
            [](RenderSettings& to, double number) { to.name = value_of<type>(number); }},
constexpr Setting kSettings[]{VESPER_LIGHT_SETTINGS(VESPER_ROW)};
#undef VESPER_ROW

constexpr bool most_samples_agree() {
    for (const Setting& row : kSettings)
        if (row.name == "samples") return row.high == kMostSamples;
    return false;
}
static_assert(most_samples_agree());

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
    throw Error("there is no quality " + one_line(std::string(name), 40) + ": " + names + " are known");
}

std::string Setting::option() const {
    std::string made(name);
    std::ranges::replace(made, '_', '-');
    return made;
}

bool Setting::differs() const { return values[0] != values[1] || values[1] != values[2]; }

double Setting::rounded(double value) const { return kind == SettingKind::Float ? double(float(value)) : value; }

bool Setting::accepts(double value) const {
    const bool whole = kind == SettingKind::Switch || kind == SettingKind::Count;
    return rounded(value) >= rounded(low) && rounded(value) <= rounded(high) &&
           (!whole || std::isinf(value) || value == std::floor(value));
}

std::string Setting::range() const {
    if (kind == SettingKind::Switch) return "on or off";
    const std::string of = unit.empty() ? "" : " " + std::string(unit);
    const std::string numbers = kind == SettingKind::Count ? "a whole number" : "a number";
    return numbers + " from " + shortest(low) + (std::isinf(high) ? of + " on, or all" : " to " + shortest(high) + of);
}

std::string Setting::text(double value) const {
    switch (kind) {
        case SettingKind::Switch:
            return value != 0 ? "on" : "off";
        case SettingKind::Count:
            return std::isinf(value) ? "all" : shortest(uint64_t(value));
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
    } else if (std::isinf(high) && given == "all") {
        return high;
    } else {
        const std::optional<double> value =
            kind == SettingKind::Count ? std::optional<double>(number<uint64_t>(given)) : number<double>(given);
        if (value && std::isfinite(*value) && accepts(*value)) return rounded(*value);
    }
    refuse(*this, given.empty() ? "''" : one_line(std::string(given), 40));
}

std::span<const Setting> settings() { return kSettings; }

const Setting& setting(std::string_view name) {
    std::string member(name);
    std::ranges::replace(member, '-', '_');
    for (const Setting& row : kSettings)
        if (row.name == member) return row;
    throw Error("there is no setting " + one_line(std::string(name), 40));
}

void ChosenSettings::set(std::string_view name, double value) {
    const Setting& row = setting(name);
    if (!row.accepts(value)) refuse(row, shortest(value));
    chosen_[&row] = row.rounded(value);
}

void ChosenSettings::set(std::string_view name, std::string_view text) {
    const Setting& row = setting(name);
    chosen_[&row] = row.parse(text);
}

void ChosenSettings::unset(std::string_view name) { chosen_.erase(&setting(name)); }

double ChosenSettings::get(std::string_view name) const {
    const Setting& row = setting(name);
    const auto found = chosen_.find(&row);
    return found == chosen_.end() ? row.value(quality) : found->second;
}

bool ChosenSettings::is_chosen(std::string_view name) const { return chosen_.contains(&setting(name)); }

void ChosenSettings::apply(RenderSettings& to) const {
    for (const Setting& row : kSettings) row.set(to, row.value(quality));
    for (const auto& [row, value] : chosen_) row->set(to, value);
}

RenderSettings settings_of(Quality quality) {
    RenderSettings made;
    ChosenSettings chosen;
    chosen.quality = quality;
    chosen.apply(made);
    return made;
}

}  // namespace vesper::render
