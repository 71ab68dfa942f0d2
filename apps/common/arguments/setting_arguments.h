// The settings of the table (render/settings.h), as commands take them and as files record them.
// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "arguments/command_line.h"

#include "io/image_file.h"
#include "render/settings.h"

namespace vesper::apps {

struct SettingArguments {
    std::string quality = "standard";  ///< of render::kQualityNames
    render::ChosenSettings own;        ///< defaults of the program, which replace values of every set
    std::vector<const render::LightSetting*> rows;
    Command command;
};
/// The option of a row, in its group of --help-all, which shows `value` as the default.
void add_row_option(Command, const render::Setting&, double value);
/// "shadowError", as headers of pictures name a row.
std::string field_of(const render::Setting&);
/// "shadow_error": 0.005, as JSON has it.
std::string json_member(const render::Setting&, double value);
void add_quality_option(Command, SettingArguments&);
/// An option for each row but those named, in the group "Light" of --help-all. An option wins over the set, in any
/// order.
void add_setting_options(Command, SettingArguments&, std::initializer_list<std::string_view> without);
/// The option of one row, for programs that hold the value themselves.
void add_setting_option(Command, std::string_view name, double& value);
/// The set, the defaults of the program, and the options that were given.
render::ChosenSettings chosen_settings(const SettingArguments&);
/// Writes them to settings. Throws Error where they contradict each other.
void apply_settings(const SettingArguments&, render::RenderSettings&);

/// The set and the values of all rows, as files record them.
struct RecordedSettings {
    std::string quality = "standard";
    std::vector<double> values;  ///< by render::light_rows()

    double& value(std::string_view name);
    bool same_values(const RecordedSettings& other) const { return values == other.values; }
};
RecordedSettings recorded_settings(const std::string& quality, const render::RenderSettings&);
/// Of the defaults.
RecordedSettings recorded_standard();

/// Members of a JSON object, in a line: "quality": "standard", "shadows": true, …
std::string settings_json(const RecordedSettings&);
/// The set and the values that differ from it: "fast, threshold 0.001 lx, shadows off".
std::string settings_words(const RecordedSettings&);
/// All rows, one a line: "  threshold            0.001 lx".
std::string settings_lines(const RecordedSettings&);
/// Fields of a picture's header: vesper:quality, vesper:shadowError, …
io::Header describe_settings(const RecordedSettings&);

}  // namespace vesper::apps
