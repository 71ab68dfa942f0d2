#include "transport/lamp_light.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "photometry/distribution.h"
#include "scene/fixtures.h"
#include "scene/lamp.h"
#include "transport/reach.h"

namespace vesper::transport {
namespace {

constexpr double kDark = 1e-30;   // lx: less is rounding
constexpr double kBright = 1e25;  // cd: the rest of the range of floats is for its illuminance
constexpr float kNear = 1e-3f;    // m: what is nearer weighs no more

// Even steps through a sum, from a place by chance (systematic sampling).
class Steps {
public:
    Steps(double start, double sum, uint32_t count) : start_(start), width_(sum / count), count_(count) {}
    bool falls_before(double end) const { return next_ < count_ && (start_ + next_) * width_ < end; }
    uint32_t take_before(double end) {
        const uint32_t first = next_;
        while (falls_before(end)) ++next_;
        return next_ - first;
    }

private:
    double start_, width_;
    uint32_t count_, next_ = 0;
};

}  // namespace

LampLight::LampLight(const scene::Scene& scene, std::span<const glm::dmat4> world, const rays::RayCaster& rays)
    : scene_(scene), rays_(rays), in_fixture_(scene.nodes.size()) {
    const std::vector<uint32_t> nodes = scene::nodes_with_lamps(scene);
    std::vector<std::vector<uint32_t>> fixtures = scene::fixture_nodes(scene, nodes, world);
    for (size_t i = 0; i < nodes.size(); ++i) {
        const scene::Lamp& lamp = scene.lamps[scene.nodes[nodes[i]].lamp];
        const glm::dmat4& at = world[nodes[i]];
        double largest = double(lamp.intensity);
        if (lamp.kind == scene::Lamp::Kind::Measured)
            largest *= photometry::largest_intensity(scene.distributions[lamp.distribution]);
        const glm::dmat3 frame = scene::lamp_frame(at);
        const bool directional = lamp.kind == scene::Lamp::Kind::Directional;
        const bool cone = lamp.kind == scene::Lamp::Kind::Point || lamp.kind == scene::Lamp::Kind::Spot;
        const glm::dvec2 everywhere(0, 1);
        bounds_.push_back({directional ? kReach * frame[2] : glm::dvec3(at[3]), frame[2],
                           cone ? scene::cone_ramp(lamp) : everywhere, largest, directional, cone});
        for (const uint32_t node : fixtures[i]) in_fixture_[node] = true;
        lamps_.push_back({nodes[i], &lamp, glm::transpose(frame), std::move(fixtures[i]),
                          scene::housing_reach(scene.nodes[nodes[i]])});
    }
    bound_lanes_.resize(lanes_for(bounds_.size()));
    for (size_t i = 0; i < bounds_.size(); ++i) {
        const Bound& bound = bounds_[i];
        BoundLanes& lanes = bound_lanes_[i / kLanes];
        const size_t lane = i % kLanes;
        lanes.place.set(lane, glm::vec3(bound.place - rays.middle())), lanes.back.set(lane, glm::vec3(bound.back));
        lanes.slope[lane] = float(bound.ramp.x), lanes.offset[lane] = float(bound.ramp.y);
        if (bound.directional)
            directional_.push_back(i);
        else
            lanes.largest[lane] = float(std::min(bound.largest, kBright));
    }
}

// From a point of a surface.
struct LampLight::Way {
    glm::dvec3 to;     // m; of directional lamps kReach
    double cosine;     // with the normal
    double distance2;  // that it takes light, m^2; directional: 1
    double bound() const { return cosine > 0 ? cosine / distance2 : 0; }
};

inline LampLight::Way LampLight::way_to(const Bound& lamp, glm::dvec3 point, glm::dvec3 normal) {
    const glm::dvec3 to = lamp.directional ? lamp.place : lamp.place - point;
    const double distance2 = glm::dot(to, to);
    return {to, glm::dot(normal, to) / std::max(std::sqrt(distance2), 1e-300), lamp.directional ? 1 : distance2};
}

// lx, if nothing stands between.
double LampLight::unshadowed(size_t lamp, const Way& way) const {
    const Bound& bound = bounds_[lamp];
    const double most = bound.largest * way.bound();
    if (bound.directional || !(most > 0)) return most;
    if (bound.cone) {
        const double cosine = glm::dot(bound.back, way.to) / std::sqrt(way.distance2);
        const double ramp = std::clamp(bound.ramp.x * cosine + bound.ramp.y, 0.0, 1.0);
        return most * ramp * ramp;
    }
    const Placed& placed = lamps_[lamp];
    return way.bound() * scene::luminous_intensity(*placed.lamp, scene_.distributions, placed.to_lamp * -way.to);
}

bool LampLight::blocked(size_t lamp, const Way& way, glm::dvec3 point, glm::dvec3 normal) const {
    const glm::dvec3 start = point + skin_at(rays_, point) * normal;
    const Bound& bound = bounds_[lamp];
    return rays_.blocked(start, bound.directional ? start + way.to : bound.place, lamps_[lamp].fixture);
}

bool LampLight::lights(size_t lamp, uint32_t node, const Way& way) const {
    if (node == scene::kNone || !in_fixture_[node]) return true;
    const Placed& placed = lamps_[lamp];
    return !(glm::length(way.to) <= placed.housing) || !std::ranges::binary_search(placed.fixture, node);
}

glm::dvec3 LampLight::illuminance(glm::dvec3 point, glm::dvec3 normal, double threshold, uint32_t node) const {
    glm::dvec3 sum(0);
    for (size_t i = 0; i < lamps_.size(); ++i) {
        const Way way = way_to(bounds_[i], point, normal);
        if (!(way.cosine > 0) || !(bounds_[i].largest * way.cosine >= threshold * way.distance2)) continue;
        if (!lights(i, node, way)) continue;
        const double lux = unshadowed(i, way);
        if (lux < threshold || lux == 0 || blocked(i, way, point, normal)) continue;
        sum += lux * glm::dvec3(lamps_[i].lamp->colour);
    }
    return sum;
}

// Of lamps in a cone about; of others by their largest intensity.
LampLight::Most LampLight::most_at(std::span<const SurfacePlace> places) const {
    const Patch patch = Patch::around(places);
    const Lanes3 from = all_of(glm::vec3(patch.middle - rays_.middle())), up = all_of(glm::vec3(patch.normal));
    const auto across = float(patch.across()), thick = float(patch.thick()), turned = float(patch.turned);
    const float near = kNear + 0.25f * across;
    Most most{std::vector<float>(kLanes * bound_lanes_.size()), std::vector<double>(bound_lanes_.size())};
    for (size_t i = 0; i < bound_lanes_.size(); ++i) {
        const BoundLanes& lamps = bound_lanes_[i];
        const Lanes3 to = lamps.place - from;
        const Lanes distance2 = dot(to, to) + near * near, inverse = inverse_root(distance2);
        const Lanes above = dot(to, up) + thick + turned * distance2 * inverse;
        const Lanes cosine = (dot(to, lamps.back) + across) * inverse,
                    ramp = min(max(lamps.slope * cosine + lamps.offset, Lanes{}), all_of(1));
        // NaN, of lamps that are nowhere, becomes 0.
        const Lanes lux = max(lamps.largest * ramp * ramp * above * inverse * inverse * inverse, Lanes{});
        std::memcpy(&most.lux[kLanes * i], &lux, sizeof lux);
    }
    for (const size_t i : directional_) {
        const double cosine = glm::dot(patch.normal, bounds_[i].back) + patch.turned;
        most.lux[i] = float(std::clamp(bounds_[i].largest * cosine, 0.0, kBright));
    }
    const auto is_lit = [&](const SurfacePlace& place, size_t i) {
        return lights(i, place.node, way_to(bounds_[i], place.point, place.normal));
    };
    if (std::ranges::any_of(
            places, [&](uint32_t node) { return node != scene::kNone && in_fixture_[node]; }, &SurfacePlace::node))
        for (size_t i = 0; i < lamps_.size(); ++i)
            if (most.lux[i] > 0 && std::ranges::none_of(places, [&](const auto& place) { return is_lit(place, i); }))
                most.lux[i] = 0;
    double sum = 0;
    for (size_t i = 0; i < most.ends.size(); ++i) {
        const float* lux = &most.lux[kLanes * i];
        most.ends[i] = sum += double((lux[0] + lux[1]) + (lux[2] + lux[3]));
    }
    return most;
}

// Some lamps, each as often as it gives light, in even steps: with 1 over how often that is on average.
std::vector<LampLight::Candidate> LampLight::choose(const Most& most, uint32_t count, Random& random) const {
    std::vector<Candidate> chosen;
    const double all = most.ends.empty() ? 0 : most.ends.back();
    if (!(all > kDark)) return chosen;
    Steps steps(random.next(), all, count);
    for (size_t b = 0; b < most.ends.size(); ++b) {
        if (!steps.falls_before(most.ends[b])) continue;
        double end = b == 0 ? 0 : most.ends[b - 1];
        for (size_t i = kLanes * b; i < kLanes * (b + 1); ++i) {
            end += double(most.lux[i]);
            const bool last = i + 1 == kLanes * (b + 1);
            const uint32_t times = steps.take_before(last ? most.ends[b] : end);
            if (times > 0 && most.lux[i] > 0) chosen.push_back({i, times * all / (double(most.lux[i]) * count)});
        }
    }
    return chosen;
}

void LampLight::sample(std::span<const SurfacePlace> places, uint32_t shadow_rays, Random& random,
                       std::vector<Share>& shares) const {
    // First by about what lamps may give at most; then, of some, by what they give each place.
    const std::vector<Candidate> some = choose(most_at(places), 4 * shadow_rays, random);
    std::vector<double> lux(some.size());
    for (const SurfacePlace& place : places) {
        double sum = 0;
        for (size_t c = 0; c < some.size(); ++c) {
            const Way way = way_to(bounds_[some[c].lamp], place.point, place.normal);
            lux[c] = lights(some[c].lamp, place.node, way) ? some[c].weight * unshadowed(some[c].lamp, way) : 0;
            sum += lux[c];
        }
        if (!(sum > kDark)) continue;
        Steps steps(random.next(), sum, shadow_rays);
        double end = 0;
        for (size_t c = 0; c < some.size(); ++c) {
            const uint32_t times = steps.take_before(end += lux[c]);
            const size_t i = some[c].lamp;
            if (times == 0 || blocked(i, way_to(bounds_[i], place.point, place.normal), place.point, place.normal))
                continue;
            const double share = times * sum / (double(shadow_rays) * double(places.size()));
            shares.push_back({lamps_[i].node, share * glm::dvec3(lamps_[i].lamp->colour)});
        }
    }
}

}  // namespace vesper::transport
