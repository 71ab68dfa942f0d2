#include "record/drive_log.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "arguments/glare_arguments.h"
#include "arguments/obstacle_arguments.h"
#include "arguments/tone_arguments.h"
#include "base/error.h"
#include "base/luminance.h"
#include "base/one_line.h"
#include "print.h"
#include "statistics.h"

namespace vesper::drive {
namespace {

using apps::format;

constexpr double kPercents[]{1, 5, 25, 50, 75, 95, 99, 99.9};  // as luminance_statistics has them

constexpr const char* kAfterProbes = ",lamps,openings,lost_lights,scrubbed_pixels,width,height,device_ms,frame_ms";

double luminance_at(const render::Frame& frame, glm::dvec2 place) {
    const auto part = [](double p, uint32_t size) { return size_t(std::clamp(p * size, 0.0, double(size - 1))); };
    const float* p =
        &frame.scene[4 * (part(place.y, frame.extent.height) * frame.extent.width + part(place.x, frame.extent.width))];
    return luminance(glm::dvec3(p[0], p[1], p[2]));
}

}  // namespace

std::vector<LogProbe> probes_of(const std::vector<std::string>& texts) {
    std::vector<LogProbe> probes;
    for (const std::string& text : texts) {
        // One number up to what ends it; NaN where there is none.
        const char* at = text.c_str();
        const auto number = [&](char end) {
            char* stop = nullptr;
            const double value = std::strtod(at, &stop);
            const bool whole = stop != at && *stop == end;
            at = whole ? stop + 1 : at;
            return whole ? value : NAN;
        };
        const double x = number(','), y = number('\0');
        if (!(x >= 0 && x <= 1 && y >= 0 && y <= 1))
            throw Error("--probe " + one_line(text) + ": X,Y from 0 to 1 are expected");
        probes.push_back({{x, y}});
    }
    return probes;
}

DriveLog::DriveLog(const std::string& file, std::vector<LogProbe> probes, const std::string& more)
    : file_(file), rows_(std::move(probes)) {
    append(rows_.heading(), more);
}

std::string DriveRows::heading() const {
    std::string line =
        "frame,step,seconds,eye_step,operator,x,y,z,yaw,pitch,speed,acceleration,wheel_angle,lane,throttle,brake,"
        "steering,touched,contacts,adaptation,cone_sigma,cone_pigment,cone_fast,cone_slow,log_average,minimum,maximum,"
        "mean";
    for (const double percent : kPercents) line += format(",p%g", percent);
    line += apps::glare_columns();
    for (size_t i = 0; i < probes_.size(); ++i) line += format(",probe%zu", i);
    return line + kAfterProbes;
}

// NODE@SPEED of each, the speed (m/s) at which they met; several are parted by semicolons.
void DriveRows::add(const traffic::Contact& contact) {
    contacts_ += (contacts_.empty() ? "" : ";") + apps::csv_name(contact.node) + format("@%.3g", contact.speed);
}

std::string DriveRows::next(const Session& session, const gpu_scene::View& view, const render::Frame& frame) {
    const traffic::World& world = session.world();
    const traffic::Actor& me = session.actors().front();
    const traffic::VehicleState& car = world.driver();
    const traffic::DriverInput& input = session.input();
    const render::RenderSettings& settings = session.settings().render();
    std::string line = format("%u,%llu,%.6f,%.9g,%s", rows_++, static_cast<unsigned long long>(world.steps()),
                              world.seconds(), session.eye_step(), apps::name_of(settings.tone_operator).c_str());
    for (const double value :
         {me.position.x, me.position.y, me.position.z, me.yaw, me.pitch, me.speed, car.acceleration, car.angle})
        line += format(",%.9g", value);
    line += format(",%zu,%.4g,%.4g,%.4g,%d", world.driver_lane(), input.throttle, input.brake, input.steering,
                   int(world.touched())) +
            "," + std::exchange(contacts_, {});
    for (const float value : {frame.curve.adaptation, frame.curve.cone_sigma, frame.eye.cones.pigment,
                              frame.eye.cones.fast, frame.eye.cones.slow, frame.curve.log_average})
        line += format(",%.9g", double(value));
    if (frame.scene.empty()) {
        const std::string columns = heading();
        line += std::string(size_t(std::count(columns.begin() + ptrdiff_t(columns.find(",minimum")),
                                              columns.begin() + ptrdiff_t(columns.find(kAfterProbes)), ',')),
                            ',');
    } else {
        const apps::LuminanceStatistics s = apps::luminance_statistics(frame.scene);
        for (const double value : {s.minimum, s.maximum, s.mean}) line += format(",%.6g", value);
        for (size_t i = 0; i < std::size(kPercents); ++i)
            line += i < s.percentiles.size() ? format(",%.6g", s.percentiles[i].second) : ",";
        line += apps::glare_values(apps::glare_of({}, settings, frame, gpu_scene::angles_of(view), frame.outside));
        for (const LogProbe& probe : probes_) line += format(",%.6g", luminance_at(frame, probe.place));
    }
    double device = 0;
    for (const graph::Timing& timing : frame.timings) device += timing.milliseconds;
    // Every lamp counts: froxels whose lists overflow look at all of them.
    return line + format(",%u,%u,0,%u,%u,%u,%.3f,%.3f", frame.lamps, frame.luminaires, frame.histogram.non_finite,
                         frame.extent.width, frame.extent.height, device, frame.milliseconds);
}

std::string row_of(DriveRows& rows, const Session& session, const Channels& channels, ChannelMosaic& wall) {
    render::Frame logged = logged_frame(wall, channels.gaze);
    std::string row = rows.next(session, channel_view(channels.screens[channels.gaze], session.view({1, 1})), logged);
    wall.channels[channels.gaze] = std::move(logged);
    return row;
}

}  // namespace vesper::drive
