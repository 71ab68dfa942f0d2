#include "arguments/setting_arguments.h"

#include <algorithm>
#include <cctype>

#include "arguments/arguments.h"
#include "base/error.h"
#include "print.h"

namespace vesper::apps {
namespace {

using render::LightSetting, render::Setting, render::SettingKind;

std::string option_name(const Setting& row) { return "--" + row.option(); }

Check check_of(const Setting& row) {
    if (row.kind == SettingKind::Switch) return one_of({"on", "off"});
    if (row.kind == SettingKind::Choice)
        return one_of(std::vector<std::string>(row.choices.begin(), row.choices.end()));
    return {[&row](const std::string& given) {
                try {
                    row.parse(given);
                    return std::string();
                } catch (const Error& refused) {
                    return std::string(refused.what()).substr(row.option().size() + 1);  // CLI11 says the name
                }
            },
            row.range()};
}

std::string help_of(const Setting& row) {
    std::string help(row.help);
    if (!row.unit.empty()) help.insert(std::min(help.find(';'), help.size()), ", " + std::string(row.unit));
    return help;
}

std::string default_of(const Setting& row, double value) {
    return row.text(value) + (row.differs() ? ", or as --quality says" : "");
}

std::string words_of(const Setting& row) {
    std::string words(row.name);
    std::ranges::replace(words, '_', ' ');
    return words;
}

std::string with_unit(const Setting& row, double value) {
    return row.text(value) + (row.unit.empty() ? "" : " " + std::string(row.unit));
}

template <class Visit>
void for_each_value(const RecordedSettings& recorded, const Visit& visit) {
    size_t index = 0;
    for (const LightSetting& row : render::light_rows()) visit(row, recorded.values.at(index++));
}

}  // namespace

std::string field_of(const Setting& row) {
    std::string field;
    bool capital = false;
    for (const char c : row.name) {
        if (c != '_') field += capital ? char(std::toupper(c)) : c;
        capital = c == '_';
    }
    return field;
}

std::string json_member(const Setting& row, double value) {
    const std::string text = row.kind == SettingKind::Switch   ? (value != 0 ? "true" : "false")
                             : row.kind == SettingKind::Choice ? "\"" + row.text(value) + "\""
                                                               : row.text(value);
    return "\"" + std::string(row.name) + "\": " + text;
}

void add_row_option(Command command, const Setting& row, double value) {
    if (!row.group.empty()) command.help_group(std::string(row.group));
    const bool is_switch = row.kind == SettingKind::Switch;
    (is_switch ? command.add_switch(option_name(row), help_of(row))
               : command.add_option(option_name(row), help_of(row)).takes(row.choices.empty() ? "NUMBER" : "NAME"))
        .check(check_of(row))
        .shows_default(default_of(row, value));
    command.help_group();
}

void add_quality_option(Command command, SettingArguments& a) {
    command
        .add_option(
            "--quality", a.quality,
            "Of scenes: fast, interactive (a window's), standard, or exact, which leaves nothing out (docs/quality.md)")
        .check({[](const std::string& given) {
                    try {
                        render::quality_named(given);
                        return std::string();
                    } catch (const Error& refused) {
                        return std::string(refused.what());
                    }
                },
                "NAME"})
        .shows_default();
}

void add_setting_options(Command command, SettingArguments& a, std::initializer_list<std::string_view> without) {
    a.command = command;
    for (const LightSetting& row : render::light_rows()) {
        if (std::ranges::find(without, row.name) != without.end()) continue;
        add_row_option(command, row, a.own.get(row.name));
        a.rows.push_back(&row);
    }
}

void add_setting_option(Command command, std::string_view name, double& value) {
    const Setting& row = render::light_row(name);
    command.add_option(option_name(row), value, help_of(row)).check(check_of(row)).shows_default();
}

render::ChosenSettings chosen_settings(const SettingArguments& a) {
    render::ChosenSettings chosen = a.own;
    chosen.quality = render::quality_named(a.quality);
    for (const LightSetting* row : a.rows)
        if (a.command.count(option_name(*row)) > 0)
            chosen.set(row->name, a.command.option(option_name(*row)).results().back());
    return chosen;
}

void apply_settings(const SettingArguments& a, render::RenderSettings& settings) {
    chosen_settings(a).apply(settings);
    render::check_light(settings);
}

double& RecordedSettings::value(std::string_view name) {
    return values.at(size_t(&render::light_row(name) - render::light_rows().data()));
}

RecordedSettings recorded_settings(const std::string& quality, const render::RenderSettings& settings) {
    RecordedSettings recorded{quality, {}};
    for (const LightSetting& row : render::light_rows()) recorded.values.push_back(row.get(settings));
    return recorded;
}

RecordedSettings recorded_standard() { return recorded_settings("standard", {}); }

std::string settings_json(const RecordedSettings& recorded) {
    std::string members = "\"quality\": \"" + recorded.quality + "\"";
    for_each_value(recorded, [&](const Setting& row, double value) { members += ", " + json_member(row, value); });
    return members;
}

std::string settings_words(const RecordedSettings& recorded) {
    std::string words = recorded.quality;
    const render::Quality quality = render::quality_named(recorded.quality);
    for_each_value(recorded, [&](const Setting& row, double value) {
        if (value != row.value(quality)) words += ", " + words_of(row) + " " + with_unit(row, value);
    });
    return words;
}

std::string settings_lines(const RecordedSettings& recorded) {
    std::string lines = "settings of light, quality " + recorded.quality + "\n";
    for_each_value(recorded, [&](const Setting& row, double value) {
        lines += "  " + column(row.option(), 20) + " " + with_unit(row, value) + "\n";
    });
    return lines;
}

io::Header describe_settings(const RecordedSettings& recorded) {
    io::Header header{{"vesper:quality", recorded.quality}};
    for_each_value(recorded, [&](const Setting& row, double value) {
        header.emplace_back("vesper:" + field_of(row), row.text(value));
    });
    return header;
}

}  // namespace vesper::apps
