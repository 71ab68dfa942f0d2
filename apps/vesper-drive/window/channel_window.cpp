#include "window/channel_window.h"

#include "arguments/arguments.h"
#include "arguments/cache_arguments.h"
#include "arguments/picture_arguments.h"
#include "base/error.h"
#include "base/one_line.h"
#include "print.h"
#include "record/drive_log.h"
#include "run/channel_ranks.h"
#include "window/screen.h"

namespace vesper::drive {
namespace {

// Of the size of --window, or over a monitor.
WindowSettings settings_of(const DriveArguments& a, const Channels& channels, const std::vector<size_t>& own) {
    WindowSettings settings{.title = "", .extent = apps::parse_size(a.window, 64), .monitor = {}};
    for (const size_t i : own) settings.title += channels.screens[i].name + (i == own.back() ? " - Vesper" : ", ");
    if (a.full_screen >= 0) settings.monitor = unsigned(a.full_screen);
    return settings;
}

}  // namespace

std::optional<unsigned> monitor_of(const Channels& channels, const std::vector<size_t>& own) {
    std::optional<unsigned> found;
    for (const size_t i : own) {
        const ScreenChannel& channel = channels.screens[i];
        if (!channel.monitor) continue;
        const auto monitor = unsigned(*channel.monitor);
        const size_t monitors = Window::monitors().size();
        if (monitor >= monitors)
            throw Error("channel " + one_line(channel.name) + ": monitor " + std::to_string(monitor) + ": there are " +
                        std::to_string(monitors) + ", counted from 0");
        if (found && *found != monitor)
            throw Error("channel " + one_line(channel.name) + ": a channel of the same rank has another monitor");
        found = monitor;
    }
    return found;
}

void show_channels(const DriveArguments& a) {
    const Channels channels = read_channels(a.channels);
    ChannelRanks ranks(apps::Ranks::all(), channels);
    const std::vector<size_t> own = ranks.own(channels.screens.size());
    Window window(settings_of(a, channels, own));
    if (const auto monitor = monitor_of(channels, own)) window.fill(monitor);
    gpu::Device device(
        {.select = a.device, .validation = false, .on_message = {}, .presentation = window.presentation()});
    Drive drive;
    if (!a.replay.empty()) drive = read_drive(a.replay);
    Session session(device, start_of(a, drive.start));
    Screen screen(window, device);
    if (!screen.shows(session.settings().render().display))
        throw Error("--display: this window shows no codes of that kind");
    check_displays(channels, session.settings().render().display);
    session.share_channels(&ranks, a.latency);
    apps::Ranks::all().agree_on_start();
    const std::shared_ptr<Cache> cache = apps::cache_of(a.cache);
    session.keep_maps(cache);
    apps::Ranks::all().in_turns([&] { session.gather_light(cache.get()); });
    DriveRows rows(probes_of(a.probes));
    const ScreenSettings shown{.vsync = vsync_of(a.vsync), .scaling = window::Scaling::Fit};
    const auto show = [&](const ChannelMosaic& wall) {
        const vision::Display& display = session.settings().render().display;
        screen.begin_instruments(false);
        screen.show({.codes = wall.shown.display, .extent = wall.shown.extent, .bits = display.bits}, display, shown);
    };
    const auto look_after = [&] {
        window.poll();
        if (window.is_closing()) throw Error("its window was closed");
    };
    ranks.follow(session, channels, rows, {.show = show, .meanwhile = look_after});
}

}  // namespace vesper::drive
