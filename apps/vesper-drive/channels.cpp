#include "channels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/gtc/matrix_transform.hpp>

#include "base/angle.h"
#include "base/one_line.h"
#include "io/read_file.h"
#include "scene/json_value.h"

namespace vesper::drive {
namespace {

constexpr size_t kMost = 32;
constexpr uint64_t kMostPixels = 1ull << 27;  // of all: sixteen times 3840 x 2160

ScreenChannel channel_of(const scene::JsonValue& value) {
    value.allow_only(
        {"name", "size_px", "yaw_deg", "pitch_deg", "roll_deg", "left_deg", "right_deg", "bottom_deg", "top_deg"});
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
    return c;
}

// From the view frame of a channel to that of the driver.
glm::dmat4 turned(const ScreenChannel& c) {
    const glm::dmat4 turned = glm::rotate(glm::dmat4(1), c.yaw, glm::dvec3(0, 1, 0));
    return glm::rotate(glm::rotate(turned, c.pitch, glm::dvec3(1, 0, 0)), -c.roll, glm::dvec3(0, 0, 1));
}

// What `picture` tells of each channel, side by side. What is not finite has no vote.
std::vector<float> side_by_side(const ChannelMosaic& wall, VkExtent2D extent,
                                std::vector<float> render::Frame::*picture) {
    std::vector<float> pixels(size_t(extent.width) * extent.height * 4, std::numeric_limits<float>::quiet_NaN());
    for (size_t i = 0; i < wall.channels.size(); ++i) {
        const auto [width, height] = wall.channels[i].extent;
        for (size_t y = 0; y < height; ++y)
            std::copy_n(&(wall.channels[i].*picture)[4 * y * width], 4 * width,
                        &pixels[4 * (y * extent.width + wall.columns[i])]);
    }
    return pixels;
}

}  // namespace

Channels read_channels(const std::filesystem::path& file) {
    const scene::JsonFile text = scene::parse_json(io::read_file(file, 1u << 20), file.string());
    const scene::JsonValue root(text);
    root.allow_only({"$schema", "version", "gaze", "channels"});
    if (root.at("version").integer() != 1)
        root.at("version").fail("this version of Vesper reads channels of version 1");
    Channels channels;
    for (const scene::JsonValue& value : root.at("channels").elements()) {
        ScreenChannel c = channel_of(value);
        if (std::any_of(channels.screens.begin(), channels.screens.end(),
                        [&](const ScreenChannel& other) { return other.name == c.name; }))
            value.at("name").fail("two channels have the name " + one_line(c.name));
        channels.screens.push_back(std::move(c));
    }
    if (channels.screens.empty() || channels.screens.size() > kMost)
        root.at("channels").fail("1 to " + std::to_string(kMost) + " are expected");
    uint64_t pixels = 0;
    for (const ScreenChannel& c : channels.screens) pixels += uint64_t(c.extent.width) * c.extent.height;
    if (pixels > kMostPixels) root.at("channels").fail("have more than " + std::to_string(kMostPixels) + " px in all");
    if (const auto gaze = root.find("gaze")) {
        const auto named = std::find_if(channels.screens.begin(), channels.screens.end(),
                                        [&](const ScreenChannel& c) { return c.name == gaze->text(); });
        if (named == channels.screens.end()) gaze->fail("there is no channel " + one_line(gaze->text()));
        channels.gaze = size_t(named - channels.screens.begin());
    }
    return channels;
}

gpu_scene::View channel_view(const ScreenChannel& c, const gpu_scene::View& driver) {
    gpu_scene::View view = driver;
    view.extent = c.extent;
    view.world_to_view = glm::inverse(turned(c)) * driver.world_to_view;
    view.tangent_low = {std::tan(c.left), std::tan(c.bottom)};
    view.tangent_high = {std::tan(c.right), std::tan(c.top)};
    return view;
}

render::Frame looked_at(ChannelMosaic& wall, const Channels& channels) {
    double device = 0;
    for (const render::Frame& channel : wall.channels)
        for (const graph::Timing& timing : channel.timings) device += timing.milliseconds;
    render::Frame frame = std::move(wall.channels[channels.gaze]);
    frame.curve = wall.shown.curve, frame.eye = wall.shown.eye, frame.histogram = wall.shown.histogram;
    frame.timings = wall.shown.timings;
    frame.timings.push_back({.pass = "channels", .milliseconds = device});
    return frame;
}

ChannelMosaic ChannelRenderer::render(render::Renderer& renderer, const Channels& channels,
                                      const render::RenderSettings& settings, const gpu_scene::View& driver,
                                      const gpu_scene::SceneFrame& frame, float seconds, render::Outputs outputs) {
    ChannelMosaic wall;
    VkExtent2D extent{0, 0};
    for (const ScreenChannel& c : channels.screens) {
        wall.columns.push_back(extent.width);
        extent = {extent.width + c.extent.width, std::max(extent.height, c.extent.height)};
    }
    // Light that the eye scatters from one screen to others is known when there are pictures of all.
    const bool scatters = settings.glare == render::Glare::Scatter && settings.tone_operator != render::Operator::Ldr,
               together = scatters && channels.screens.size() > 1;
    render::RenderSettings drawn = settings;
    if (together) drawn.glare = render::Glare::None;
    std::vector<gpu_scene::View> views;
    std::vector<glm::dmat3> turns;
    for (const ScreenChannel& c : channels.screens) {
        const gpu_scene::View view = channel_view(c, driver);
        views.push_back(together ? ChannelGlare::guarded(view) : view);
        turns.emplace_back(turned(c));
        wall.channels.push_back(renderer.render(drawn, views.back(), frame, 0,
                                                {.display = false, .scene = scatters && !together, .retina = true}));
        if (!scatters) wall.channels.back().scene = std::exchange(wall.channels.back().retina, {});
    }
    if (together) glare_.scatter(settings, views, turns, eye_, seconds, wall.channels);
    const std::vector<float> pixels =
        side_by_side(wall, extent, scatters ? &render::Frame::retina : &render::Frame::scene);

    render::ToneChainSettings shown = settings;
    if (shown.glare == render::Glare::Scatter) shown.glare = render::Glare::None;  // it is in them
    const ScreenChannel& looked_at = channels.screens[channels.gaze];
    const glm::vec2 size(looked_at.extent.width, looked_at.extent.height), corner(wall.columns[channels.gaze], 0);
    shown.tone.gaze = (corner + settings.tone.gaze * size) / glm::vec2(extent.width, extent.height);
    // A pixel of the wall covers the angle that one in the middle of that channel does.
    const double tangent =
        (std::tan(looked_at.top) - std::tan(looked_at.bottom)) / looked_at.extent.height * extent.height;
    const bool wants_scene = outputs.scene;
    outputs.scene = wants_scene && !scatters, outputs.retina = false;
    wall.shown = mapper_.map(
        shown, {.extent = extent, .values = pixels, .channels = 4, .vertical_fov = 2 * std::atan(tangent / 2)}, seconds,
        outputs);
    if (wants_scene && scatters) wall.shown.scene = side_by_side(wall, extent, &render::Frame::scene);
    eye_ = wall.shown.eye;
    return wall;
}

}  // namespace vesper::drive
