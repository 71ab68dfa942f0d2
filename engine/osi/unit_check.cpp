#include "osi/unit_check.h"

#include <cmath>
#include <optional>

#include "base/angle.h"

namespace vesper::osi {
namespace {

constexpr double kAgrees = 20 * kPi / 180;             // rad, of a yaw and a direction
constexpr double kLeastStep = 0.2;                     // m
constexpr double kLongestCar = 30, kFastestCar = 150;  // m; m/s
constexpr uint64_t kFewest = 10;
constexpr double kMost = 0.8;  // share

// A yaw is factor * stated + offset, rad.
struct Reading {
    const char* words;
    double factor, offset;
};
constexpr double kDegree = kPi / 180, kQuarter = kPi / 2;
constexpr Reading kReadingsOfYaw[UnitCheck::kReadings]{{"", 1, 0},
                                                       {"degrees", kDegree, 0},
                                                       {"radians, clockwise from x", -1, 0},
                                                       {"degrees, clockwise from x", -kDegree, 0},
                                                       {"radians, clockwise from y", -1, kQuarter},
                                                       {"degrees, clockwise from y", -kDegree, kQuarter}};

bool is_most(uint64_t part, uint64_t all) { return all >= kFewest && double(part) >= kMost * double(all); }

// The only reading of a yaw that agrees with a direction, rad.
std::optional<size_t> reading_of(double yaw, double direction) {
    std::optional<size_t> found;
    for (size_t i = 0; i < UnitCheck::kReadings; ++i) {
        const Reading& reading = kReadingsOfYaw[i];
        const double away = std::remainder(reading.factor * yaw + reading.offset - direction, 2 * kPi);
        if (std::abs(away) > kAgrees) continue;
        if (found) return std::nullopt;
        found = i;
    }
    return found;
}

}  // namespace

void UnitCheck::add(const Message& message) {
    std::unordered_map<uint64_t, Track> now;
    for (const MovingObject& object : message.objects) {
        if (object.kind == MovingObject::Kind::Car && object.size.x > 0)
            ++lengths_, long_lengths_ += object.size.x > kLongestCar;
        Track track{message.nanoseconds, object.centre};
        if (const auto known = tracks_.find(object.id); known != tracks_.end()) {
            const glm::dvec3 step = object.centre - known->second.centre;
            const double metres = std::hypot(step.x, step.y);
            if (metres < kLeastStep || message.nanoseconds <= known->second.nanoseconds) {
                now.insert_or_assign(object.id, known->second);
                continue;
            }
            const double seconds = double(message.nanoseconds - known->second.nanoseconds) / 1e9;
            ++speeds_, high_speeds_ += metres > kFastestCar * seconds;
            if (const auto reading = reading_of(object.yaw, std::atan2(step.y, step.x))) ++yaws_[*reading];
        }
        now.insert_or_assign(object.id, track);
    }
    tracks_ = std::move(now);
}

std::vector<std::string> UnitCheck::doubts() const {
    std::vector<std::string> made;
    const auto share = [](uint64_t part, uint64_t all) {
        return std::to_string(std::lround(100 * double(part) / double(all))) + " % of ";
    };
    uint64_t all = 0;
    for (const uint64_t number : yaws_) all += number;
    for (size_t i = 1; i < kReadings; ++i)
        if (is_most(yaws_[i], all))
            made.push_back(share(yaws_[i], all) + "the yaws are where the objects move only as " +
                           kReadingsOfYaw[i].words + ": OSI has radians, counter-clockwise from x");
    if (is_most(long_lengths_, lengths_))
        made.push_back(share(long_lengths_, lengths_) + "the cars are longer than 30 m: OSI has metres");
    if (is_most(high_speeds_, speeds_))
        made.push_back(share(high_speeds_, speeds_) + "the objects are faster than 150 m/s: OSI has metres");
    return made;
}

}  // namespace vesper::osi
