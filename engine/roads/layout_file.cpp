#include "roads/layout_file.h"

#include <algorithm>
#include <array>

#include "base/error.h"
#include "base/one_line.h"
#include "io/named_file.h"
#include "io/read_file.h"
#include "roads/occluders.h"
#include "scene/json_value.h"
#include "scene/reflection_json.h"

namespace vesper::roads {
namespace {

using scene::JsonValue;

constexpr uint64_t kMaxLayoutBytes = 1u << 20;

constexpr std::array<std::pair<const char*, Arrangement>, 6> kArrangements{{{"right", Arrangement::Right},
                                                                            {"left", Arrangement::Left},
                                                                            {"opposite", Arrangement::Opposite},
                                                                            {"staggered", Arrangement::Staggered},
                                                                            {"central", Arrangement::Central},
                                                                            {"list", Arrangement::List}}};

bool is_one_of(const JsonValue& value, const char* yes, const char* no) {
    if (value.text() == yes) return true;
    if (value.text() != no) value.fail(std::string("is neither ") + no + " nor " + yes);
    return false;
}

void read_carriageway(RoadLayout& layout, const JsonValue& source) {
    source.allow_only({"width_m", "lanes", "traffic"});
    layout.width = source.at("width_m").number(1, 100);
    layout.lanes = static_cast<int>(source.at("lanes").integer(12));
    if (layout.lanes < 1) source.at("lanes").fail("must be at least 1");
    if (const auto traffic = source.find("traffic")) layout.left_hand_traffic = is_one_of(*traffic, "left", "right");
}

Arrangement read_arrangement(const JsonValue& value) {
    for (const auto& [name, arrangement] : kArrangements)
        if (value.text() == name) return arrangement;
    value.fail("is none of right, left, opposite, staggered, central and list");
}

LuminaireMount read_mount(const JsonValue& source, const RoadLayout& layout) {
    source.allow_only({"x_m", "y_m", "height_m", "facing_deg"});
    LuminaireMount mount;
    mount.position = {source.number_or("x_m", 0, -1000, 1000), source.at("y_m").number(-200, 200),
                      source.number_or("height_m", layout.height, 2, 40)};
    mount.facing_deg = source.number_or("facing_deg", mount.position.y > layout.width / 2 ? -90 : 90, -360, 360);
    return mount;
}

void read_positions(RoadLayout& layout, const JsonValue& source) {
    const auto refuse = [&](const char* key, const char* reason) {
        if (const auto value = source.find(key)) value->fail(reason);
    };
    if (layout.arrangement == Arrangement::List) {
        refuse("overhang_m", "has no meaning beside a list of positions");
        const JsonValue positions = source.at("positions");
        for (const JsonValue& position : positions.elements()) layout.mounts.push_back(read_mount(position, layout));
        if (layout.mounts.empty() || layout.mounts.size() > 32) positions.fail("must have 1 to 32 elements");
    } else {
        refuse("positions", "has a meaning only in the arrangement list");
        layout.overhang = source.number_or("overhang_m", 0, -50, 50);
    }
    if (layout.arrangement != Arrangement::Central)
        refuse("reservation_m", "has a meaning only in the arrangement central");
    layout.reservation = source.number_or("reservation_m", 0, 0, 100);
}

photometry::Distribution read_luminaire(const std::filesystem::path& file) {
    photometry::Distribution distribution = photometry::read_distribution(file);
    if (!(photometry::largest_intensity(distribution) > 0))
        throw Error(one_line(file.string()) + ": the luminaire gives no light");
    return distribution;
}

void read_luminaires(LoadedLayout& layout, const JsonValue& source, const std::filesystem::path& folder,
                     const LayoutOverrides& overrides) {
    source.allow_only({"file", "c0", "flux_factor", "maintenance_factor", "colour_temperature_K", "arrangement",
                       "spacing_m", "height_m", "overhang_m", "reservation_m", "orientation_deg", "tilt_deg",
                       "roll_deg", "positions"});
    layout.arrangement = read_arrangement(source.at("arrangement"));
    layout.spacing = source.at("spacing_m").number(5, 500);
    layout.height = source.at("height_m").number(2, 40);
    read_positions(layout, source);
    layout.orientation_deg = source.number_or("orientation_deg", 0, -180, 180);
    layout.tilt_deg = source.number_or("tilt_deg", 0, -180, 180);
    layout.roll_deg = source.number_or("roll_deg", 0, -180, 180);
    if (const auto c0 = source.find("c0")) layout.c0_street_side = is_one_of(*c0, "street side", "road");
    layout.flux_factor = source.number_or("flux_factor", 1, 1e-6, 1000);
    layout.maintenance_factor = source.number_or("maintenance_factor", 1, 0.01, 1);
    layout.colour_temperature = source.number_or("colour_temperature_K", 0, 1000, 25000);

    const std::string file = source.at("file").text();
    layout.luminaire =
        overrides.luminaire.empty() ? io::named_file(folder, file) : std::filesystem::path(overrides.luminaire);
    layout.distribution = read_luminaire(layout.luminaire);
}

/// Name of a table as find_reflection_table() takes it without a folder.
std::string located(const std::string& name_or_file, const std::filesystem::path& folder) {
    const std::vector<std::string> standard = photometry::standard_reflection_tables();
    const bool is_standard = std::find(standard.begin(), standard.end(), name_or_file) != standard.end();
    return is_standard ? name_or_file : (folder / name_or_file).string();
}

void read_surface(LoadedLayout& layout, const JsonValue& source, const std::filesystem::path& folder,
                  const LayoutOverrides& overrides) {
    source.allow_only({"reflection_table", "q0"});
    if (overrides.reflection_table.empty()) {
        layout.surface = scene::read_named_table(source, folder);
        layout.reflection_table = located(source.at("reflection_table").text(), folder);
        layout.q0 = source.number_or("q0", 0);
    } else {
        layout.surface = photometry::find_reflection_table(overrides.reflection_table);
        layout.reflection_table = overrides.reflection_table;
    }
    if (!overrides.q0) return;
    layout.surface = photometry::rescaled(layout.surface, *overrides.q0);
    layout.q0 = *overrides.q0;
}

void read_occluders(LoadedLayout& layout, const JsonValue& root, const std::filesystem::path& folder,
                    const LayoutOverrides& overrides) {
    if (const auto file = root.find("occluders")) layout.occluders = io::named_file(folder, file->text());
    if (!overrides.occluders.empty()) layout.occluders = overrides.occluders;
    if (overrides.occlusion && !layout.occluders.empty())
        layout.hiding = std::make_shared<const Occluders>(layout.occluders);
}

}  // namespace

LoadedLayout read_layout(const std::filesystem::path& file, const LayoutOverrides& overrides) {
    const scene::JsonFile json = scene::parse_json(io::read_file(file, kMaxLayoutBytes), file.string());
    const JsonValue root(json);
    root.allow_only(
        {"$schema", "version", "name", "carriageway", "surface", "luminaires", "occluders", "observer_age", "class"});
    const JsonValue version = root.at("version");
    if (version.integer() != 1) version.fail("must be 1: this program knows no other");
    LoadedLayout layout;
    layout.name = one_line(root.text_or("name", file.stem().string()), 100);
    layout.observer_age = root.number_or("observer_age", 23, 1, 120);
    if (const auto wanted = root.find("class")) {
        if (!find_lighting_class(wanted->text())) wanted->fail("is none of M1 to M6");
        layout.wanted_class = wanted->text();
    }
    read_carriageway(layout, root.at("carriageway"));
    read_luminaires(layout, root.at("luminaires"), file.parent_path(), overrides);
    read_surface(layout, root.at("surface"), file.parent_path(), overrides);
    read_occluders(layout, root, file.parent_path(), overrides);
    layout.spacing = overrides.spacing.value_or(layout.spacing);
    layout.height = overrides.height.value_or(layout.height);
    layout.overhang = overrides.overhang.value_or(layout.overhang);
    layout.tilt_deg = overrides.tilt.value_or(layout.tilt_deg);
    layout.maintenance_factor = overrides.maintenance_factor.value_or(layout.maintenance_factor);
    try {
        check_layout(layout);
    } catch (const Error& error) {
        throw Error(one_line(file.string()) + ": " + error.what());
    }
    return layout;
}

LoadedLayout load_layout(const RoadLayout& layout) {
    check_layout(layout);
    LoadedLayout loaded{layout, read_luminaire(layout.luminaire),
                        photometry::find_reflection_table(layout.reflection_table)};
    if (layout.q0 > 0) loaded.surface = photometry::rescaled(loaded.surface, layout.q0);
    if (!layout.occluders.empty()) loaded.hiding = std::make_shared<const Occluders>(layout.occluders);
    return loaded;
}

}  // namespace vesper::roads
