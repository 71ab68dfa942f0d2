#include "session/settings.h"

#include <cmath>
#include <cstdlib>
#include <memory>
#include <set>

#include "arguments/arguments.h"
#include "arguments/setting_arguments.h"
#include "arguments/tone_arguments.h"
#include "base/angle.h"
#include "base/error.h"
#include "base/one_line.h"

namespace vesper::drive {
namespace {

constexpr const char* kLamp = "lamp:";
const std::map<std::string, CameraKind> kCameras{{"driver", CameraKind::Driver},
                                                 {"chase", CameraKind::Chase},
                                                 {"bird", CameraKind::Bird},
                                                 {"free", CameraKind::Free}};

struct SettingsArguments {
    apps::ToneArguments tone;
    std::string camera = "driver";
    std::vector<double> free{0, 2, 0, 0, 0};
    double sun = 0, fov = 0;
    apps::SettingArguments light;
};

void add(apps::Command command, SettingsArguments& a) {
    apps::add_tone_options(command, a.tone);
    command.add_option("--camera", a.camera, "Camera: driver, chase (behind the car), bird (from above) or free")
        .check(apps::one_of({"driver", "chase", "bird", "free"}))
        .shows_default();
    command.help_group("Cameras and lamps");
    command.add_option("--free", a.free, "Where the free camera stands and looks: X,Y,Z,YAW,PITCH, m and degrees")
        .separated_by(',')
        .values(5);
    command.add_option("--fov", a.fov, "Angle of the picture's height, degrees (default: the camera's)")
        .check(apps::between(0.0, 170.0));
    command.help_group();
    command
        .add_option("--sun", a.sun,
                    "Elevation of the sun under a closed cover of cloud, degrees\nDefault: the night of the scene")
        .check(apps::between(-90.0, 90.0));
    apps::add_quality_option(command, a.light);
    apps::add_setting_options(command, a.light, {"display_average", "scale"});  // scale: fixed when a drive begins
}

// Names of all settings but lamps, without dashes.
const std::set<std::string>& setting_names() {
    static const std::set<std::string> names = [] {
        apps::Program known;
        SettingsArguments a;
        add(known, a);
        std::set<std::string> found;
        for (const apps::Option& option : known.options()) found.insert(option.name().substr(2));
        return found;
    }();
    return names;
}

void require_known(const std::string& name) {
    if (!name.starts_with(kLamp) && !setting_names().contains(name))
        throw Error("there is no setting " + one_line(name));
}

FreeCamera free_camera_of(const std::vector<double>& v) {
    constexpr double kFar = 1e6;  // m
    for (const double value : v)
        if (!(std::abs(value) <= kFar))
            throw Error("setting free: X,Y,Z,YAW,PITCH are expected within 1e6 m and degrees");
    if (std::abs(v[4]) > 90) throw Error("setting free: PITCH is expected from -90 to 90 degrees");
    return {{v[0], v[1], v[2]}, std::remainder(v[3], 360) * kRadiansPerDegree, v[4] * kRadiansPerDegree};
}

}  // namespace

DriveSettings::DriveSettings(const Values& values, render::Quality otherwise) : otherwise_(otherwise) {
    apply(values);
    values_ = values;
}

void DriveSettings::set(const std::string& name, const std::string& value) {
    require_known(name);
    Values values = values_;
    if (value.empty())
        values.erase(name);
    else
        values[name] = value;
    apply(values);
    values_ = std::move(values);
}

void DriveSettings::apply(const Values& values) {
    apps::Program command;
    SettingsArguments a;
    a.light.quality = render::kQualityNames[size_t(otherwise_)];
    add(command, a);
    std::vector<std::string> words;
    std::map<std::string, double> lamps;
    for (const auto& [name, value] : values) {
        require_known(name);
        if (!name.starts_with(kLamp)) {
            words.push_back("--" + name + "=" + value);
            continue;
        }
        char* end = nullptr;
        const double factor = std::strtod(value.c_str(), &end);
        if (*end || end == value.c_str() || !(factor >= 0 && factor <= 1000))
            throw Error("setting " + one_line(name) + ": a factor from 0 to 1000 is expected, not " + one_line(value));
        lamps[name.substr(std::string(kLamp).size())] = factor;
    }
    try {
        command.parse(words);
    } catch (const Error& error) {
        throw Error(std::string("settings: ") + error.what());
    }
    render::RenderSettings render;
    static_cast<render::ToneChainSettings&>(render) = apps::tone_settings(a.tone);
    apps::apply_settings(a.light, render);
    const FreeCamera free = free_camera_of(a.free);
    render_ = std::move(render);
    sun_ = command.count("--sun") ? std::optional(a.sun) : std::nullopt;
    camera_ = kCameras.at(a.camera);
    free_ = free;
    fov_ = a.fov;
    quality_ = a.light.quality;
    lamps_ = std::move(lamps);
}

bool DriveSettings::knows(const std::string& name) { return setting_names().contains(name); }

void DriveSettings::add_options(apps::Command command) {
    const auto a = std::make_shared<SettingsArguments>();
    add(command, *a);
    command.help_group("Cameras and lamps");
    command.add_option("--lamp", "NAME=FACTOR on the intensity of lamps of that name; may be given several times")
        .repeats();
    command.help_group();
    command.keep(a);
}

DriveSettings::Values DriveSettings::given(const apps::Command& command) {
    Values values;
    for (const std::string& name : setting_names()) {
        if (!command.count("--" + name)) continue;
        std::string text;
        for (const std::string& result : command.option("--" + name).results())
            text += (text.empty() ? "" : ",") + result;
        values[name] = text;
    }
    for (const std::string& lamp : command.option("--lamp").results()) {
        const size_t equals = lamp.rfind('=');
        if (equals == lamp.npos) throw Error("--lamp " + one_line(lamp) + ": NAME=FACTOR is expected");
        values[kLamp + lamp.substr(0, equals)] = lamp.substr(equals + 1);
    }
    return values;
}

}  // namespace vesper::drive
