#include "render/settings.h"

#include <algorithm>

#include "base/error.h"
#include "render/passes/samples.h"

namespace vesper::render {
namespace {

#define VESPER_IS_MOST(type, name, unit, low, high, fast, interactive, standard, exact, help) \
    static_assert(std::string_view(#name) != "samples" || double(high) == kMostSamples);
VESPER_LIGHT_SETTINGS(VESPER_IS_MOST)
#undef VESPER_IS_MOST

template <class Member>
LightSetting row_of_light(const Setting& row, const decltype(Setting::values)& values, Member member) {
    LightSetting made = setting_of<LightSettings>(row, member);
    made.values = values;
    return made;
}

}  // namespace

std::span<const LightSetting> light_rows() {
    static const auto kRows = [] {
        std::vector<LightSetting> rows;
#define VESPER_ROW(type, name, unit, low, high, fast, interactive, standard, exact, help)             \
    rows.push_back(row_of_light(                                                                      \
        {#name, unit, help, "Light", double(low), double(high)},                                      \
        {double(type(fast)), double(type(interactive)), double(type(standard)), double(type(exact))}, \
        [](auto& settings) -> auto& { return settings.name; }));
        VESPER_LIGHT_SETTINGS(VESPER_ROW)
#undef VESPER_ROW
        return rows;
    }();
    return kRows;
}

const LightSetting& light_row(std::string_view name) { return row_named(light_rows(), name); }

void check_light(const LightSettings& settings) {
    if (settings.moving_reflections && !settings.indirect)
        throw Error("--moving-reflections has no meaning with --indirect off");
}

void ChosenSettings::set(std::string_view name, double value) {
    const LightSetting& row = light_row(name);
    chosen_[&row] = row.checked(value);
}

void ChosenSettings::set(std::string_view name, std::string_view text) {
    const LightSetting& row = light_row(name);
    chosen_[&row] = row.parse(text);
}

void ChosenSettings::unset(std::string_view name) { chosen_.erase(&light_row(name)); }

double ChosenSettings::get(std::string_view name) const {
    const LightSetting& row = light_row(name);
    const auto found = chosen_.find(&row);
    return found == chosen_.end() ? row.value(quality) : found->second;
}

bool ChosenSettings::is_chosen(std::string_view name) const { return chosen_.contains(&light_row(name)); }

void ChosenSettings::apply(RenderSettings& to) const {
    for (const LightSetting& row : light_rows()) row.set(to, row.value(quality));
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
