// Settings of light by their names. SPDX-License-Identifier: MIT
#include "api/handles.h"

namespace vesper::api {
namespace {

// The caller has the pixels of its pictures.
bool is_of_renderers(const render::Setting& row) { return row.name != "scale"; }

struct NamedRow {
    const render::Setting* row;
    std::string option, unit, help;  // zero-terminated
};
const std::vector<NamedRow>& rows() {
    static const std::vector<NamedRow> kRows = [] {
        std::vector<NamedRow> list;
        for (const render::LightSetting& row : render::light_rows())
            if (is_of_renderers(row))
                list.push_back({&row, row.option(), std::string(row.unit), std::string(row.help)});
        return list;
    }();
    return kRows;
}

uint32_t kind_of(render::SettingKind kind) {
    switch (kind) {
        case render::SettingKind::Switch:
            return VESPER_SETTING_SWITCH;
        case render::SettingKind::Count:
            return VESPER_SETTING_COUNT;
        case render::SettingKind::Choice:
        case render::SettingKind::Float:
        case render::SettingKind::Double:
            break;
    }
    return VESPER_SETTING_NUMBER;
}

// A name or value that the table refuses is a mistake of the caller.
template <class Call>
VesperResult by_name(const VesperRenderer* renderer, const char* name, VesperError* error, const Call& call) {
    return guarded(error, [&] {
        require(renderer, VesperRenderer::kNone);
        require(name, "the name is null");
        accepted(call);
    });
}

const char* checked(const char* name) {
    if (!is_of_renderers(render::light_row(name))) throw Error("a renderer has no setting " + std::string(name));
    return name;
}

}  // namespace

extern "C" {

uint32_t vesper_setting_count(void) { return uint32_t(rows().size()); }

VesperResult vesper_setting_at(uint32_t index, VesperSetting* setting, VesperError* error) {
    return guarded(error, [&] {
        require(setting && setting->size >= kFirstSize<VesperSetting>, "no setting, or one without its size");
        require(index < rows().size(), "there is no setting of this index");
        const NamedRow& named = rows()[index];
        const render::Setting& row = *named.row;
        give_known(VesperSetting{.size = 0,
                                 .kind = kind_of(row.kind),
                                 .name = named.option.c_str(),
                                 .unit = named.unit.c_str(),
                                 .help = named.help.c_str(),
                                 .low = row.low,
                                 .high = row.high,
                                 .fast = row.value(render::Quality::Fast),
                                 .standard = row.value(render::Quality::Standard),
                                 .exact = row.value(render::Quality::Exact),
                                 .interactive = row.value(render::Quality::Interactive)},
                   setting);
    });
}

VesperResult vesper_set(VesperRenderer* renderer, const char* name, double value, VesperError* error) {
    return by_name(renderer, name, error, [&] { renderer->chosen.set(checked(name), value); });
}

VesperResult vesper_unset(VesperRenderer* renderer, const char* name, VesperError* error) {
    return by_name(renderer, name, error, [&] { renderer->chosen.unset(checked(name)); });
}

VesperResult vesper_get(const VesperRenderer* renderer, const char* name, double* value, VesperError* error) {
    return by_name(renderer, name, error, [&] {
        require(value, "the pointer to the value is null");
        *value = renderer->chosen.get(checked(name));
    });
}

VesperResult vesper_set_quality(VesperRenderer* renderer, const char* quality, VesperError* error) {
    return by_name(renderer, quality, error, [&] { renderer->chosen.quality = render::quality_named(quality); });
}

}  // extern "C"

}  // namespace vesper::api
