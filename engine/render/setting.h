// A row of a table of settings: its name, its range, and its values as text. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace vesper::render {

/// Named sets of values for all settings of light, from the fastest to the most exact.
enum class Quality : uint8_t { Fast, Interactive, Standard, Exact };
constexpr std::array<std::string_view, 4> kQualityNames{"fast", "interactive", "standard", "exact"};
/// Throws Error, which lists the names.
Quality quality_named(std::string_view name);

enum class SettingKind : uint8_t { Switch, Count, Float, Double, Choice };

struct Setting {
    std::string_view name;  ///< "shadow_error"
    std::string_view unit, help;
    std::string_view group;  ///< of options, as --help-all heads them; empty: the first page
    double low = 0, high = 1;
    std::span<const std::string_view> choices{};  ///< of a Choice, whose value is the index of one
    SettingKind kind = SettingKind::Switch;
    std::array<double, kQualityNames.size()> values{};  ///< by Quality; switches are 0 and 1

    double value(Quality quality) const { return values[size_t(quality)]; }
    std::string option() const;      ///< "shadow-error"
    bool differs() const;            ///< among the sets
    bool accepts(double) const;      ///< in range, and whole unless it is a real number
    std::string range() const;       ///< "on or off", "a number from 0.001 to 1000 lx"
    std::string text(double) const;  ///< "on", "4", "0.005": the shortest text that reads back to the same value
    double rounded(double) const;    ///< to a float, if the setting is one
    /// The value of a text. Throws Error that names setting, value, range and unit.
    double parse(std::string_view) const;
    /// Throws the same Error unless the value is accepted. Returns it rounded.
    double checked(double) const;
};

/// A setting of a structure.
template <class Of>
struct SettingOf : Setting {
    std::function<double(const Of&)> get;
    std::function<void(Of&, double)> set;  ///< without a check
};

/// A row of the member that `member` refers to, in `Of` and in `const Of`; its kind is of the member's type, its values
/// are those of a default `Of`.
template <class Of, class Member>
SettingOf<Of> setting_of(Setting row, Member member) {
    using T = std::remove_cvref_t<decltype(member(std::declval<Of&>()))>;
    row.kind = std::is_same_v<T, bool>     ? SettingKind::Switch
               : std::is_same_v<T, float>  ? SettingKind::Float
               : std::is_same_v<T, double> ? SettingKind::Double
                                           : SettingKind::Count;
    const auto get = [member](const Of& from) { return double(member(from)); };
    row.values.fill(get(Of{}));
    return {row, get, [member](Of& to, double number) {
                if constexpr (std::is_same_v<T, bool>)
                    member(to) = number != 0;
                else
                    member(to) = T(number);
            }};
}

/// "shadow_error" of "shadow-error".
std::string member_name(std::string_view name);
[[noreturn]] void throw_no_setting(std::string_view name);
/// The row of a name, with dashes or underscores. Throws Error if there is none.
template <class Row>
const Row& row_named(std::span<const Row> rows, std::string_view name) {
    const std::string member = member_name(name);
    for (const Row& row : rows)
        if (row.name == member) return row;
    throw_no_setting(name);
}

}  // namespace vesper::render
