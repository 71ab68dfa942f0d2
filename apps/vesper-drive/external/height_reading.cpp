#include "external/height_reading.h"

#include <cmath>
#include <utility>

#include "external/external_bodies.h"

namespace vesper::drive {
namespace {

constexpr double kLeastHalf = 0.3;              // m: of lower boxes middle and ground are too near each other
constexpr double kNear = 0.35;                  // of half the height: kerbs, and roads of another surface
constexpr double kGround = 0.8, kMiddle = 0.2;  // shares of the votes
constexpr uint64_t kFewest = 3;
constexpr double kMoments = 15;
constexpr size_t kLooks = 5000;

}  // namespace

GroundBelow::GroundBelow(const scene::Scene& scene, std::span<const glm::dmat4> world, std::vector<uint32_t> moving)
    : rays_(scene, world), moving_(std::move(moving)) {}

std::optional<double> GroundBelow::height(const glm::dvec3& from, double reach) const {
    const auto hit = rays_.nearest(from, from - glm::dvec3(0, reach, 0), moving_);
    return hit ? std::optional(from.y - hit->share * reach) : std::nullopt;
}

void HeightVotes::add(const osi::MovingObject& object, const MessageFrame& frame, const GroundBelow& below) {
    const double half = ExternalBodies::size_of(object).z / 2;
    if (half < kLeastHalf) return;
    const glm::dvec3 place = frame.point(object.centre);
    const auto height = below.height(place + glm::dvec3(0, half / 2, 0), 2 * half);
    if (!height) return;
    const double above = place.y - *height;
    ground += std::abs(above) < kNear * half, middle += std::abs(above - half) < kNear * half;
}

void raise(osi::MovingObject& object) {
    object.centre += ExternalBodies::size_of(object).z / 2 * osi::axes_of(object.yaw, object.pitch, object.roll)[2];
}

HeightVotes votes_of(std::span<const osi::Message> messages, const MessageFrame& frame, const GroundBelow& below) {
    size_t objects = 0, number = 0;
    for (const osi::Message& message : messages) objects += message.objects.size();
    HeightVotes votes;
    for (const osi::Message& message : messages)
        for (const osi::MovingObject& object : message.objects)
            if (number++ % (1 + objects / kLooks) == 0) votes.add(object, frame, below);
    return votes;
}

bool are_at_ground(const HeightVotes& votes) {
    return votes.all() >= kFewest && double(votes.ground) >= kGround * double(votes.all());
}

bool HeightJudge::take(const osi::Moment& moment, const MessageFrame& frame) {
    if (!below_) return at_ground_;
    HeightVotes votes;
    for (const osi::ObjectNow& now : moment.objects) votes.add(now.object, frame, *below_);
    if (votes.all() == 0) return at_ground_;
    share_ += (double(votes.ground) / double(votes.all()) - share_) / kMoments;
    return at_ground_ = share_ > (at_ground_ ? kMiddle : kGround);
}

}  // namespace vesper::drive
