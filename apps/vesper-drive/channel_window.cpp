#include "channel_window.h"

#include "arguments.h"
#include "base/error.h"
#include "base/one_line.h"
#include "channel_ranks.h"
#include "drive_log.h"
#include "indirect_arguments.h"
#include "picture_arguments.h"
#include "print.h"
#include "screen.h"
#include "shadow_arguments.h"

namespace vesper::drive {
namespace {

// Over the monitor of its first channel, or of the size of --window.
WindowSettings settings_of(const DriveArguments& a, const Channels& channels, const std::vector<size_t>& own) {
    WindowSettings settings{.title = "", .extent = apps::parse_size(a.window, 64), .monitor = {}};
    for (const size_t i : own) {
        const ScreenChannel& channel = channels.screens[i];
        settings.title += (settings.title.empty() ? "" : ", ") + channel.name;
        if (channel.monitor && !settings.monitor) settings.monitor = unsigned(*channel.monitor);
    }
    settings.title += " - Vesper";
    return settings;
}

}  // namespace

void show_channels(const DriveArguments& a) {
    const Channels channels = read_channels(a.channels);
    ChannelRanks ranks(apps::Ranks::all(), channels);
    Window window(settings_of(a, channels, ranks.own(channels.screens.size())));
    gpu::Device device(
        {.select = a.device, .validation = false, .on_message = {}, .presentation = window.presentation()});
    Drive drive;
    if (!a.replay.empty()) drive = read_drive(a.replay);
    Session session(device, start_of(a, drive.start));
    Screen screen(window, device);
    if (!screen.shows(session.settings().render().display))
        throw Error("--display: this window shows no codes of that kind");
    session.share_channels(&ranks, a.latency);
    apps::Ranks::all().agree_on_files();
    const std::shared_ptr<Cache> cache = apps::shadow_cache(a.shadow_cache);
    session.keep_maps(cache);
    apps::Ranks::all().in_turns([&] {
        if (!session.settings().render().indirect) return;
        const gpu_scene::SceneFrame rest = session.moment();
        session.set_radiosity(apps::gathered(session.scenery().scene(), rest.world, rest.moving, cache.get()));
    });
    if (a.replay.empty()) session.set_shadow_budget(kWindowShadowBudget);
    DriveRows rows(probes_of(a.probes));
    session.on_contact = [&](const traffic::Contact& contact) { rows.add(contact); };
    const ScreenSettings shown{.vsync = vsync_of(a.vsync), .scaling = window::Scaling::Fit};
    const auto look_after = [&] {
        window.poll();
        if (window.is_closing()) throw Error("its window was closed");
    };
    while (const auto wanted = ranks.follow(session, look_after)) {
        const bool logs = wanted->row && ranks.has(channels.gaze);
        ChannelMosaic wall = session.render(channels, {.display = true, .scene = logs});
        ranks.meet(wall.shown.eye);
        screen.begin_instruments(false);
        screen.show({.codes = wall.shown.display,
                     .extent = wall.shown.extent,
                     .bits = session.settings().render().display.bits},
                    session.settings().render().display, shown);
        ranks.report(*wanted, wall, logs ? row_of(rows, session, channels, wall) : "");
    }
    session.leave_channels();
}

}  // namespace vesper::drive
