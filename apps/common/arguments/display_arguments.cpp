#include "arguments/display_arguments.h"

#include "base/error.h"
#include "scene/display_file.h"

namespace vesper::apps {

void add_display_options(Command command, DisplayArguments& a) {
    command.add_option("--display", a.display,
                       "NAME (" + vision::known_display_names() +
                           ") or PROFILE.json (docs/display.md); default: " + vision::known_displays().front().name);
    command.help_group("Display");
    command.add_option("--display-peak", a.peak, "Display: luminance of white in the dark, cd/m^2")
        .check(between(0.1, 1e5));
    command.add_option("--display-black", a.black, "Display: luminance of black in the dark, cd/m^2")
        .check(between(1e-6, 1e3));
    command.add_option("--display-gamma", a.gamma, "Display: exponent").check(between(0.5, 5.0));
    command.add_option("--display-ambient", a.ambient, "Display: illuminance on the screen, lx")
        .check(between(0.0, 1e5));
    command.add_option("--display-reflection", a.reflection, "Display: diffuse reflectance").check(between(0.0, 1.0));
    command.help_group();
}

bool is_given(const DisplayArguments& a) {
    return !a.display.empty() || a.peak || a.black || a.gamma || a.ambient || a.reflection;
}

vision::Display display_of(const DisplayArguments& arguments) {
    vision::Display display =
        arguments.display.empty() ? vision::known_displays().front().display : scene::find_display(arguments.display);
    const bool table = display.eotf == vision::Eotf::Table;
    if (table && (arguments.peak || arguments.black))
        throw Error("--display " + arguments.display +
                    ": --display-peak and --display-black cannot change a measured table");
    if (display.eotf != vision::Eotf::Gamma && arguments.gamma)
        throw Error("--display " + arguments.display + ": --display-gamma: the display has no gamma");
    display.peak = arguments.peak.value_or(display.peak);
    display.black = arguments.black.value_or(display.black);
    display.gamma = arguments.gamma.value_or(display.gamma);
    display.ambient = arguments.ambient.value_or(display.ambient);
    display.reflection = arguments.reflection.value_or(display.reflection);
    vision::check_display(display);
    return display;
}

}  // namespace vesper::apps
