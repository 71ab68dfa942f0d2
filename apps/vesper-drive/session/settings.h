// Everything that can change while a drive runs, by name. SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>

#include "arguments/command_line.h"
#include "arguments/setting_arguments.h"

#include "render/renderer.h"

namespace vesper::drive {

enum class CameraKind : uint8_t { Driver, Chase, Bird, Free };

/// A free camera: where it stands (scene, m) and looks (rad; yaw as of vehicles, pitch up).
struct FreeCamera {
    glm::dvec3 position{0, 2, 0};
    double yaw = 0, pitch = 0;
};

/// The settings of a drive are the options of `vesper render` and a few more, as text: one way for the command line,
/// for a recording and for whoever turns a knob. Names are without dashes ("operator", "age", "display-peak");
/// switches are "on" or "off". What is not set has its default. Lamps by name: "lamp:street lamp" is a factor on their
/// intensity.
class DriveSettings {
public:
    using Values = std::map<std::string, std::string>;

    /// `otherwise`: the quality where none is set.
    explicit DriveSettings(const Values& values = {}, render::Quality otherwise = render::Quality::Standard);

    /// Sets one; an empty text goes back to the default. Throws Error, and then nothing has changed.
    void set(const std::string& name, const std::string& value);
    const Values& values() const { return values_; }

    // What they mean.
    const render::RenderSettings& render() const { return render_; }
    /// "sun": elevation of the sun, degrees; none: the light of the sky is what the scene says (night).
    std::optional<double> sun() const { return sun_; }
    /// "camera": driver, chase, bird or free.
    CameraKind camera() const { return camera_; }
    /// "free": X,Y,Z,YAW,PITCH, m and degrees.
    const FreeCamera& free_camera() const { return free_; }
    /// "fov": of the picture's height, degrees; 0: the camera's own.
    double vertical_fov() const { return fov_; }
    const std::map<std::string, double>& lamps() const { return lamps_; }
    /// "quality": the set of values of all settings of light.
    const std::string& quality() const { return quality_; }

    /// Whether there is a setting of this name, lamps not counted.
    static bool knows(const std::string& name);
    /// Adds them all as options to a command, and takes over those that were given.
    static void add_options(apps::Command);
    static Values given(const apps::Command&);

private:
    void apply(const Values&);

    Values values_;
    render::RenderSettings render_;
    std::optional<double> sun_;
    CameraKind camera_ = CameraKind::Driver;
    FreeCamera free_;
    double fov_ = 0;
    render::Quality otherwise_;
    std::string quality_;
    std::map<std::string, double> lamps_;
};

}  // namespace vesper::drive
