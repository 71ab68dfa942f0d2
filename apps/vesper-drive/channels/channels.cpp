#include "channels/channels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <glm/gtc/matrix_transform.hpp>

#include "base/angle.h"
#include "base/budget.h"
#include "base/limits.h"
#include "base/one_line.h"
#include "graph/times.h"
#include "io/named_file.h"
#include "io/read_file.h"
#include "scene/display_file.h"
#include "scene/json_value.h"

namespace vesper::drive {
namespace {

constexpr size_t kMost = 32;
constexpr uint64_t kMostBytes = 2ull << 30;   // of the pictures of one process, times VESPER_LIMITS
constexpr uint64_t kBytesPerPixel = 40;       // of a channel, as 32 of 2000 x 2000 px take with glare and the eye
constexpr uint64_t kMostPixels = 1ull << 27;  // of all: sixteen times 3840 x 2160

// What projectors of a channel are given. `folder`: of the file of channels.
void read_projector(const scene::JsonValue& value, const std::filesystem::path& folder, ScreenChannel& c) {
    const auto file_of = [&](const char* key) {
        const auto name = value.find(key);
        if (!name) return std::filesystem::path();
        try {
            return io::named_file(folder, name->text());
        } catch (const Error& error) {
            name->fail(error.what());
        }
    };
    // A file that cannot be read is named with the member that names it.
    const auto read = [&](const char* key, const std::filesystem::path& file, const auto& reader) {
        try {
            return reader(file);
        } catch (const OutOfHostMemory&) {
            throw;
        } catch (const Error& error) {
            value.at(key).fail(error.what());
        }
    };
    if (const std::filesystem::path profile = file_of("display"); !profile.empty())
        c.display = read("display", profile, [](const auto& file) { return scene::read_display(file); });
    const std::filesystem::path warp = file_of("warp"), mask = file_of("mask");
    if (warp.empty() && mask.empty()) return;
    spend(uint64_t{c.extent.width} * c.extent.height * sizeof(shared::ProjectedPixel));
    std::optional<vision::WarpMesh> mesh;
    std::optional<vision::BlendMask> factors;
    if (!warp.empty()) mesh = read("warp", warp, vision::read_warp_mesh);
    if (!mask.empty()) factors = read("mask", mask, vision::read_blend_mask);
    c.projection = std::make_shared<const eye::Projection>(
        eye::projection_of(c.extent, c.extent, mesh ? &*mesh : nullptr, factors ? &*factors : nullptr));
}

ScreenChannel channel_of(const scene::JsonValue& value) {
    value.allow_only({"name", "size_px", "yaw_deg", "pitch_deg", "roll_deg", "left_deg", "right_deg", "bottom_deg",
                      "top_deg", "display", "warp", "mask", "rank", "monitor"});
    ScreenChannel c;
    c.name = value.at("name").text();
    const auto size = value.at("size_px").elements(2);
    c.extent = {uint32_t(size[0].integer(16384)), uint32_t(size[1].integer(16384))};
    if (c.extent.width == 0 || c.extent.height == 0) value.at("size_px").fail("must be at least 1 x 1");
    c.yaw = value.number_or("yaw_deg", 0, -180, 180) * kRadiansPerDegree;
    c.pitch = value.number_or("pitch_deg", 0, -90, 90) * kRadiansPerDegree;
    c.roll = value.number_or("roll_deg", 0, -180, 180) * kRadiansPerDegree;
    const auto edge = [&](const char* key) { return value.at(key).number(-89, 89) * kRadiansPerDegree; };
    c.left = edge("left_deg"), c.right = edge("right_deg"), c.bottom = edge("bottom_deg"), c.top = edge("top_deg");
    if (!(c.right > c.left + 1e-3)) value.at("right_deg").fail("must be more than left_deg");
    if (!(c.top > c.bottom + 1e-3)) value.at("top_deg").fail("must be more than bottom_deg");
    const auto number = [&](const char* key) {
        const auto given = value.find(key);
        return given ? std::optional(int(given->integer(4096))) : std::nullopt;
    };
    c.rank = number("rank"), c.monitor = number("monitor");
    return c;
}

// From the view frame of a channel to that of the driver.
glm::dmat4 turned(const ScreenChannel& c) {
    const glm::dmat4 turned = glm::rotate(glm::dmat4(1), c.yaw, glm::dvec3(0, 1, 0));
    return glm::rotate(glm::rotate(turned, c.pitch, glm::dvec3(1, 0, 0)), -c.roll, glm::dvec3(0, 0, 1));
}

// Directions of one channel that lie well within another one, at most so many of kProbes x kProbes.
constexpr int kProbes = 48;
int overlap(const ScreenChannel& one, const ScreenChannel& other) {
    const glm::dmat3 to_other = glm::transpose(glm::dmat3(turned(other))) * glm::dmat3(turned(one));
    const auto at = [](double low, double high, double part) { return std::lerp(std::tan(low), std::tan(high), part); };
    const auto within = [](double tangent, double low, double high) {
        const double part = (tangent - std::tan(low)) / (std::tan(high) - std::tan(low));
        return part > 0.01 && part < 0.99;  // screens that touch, as numbers of a file have it
    };
    int shared = 0;
    for (int y = 0; y < kProbes; ++y)
        for (int x = 0; x < kProbes; ++x) {
            const glm::dvec3 d = to_other * glm::dvec3(at(one.left, one.right, (x + 0.5) / kProbes),
                                                       at(one.bottom, one.top, (y + 0.5) / kProbes), -1);
            shared +=
                d.z < 0 && within(d.x / -d.z, other.left, other.right) && within(d.y / -d.z, other.bottom, other.top);
        }
    return shared;
}

// Where two projectors shine, their masks part the light.
void check_overlaps(const Channels& channels, const scene::JsonValue& root) {
    const std::vector<ScreenChannel>& all = channels.screens;
    for (size_t i = 0; i < all.size(); ++i)
        for (size_t k = 0; k < i; ++k)
            if (!(all[i].projection && all[k].projection) && overlap(all[i], all[k]) + overlap(all[k], all[i]) > 0)
                root.at("channels")
                    .fail("channels " + one_line(all[k].name) + " and " + one_line(all[i].name) +
                          " overlap: of two that do, both need a warp mesh or a mask");
}

// The luminances that all displays have, as one display: the curve of the eye is made for it.
vision::Display common_display(const Channels& channels, const vision::Display& usual) {
    if (std::ranges::none_of(channels.screens, [](const ScreenChannel& c) { return c.display.has_value(); }))
        return usual;
    float low = 0, high = std::numeric_limits<float>::infinity();
    for (const ScreenChannel& c : channels.screens) {
        const vision::Display& display = c.display ? *c.display : usual;
        if (display.bits != usual.bits)
            throw Error("channel " + one_line(c.name) + ": its display has codes of " + std::to_string(display.bits) +
                        " bits, and --display of " + std::to_string(usual.bits));
        low = std::max(low, display.low()), high = std::min(high, display.high());
    }
    if (!(high > low)) throw Error("channels: their displays have no luminance in common");
    vision::Display common = usual;
    common.ambient = 0, common.black = low, common.peak = high;
    return common;
}

// What `picture` tells of each channel, side by side; `beside` where there is none.
template <class T>
std::vector<T> side_by_side(const ChannelMosaic& wall, std::vector<T> render::ToneMapped::*picture,
                            std::array<T, 4> beside) {
    if (std::ranges::all_of(wall.channels, [&](const render::Frame& channel) { return (channel.*picture).empty(); }))
        return {};
    const auto [width, height] = wall.shown.extent;
    std::vector<T> pixels(size_t(width) * height * 4);
    for (size_t i = 0; i < pixels.size(); ++i) pixels[i] = beside[i % 4];
    for (size_t i = 0; i < wall.channels.size(); ++i) {
        const size_t columns = wall.channels[i].extent.width, rows = wall.channels[i].extent.height;
        const std::vector<T>& from = wall.channels[i].*picture;
        if (from.empty()) continue;
        for (size_t y = 0; y < rows; ++y)
            std::copy_n(&from[4 * y * columns], 4 * columns, &pixels[4 * (y * width + wall.columns[i])]);
    }
    return pixels;
}

// One channel's, as the processes tell each other.
void write_statistics(apps::PacketWriter& packet, size_t channel, const render::ViewStatistics& seen) {
    packet.value(uint64_t{channel});
    packet.value(seen.histogram), packet.value(seen.whole);
    packet.value(seen.fovea.size), packet.value(seen.fovea.gaze), packet.list(seen.fovea.texels);
    packet.list(seen.colours);
}

render::ViewStatistics read_statistics(apps::PacketReader& packet) {
    render::ViewStatistics seen;
    packet.value(seen.histogram), packet.value(seen.whole);
    packet.value(seen.fovea.size), packet.value(seen.fovea.gaze);
    seen.fovea.texels = packet.list<glm::vec4>(), seen.colours = packet.list<glm::vec4>();
    return seen;
}

std::vector<float> middle_of(const std::vector<float>& rgba, VkExtent2D whole, VkExtent2D shown) {
    const size_t left = (whole.width - shown.width) / 2, top = (whole.height - shown.height) / 2;
    std::vector<float> middle;
    middle.reserve(size_t(4) * shown.width * shown.height);
    for (size_t y = 0; y < shown.height; ++y) {
        const auto row = rgba.begin() + ptrdiff_t(4 * ((y + top) * whole.width + left));
        middle.insert(middle.end(), row, row + ptrdiff_t(4 * size_t(shown.width)));
    }
    return middle;
}

// Times and pupil of an eye that saw a screen; and luminances lose the border, which nobody sees.
void take_seen(render::Frame& frame, const render::SharedEye::Seen& seen, VkExtent2D shown) {
    if (!frame.scene.empty()) frame.scene = middle_of(frame.scene, frame.extent, shown);
    frame.extent = shown;
    frame.timings.insert(frame.timings.end(), seen.timings.begin(), seen.timings.end());
    frame.pupil = seen.pupil, frame.pattern_milliseconds = seen.pattern_milliseconds;
    frame.milliseconds += seen.milliseconds;
}

/// Refuses pictures whose memory, of those that one process shows, is over the limit.
void check_pixels(const Channels& channels, const scene::JsonValue& place) {
    uint64_t pixels = 0;
    std::map<int, uint64_t> of_rank;
    for (const ScreenChannel& c : channels.screens) {
        const uint64_t own = uint64_t(c.extent.width) * c.extent.height;
        pixels += own, of_rank[c.rank.value_or(0)] += own;
    }
    if (pixels > kMostPixels) place.fail("have more than " + std::to_string(kMostPixels) + " px in all");
    const uint64_t most = scaled_limit(kMostBytes) / kBytesPerPixel;
    for (const auto& [rank, own] : of_rank)
        if (own > most)
            place.fail("have " + std::to_string(own) + " px in one process, more than the " + std::to_string(most) +
                       " px whose pictures take 2 GiB: fewer px, ranks for some of them, or VESPER_LIMITS=2 in the "
                       "environment");
}

}  // namespace

Channels read_channels(const std::filesystem::path& file) {
    const scene::JsonFile text = scene::parse_json(io::read_file(file, 1u << 20), file.string());
    const scene::JsonValue root(text);
    root.allow_only({"$schema", "version", "gaze", "channels"});
    if (root.at("version").integer() != 1)
        root.at("version").fail("this version of Vesper reads channels of version 1");
    Channels channels;
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    for (const scene::JsonValue& value : root.at("channels").elements()) {
        ScreenChannel c = channel_of(value);
        if (std::any_of(channels.screens.begin(), channels.screens.end(),
                        [&](const ScreenChannel& other) { return other.name == c.name; }))
            value.at("name").fail("two channels have the name " + one_line(c.name));
        channels.screens.push_back(std::move(c));
    }
    if (channels.screens.empty() || channels.screens.size() > kMost)
        root.at("channels").fail("1 to " + std::to_string(kMost) + " are expected");
    check_pixels(channels, root.at("channels"));
    if (const auto gaze = root.find("gaze")) {
        const auto named = std::find_if(channels.screens.begin(), channels.screens.end(),
                                        [&](const ScreenChannel& c) { return c.name == gaze->text(); });
        if (named == channels.screens.end()) gaze->fail("there is no channel " + one_line(gaze->text()));
        channels.gaze = size_t(named - channels.screens.begin());
    }
    const std::vector<scene::JsonValue> values = root.at("channels").elements();
    for (size_t i = 0; i < values.size(); ++i) read_projector(values[i], folder, channels.screens[i]);
    check_overlaps(channels, root);
    return channels;
}

void check_displays(const Channels& channels, const vision::Display& usual) { common_display(channels, usual); }

gpu_scene::View channel_view(const ScreenChannel& c, const gpu_scene::View& driver) {
    gpu_scene::View view = driver;
    view.extent = c.extent;
    view.world_to_view = glm::inverse(turned(c)) * driver.world_to_view;
    view.tangent_low = {std::tan(c.left), std::tan(c.bottom)};
    view.tangent_high = {std::tan(c.right), std::tan(c.top)};
    return view;
}

void put_together(ChannelMosaic& wall, bool scene) {
    VkExtent2D extent{0, 0};
    wall.columns.clear();
    for (const render::Frame& channel : wall.channels) {
        wall.columns.push_back(extent.width);
        extent = {extent.width + channel.extent.width, std::max(extent.height, channel.extent.height)};
    }
    wall.shown.extent = wall.shown.shown_extent = extent;
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();  // has no vote in what is measured
    constexpr uint8_t kOpaque = 255;  // the darkest code of 8 bits; of 10 bits, as well, but for the bits of alpha
    wall.shown.display = side_by_side<uint8_t>(wall, &render::ToneMapped::display, {0, 0, 0, kOpaque});
    if (scene) wall.shown.scene = side_by_side<float>(wall, &render::ToneMapped::scene, {kNone, kNone, kNone, kNone});
}

render::Frame logged_frame(ChannelMosaic& wall, size_t channel) {
    double device = 0;
    for (const render::Frame& each : wall.channels)
        for (const graph::Timing& timing : each.timings) device += timing.milliseconds;
    render::Frame frame = std::move(wall.channels[channel]);
    frame.curve = wall.shown.curve, frame.eye = wall.shown.eye, frame.histogram = wall.shown.histogram;
    frame.timings = wall.shown.timings;
    frame.timings.push_back({.pass = "channels", .milliseconds = device});
    return frame;
}

ChannelRenderer::ChannelRenderer(gpu::Device& device, ChannelLink* link)
    : device_(device), link_(link ? *link : alone_), turns_(link_, ChannelLink::Kind::Statistics), glare_(link_) {}

void ChannelRenderer::reset_adaptation() {
    left_.reset();
    if (eye_) eye_->reset_adaptation();
    turns_.forget(), glare_.forget();
}

std::vector<render::ViewStatistics> ChannelRenderer::statistics_of_all(const std::vector<apps::Bytes>& turn,
                                                                       size_t channels) const {
    std::vector<std::optional<render::ViewStatistics>> found(channels);
    for (const apps::Bytes& bytes : turn)
        for (apps::PacketReader packet(bytes); !packet.at_end();) {
            const auto channel = packet.value<uint64_t>();
            found.at(channel) = read_statistics(packet);
        }
    std::vector<render::ViewStatistics> all;
    for (std::optional<render::ViewStatistics>& one : found) all.push_back(std::move(one.value()));
    return all;
}

ChannelMosaic ChannelRenderer::render(render::Renderer& renderer, const Channels& channels,
                                      const render::RenderSettings& given, const gpu_scene::View& driver,
                                      const gpu_scene::SceneFrame& frame, float seconds, render::Outputs outputs) {
    const size_t screens = channels.screens.size();
    const std::vector<size_t> own = link_.own(screens);
    render::RenderSettings settings = render::ldr_baseline(given);
    settings.unshadowed_share = 0;  // what casts shadows is the same for all screens, and drawn once for them
    if (pictures_.size() != screens) {
        eye_ = std::make_unique<render::SharedEye>(device_, std::max<size_t>(own.size(), 1));
        pictures_ = std::vector<Picture>(screens);
    }
    eye_->set_eye(left_.value_or(shared::EyeState{}));

    // Light. Screens have borders where others scatter light into them.
    const bool together = settings.glare == render::Glare::Scatter && screens > 1;
    std::vector<gpu_scene::View> shown, views;
    std::vector<glm::dmat3> turns;
    for (const ScreenChannel& c : channels.screens) {
        shown.push_back(channel_view(c, driver));
        views.push_back(together ? ChannelGlare::guarded(shown.back()) : shown.back());
        turns.emplace_back(turned(c));
    }
    ChannelMosaic wall;
    wall.channels.resize(screens);
    for (const size_t i : own)
        wall.channels[i] = renderer.render(settings, views[i], frame, 0,
                                           {.display = false, .scene = outputs.scene, .light = &pictures_[i].light});

    // Retinas and statistics.
    std::vector<ChannelGlare::Beside> beside(screens);
    if (together) {
        const ChannelGlare::LightOf light_of = [&](size_t i, std::span<const uint32_t> nodes) {
            return eye_->light_of(pictures_[i].light, nodes);
        };
        beside = glare_.exchange({settings, late_}, views, turns, wall.channels, light_of);
    } else {
        glare_.forget();
    }
    render::ToneChainSettings seen_by_all = settings;
    seen_by_all.display = common_display(channels, settings.display);
    seen_by_all.histogram.electorate = 0;
    for (const ScreenChannel& c : channels.screens)
        seen_by_all.histogram.electorate += uint64_t(c.extent.width) * c.extent.height;
    apps::PacketWriter packet;
    for (const size_t i : own) {
        render::SharedEye::Seen seen = eye_->see(seen_by_all, pictures_[i].light,
                                                 together ? render::ScatterInputs{.pictures = &beside[i].light}
                                                          : render::ScatterInputs{.lamps = wall.channels[i].outside},
                                                 seconds, shown[i], pictures_[i].retina);
        take_seen(wall.channels[i], seen, shown[i].extent);
        if (together) wall.channels[i].outside = std::move(beside[i].lamps);
        if (outputs.retina) wall.channels[i].retina = eye_->read(pictures_[i].retina);
        if (i != channels.gaze) seen.statistics.fovea = {};
        write_statistics(packet, i, seen.statistics);
    }

    // One eye, one curve.
    wall.shown =
        eye_->adapt(seen_by_all, statistics_of_all(turns_.tell(packet.take(), late_), screens), channels.gaze, seconds);
    left_ = wall.shown.eye;
    for (const size_t i : own) {
        if (!outputs.display) break;
        const ScreenChannel& screen = channels.screens[i];
        render::ToneChainSettings on_screen = seen_by_all;
        on_screen.display = screen.display ? *screen.display : settings.display;
        render::ToneMapped mapped = eye_->show(on_screen, pictures_[i].retina, wall.shown.curve,
                                               {.display = true, .projection = screen.projection.get()});
        wall.channels[i].display = std::move(mapped.display), wall.channels[i].foveal_level = mapped.foveal_level;
        graph::add_times(wall.shown.timings, mapped.timings);
    }
    put_together(wall, outputs.scene);
    return wall;
}

}  // namespace vesper::drive
