#include "vision/light_elsewhere.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <tuple>

#include "base/angle.h"

namespace vesper::vision {
namespace {

using glm::dvec2, glm::dvec3, glm::ivec2, glm::vec3, glm::vec4;

constexpr int kFinest = 2;  // level at which light from beyond a guard begins: finer ones have no say in what is shown
constexpr double kNear =
    1.0 / 16;  // nodes are taken together that are no further apart than this, times their distance from what is shown:
constexpr double kFar =
    1.0 /
    8;  // so wide a tent makes 0.3 % more of a function that falls with the cube of the angle, or 0.5 % with its square
constexpr int kParts = 8;                             // of a pixel, along each axis, that is too large
constexpr double kInside = 0.01;                      // px, from the edge of a picture to where it still is
constexpr double kUneven = 1e-3;                      // of shares under a tent
constexpr double kWholeAngle = 90, kNoneAngle = 100;  // deg
constexpr double kWidest =
    2.5 *
    kRadiansPerDegree;  // between nodes that are taken together, so that what goes from there to there is straight

// Points outwards from the eye: all planes have it on their positive side. Convex.
struct Pyramid {
    std::vector<dvec3> planes;

    explicit Pyramid(const EyePicture& p, dvec2 low, dvec2 high)
        : planes{p.turn * dvec3(1, 0, low.x), p.turn * dvec3(-1, 0, -high.x), p.turn * dvec3(0, 1, low.y),
                 p.turn * dvec3(0, -1, -high.y)} {}
    explicit Pyramid(const EyePicture& p) : Pyramid(p, p.image.low, p.image.high) {}
    bool has(dvec3 d) const {
        return std::all_of(planes.begin(), planes.end(), [&](dvec3 n) { return glm::dot(n, d) > 0; });
    }
};

// Whether an edge of the pyramid may lie between the corners.
bool crosses(const Pyramid& pyramid, const std::array<dvec3, 4>& corners) {
    bool all = true;
    for (const dvec3 n : pyramid.planes) {
        const auto inside = std::count_if(corners.begin(), corners.end(), [&](dvec3 c) { return glm::dot(n, c) > 0; });
        if (inside == 0) return false;
        all = all && inside == 4;
    }
    return !all;
}

double angle(dvec3 a, dvec3 b) { return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)); }

// Of a direction to an arc of a great circle, rad; all of unit length.
double angle_to_arc(dvec3 d, dvec3 a, dvec3 b) {
    const dvec3 n = glm::normalize(glm::cross(a, b));
    if (glm::dot(glm::cross(n, a), d) > 0 && glm::dot(glm::cross(b, n), d) > 0)
        return std::asin(std::min(1.0, std::abs(glm::dot(n, d))));
    return std::min(angle(d, a), angle(d, b));
}

// What is shown of a picture.
struct Shown {
    Pyramid pyramid;
    std::array<dvec3, 4> corners;

    static Shown of(const EyePicture& p) {
        const dvec2 edge = double(p.guard) * p.image.pixel(), low = p.image.low + edge, high = p.image.high - edge;
        const auto at = [&](double x, double y) { return glm::normalize(p.turn * dvec3(x, y, -1)); };
        return {Pyramid(p, low, high), {at(low.x, low.y), at(high.x, low.y), at(high.x, high.y), at(low.x, high.y)}};
    }
    double angle_to(dvec3 d) const {
        if (pyramid.has(d)) return 0;
        double least = std::numbers::pi;
        for (size_t i = 0; i < 4; ++i) least = std::min(least, angle_to_arc(d, corners[i], corners[(i + 1) % 4]));
        return least;
    }
};

// How far within a picture a direction is, px from the nearest edge; 0: it is not.
double depth(const EyePicture& p, dvec3 direction) {
    const dvec3 d = glm::transpose(p.turn) * direction;
    if (!(d.z < 0)) return 0;
    const dvec2 at = p.image.pixels_at(dvec2(d) / -d.z), left = glm::min(at, dvec2(p.image.width, p.image.height) - at);
    return std::max(0.0, std::min(left.x, left.y));
}

// How much a direction counts as picture `from` has it, for what `own` takes: beyond the own one, pictures share it by
// their depths there, so that none begins or ends with a step, which a small lamp would fall through or count twice at.
// Within the own one, all that it has is there already; but over its guard others take over as its edge comes nearer,
// and what it has itself counts as much less.
double share(std::span<const EyePicture> pictures, size_t own, size_t from, dvec3 direction) {
    double others = 0, here = 0;
    for (size_t i = 0; i < pictures.size(); ++i) (i == own ? here : others) += depth(pictures[i], direction);
    if (others == 0) return 0;
    const double guard = std::max(pictures[own].guard, 1);
    const double taken = here > 0 ? std::max(0.0, 1 - here / guard) * std::min(1.0, others / guard) : 1;
    return from == own ? -taken : taken * depth(pictures[from], direction) / others;
}

// The quartic B-spline, texels from its middle.
double spline(double x) {
    const auto fourth = [](double a) { return a > 0 ? a * a * a * a : 0; };
    x = std::abs(x);
    return (fourth(2.5 - x) - 5 * fourth(1.5 - x) + 10 * fourth(0.5 - x)) / 24;
}

}  // namespace

LightElsewhere::Veil::Veil(const EyeScatter& psf) : psf_(psf) {
    constexpr int kSteps = 8192;
    for (int i = 0; i <= kSteps; ++i) {
        const double theta = 2 * std::asin(double(i) / kSteps) / kRadiansPerDegree;
        table_.push_back(float(psf(std::min(theta, kWholeAngle)) *
                               std::clamp((kNoneAngle - theta) / (kNoneAngle - kWholeAngle), 0.0, 1.0)));
    }
}

double LightElsewhere::Veil::at(double cosine) const {
    const double sine = std::sqrt(std::max(0.0, 0.5 - 0.5 * cosine)),
                 at = sine * double(table_.size() - 1);  // of half the angle
    if (sine < 0.02)
        return psf_(2 * std::asin(sine) /
                    kRadiansPerDegree);  // within 2.3 degrees it is too steep for a table; beyond, that is good to 1e-4
    const size_t first = std::min(size_t(at), table_.size() - 2);
    return std::lerp(double(table_[first]), double(table_[first + 1]), at - double(first));
}

// Goes through the nodes of another picture from the coarsest down, and divides tents among those below until each can
// be taken as one.
class LightElsewhere::Finder {
public:
    Finder(const LightElsewhere& to, std::span<const EyePicture> pictures, size_t own, size_t other)
        : to_(to),
          pictures_(pictures),
          own_(own),
          other_(other),
          from_(pictures[other]),
          nodes_(from_.image),
          shown_(Shown::of(to.own_)) {
        bounds_ = {Pyramid(pictures[own]), shown_.pyramid};
        for (size_t k = 0; k < pictures.size(); ++k)
            if (k != own && k != other) bounds_.emplace_back(pictures[k]);
    }

    Giver find() {
        std::vector<double> weights(size_t(nodes_.sizes.back().x * nodes_.sizes.back().y), 1);
        for (int level = nodes_.levels() - 1; level >= 0; --level) {
            const ivec2 size = nodes_.sizes[size_t(level)],
                        below = level > 0 ? nodes_.sizes[size_t(level) - 1] : ivec2(0);
            std::vector<double> rest(size_t(below.x) * size_t(below.y), 0);
            for (int y = 0; y < size.y; ++y)
                for (int x = 0; x < size.x; ++x) {
                    const double weight = weights[size_t(y) * size_t(size.x) + size_t(x)];
                    if (weight == 0 || take(level, {x, y}, weight)) continue;
                    for (int v = -1; v <= 1; ++v)
                        for (int u = -1; u <= 1; ++u) {
                            const ivec2 child = 2 * ivec2(x, y) + ivec2(u, v);
                            if (child.x < 0 || child.y < 0 || child.x >= below.x || child.y >= below.y) continue;
                            rest[size_t(child.y) * size_t(below.x) + size_t(child.x)] +=
                                weight * (u == 0 ? 1 : 0.5) * (v == 0 ? 1 : 0.5);
                        }
                }
            weights = std::move(rest);
        }
        giver_.columns = columns_.size();
        number_nodes();
        return std::move(giver_);
    }

private:
    // Whether that is done; else the level below has to.
    bool take(int level, ivec2 node, double weight) {
        const dvec2 step(1 << level), size(from_.image.width, from_.image.height),
            place = LightNodes::place(level, node);
        const dvec2 low = glm::max(step * dvec2(node - 1) + 1.0, kInside),
                    high = glm::min(step * dvec2(node + 1), size - kInside);
        const std::array corners{from_.towards(low), from_.towards({high.x, low.y}), from_.towards(high),
                                 from_.towards({low.x, high.y})};
        const dvec3 direction = glm::normalize(from_.towards(place));
        const double part = share_of(direction);
        if (level > 0) {
            // One share for all under a tent, or pixel by pixel: tents of different sizes side by side do not keep a
            // slope.
            if (std::any_of(bounds_.begin(), bounds_.end(), [&](const Pyramid& p) { return crosses(p, corners); }))
                return false;
            if (std::any_of(corners.begin(), corners.end(),
                            [&](dvec3 corner) { return std::abs(share_of(corner) - part) > kUneven; }))
                return false;
        }
        if (part == 0) return true;
        const double distance = shown_.angle_to(direction), apart = spacing(level, place);
        const auto entry = entry_of(direction);
        const double most = entry ? kNear * distance : far_apart(distance);
        if (apart > most && level > 0) return false;
        const uint32_t index = nodes_.index(level, node);
        // A pixel of another resolution may be too large. Over the guard, where little is to be put right, none is.
        const bool within = bounds_.front().has(direction);
        const int parts = level > 0 || within ? 1 : std::clamp(int(std::ceil(apart / std::max(most, 1e-9))), 1, kParts);
        if (parts == 1) {
            give(index, level, place, direction, weight * part, distance);
            return true;
        }
        for (int y = 0; y < parts; ++y)
            for (int x = 0; x < parts; ++x) {
                const dvec2 at = dvec2(node) + (dvec2(x, y) + 0.5) / double(parts);
                const dvec3 towards = glm::normalize(from_.towards(at));
                if (const double there = share_of(towards); there != 0)
                    give(index, 0, at, towards, weight * there / (parts * parts), distance);
            }
        return true;
    }

    // From nodes of the picture to their places among those that are taken.
    void number_nodes() {
        std::vector<uint32_t>& taken = giver_.nodes;
        for (const Near& near : giver_.near) taken.push_back(near.node);
        for (const Far& far : giver_.far) taken.push_back(far.node);
        std::sort(taken.begin(), taken.end());
        taken.erase(std::unique(taken.begin(), taken.end()), taken.end());
        const auto number = [&](uint32_t& node) {
            node = uint32_t(std::lower_bound(taken.begin(), taken.end(), node) - taken.begin());
        };
        for (Near& near : giver_.near) number(near.node);
        for (Far& far : giver_.far) number(far.node);
    }

    double share_of(dvec3 direction) const { return share(pictures_, own_, other_, direction); }
    static double far_apart(double distance) { return std::min(kFar * distance, kWidest); }
    // Between nodes of a level at a place, rad.
    double spacing(int level, dvec2 place) const {
        const dvec3 at = from_.towards(place);
        const double step = double(1 << level);
        return std::max(angle(at, from_.towards(place + dvec2(step, 0))),
                        angle(at, from_.towards(place + dvec2(0, step))));
    }
    std::optional<ScatterEntry> entry_of(dvec3 direction) const {
        return scatter_entry(to_.own_.image, glm::transpose(to_.own_.turn) * direction, kFinest);
    }

    void give(uint32_t node, int level, dvec2 place, dvec3 direction, double weight, double distance) {
        if (const auto entry = entry_of(direction)) {
            giver_.near.push_back({node, float(weight), to_.splash(*entry)});
            return;
        }
        // Together with others about it, as far as they are alike from here.
        while (level + 1 < nodes_.levels() && spacing(level + 1, place) <= far_apart(distance)) ++level;
        const dvec2 at = (place - 0.5) / double(1 << level), first = glm::floor(at), part = at - first;
        for (int i = 0; i < 4; ++i) {
            const ivec2 side(i & 1, i >> 1);
            const double share = (side.x ? part.x : 1 - part.x) * (side.y ? part.y : 1 - part.y);
            if (share <= 0) continue;
            if (const auto column = column_of(level, ivec2(first) + side))
                giver_.far.push_back({node, *column, float(weight * share)});
        }
    }

    // What a place of another picture veils; nothing where it is behind all that takes.
    std::optional<uint32_t> column_of(int level, ivec2 node) {
        const auto known = columns_.find({level, node.x, node.y});
        if (known != columns_.end()) return known->second;
        const dvec3 direction = glm::normalize(from_.towards(LightNodes::place(level, node)));
        std::vector<float> veils;
        for (const dvec3 place : to_.places_) veils.push_back(float(to_.veil_.at(glm::dot(place, direction))));
        if (std::all_of(veils.begin(), veils.end(), [](float v) { return v == 0; })) return {};
        giver_.veils.insert(giver_.veils.end(), veils.begin(), veils.end());
        return columns_[{level, node.x, node.y}] = uint32_t(columns_.size());
    }

    const LightElsewhere& to_;
    std::span<const EyePicture> pictures_;
    size_t own_, other_;
    const EyePicture& from_;
    LightNodes nodes_;
    Shown shown_;
    std::vector<Pyramid> bounds_;  // at which shares have kinks; that of the own picture first
    std::map<std::tuple<int, int, int>, uint32_t> columns_;
    Giver giver_;
};

LightElsewhere::LightElsewhere(const EyeScatter& psf, std::span<const EyePicture> pictures, size_t own)
    : own_(pictures[own]),
      levels_(scatter_levels(own_.image)),
      veil_(psf),
      rows_(scatter_size(own_.image, levels_) + 2 * (kScatterReach + 1)) {
    for (int y = 0; y < rows_.y; ++y)
        for (int x = 0; x < rows_.x; ++x)
            places_.push_back(glm::normalize(own_.towards(std::exp2(levels_) * (dvec2(x, y) - (kScatterReach + 0.5)))));
    for (size_t other = 0; other < pictures.size(); ++other)
        givers_.push_back(Finder(*this, pictures, own, other).find());
}

LightElsewhere::Splash LightElsewhere::splash(const ScatterEntry& entry) const {
    const dvec2 place = entry.pixels / std::exp2(entry.level), first = glm::floor(place - 2.0),
                size = own_.image.pixel();
    const ivec2 stored = ivec2(first) + kScatterMargin;
    Splash made{.level = uint32_t(entry.level), .first = uint32_t(stored.y * stride(uint32_t(entry.level)) + stored.x)};
    const double luminance = 1 / (size.x * size.y * steradians_per_area(entry.tangents) * std::exp2(2 * entry.level));
    for (int i = 0; i < 5; ++i) {
        made.x[size_t(i)] = float(spline(first.x + i + 0.5 - place.x));
        made.y[size_t(i)] = float(spline(first.y + i + 0.5 - place.y) * luminance);
    }
    return made;
}

void LightElsewhere::add(std::vector<vec4>& level, const Splash& splash, int stride, vec3 light) {
    for (size_t y = 0; y < 5; ++y) {
        vec4* row = &level[splash.first + y * size_t(stride)];
        const vec4 part(splash.y[y] * light, 0);
        for (size_t x = 0; x < 5; ++x) row[x] += splash.x[x] * part;
    }
}

OffscreenLight LightElsewhere::of(std::span<const std::vector<vec3>> light, std::span<const UnseenLamp> lamps) const {
    OffscreenLight beyond;
    std::vector<int> strides;
    for (int l = 0; l <= levels_; ++l) {
        const ivec2 size = scatter_size(own_.image, l) + 2 * kScatterMargin;
        beyond.levels.emplace_back(l < kFinest ? 0 : size_t(size.x) * size_t(size.y), vec4(0));
        strides.push_back(size.x);
    }
    const size_t places = places_.size();
    std::array<std::vector<float>, 3> veil;
    veil.fill(std::vector<float>(places, 0));
    std::vector<vec3> columns;
    for (size_t picture = 0; picture < givers_.size(); ++picture) {
        const Giver& giver = givers_[picture];
        const std::vector<vec3>& from = light[picture];
        for (const Near& near : giver.near) {
            const vec3 lx = near.weight * from[near.node];
            if (lx != vec3(0)) add(beyond.levels[near.splash.level], near.splash, strides[near.splash.level], lx);
        }
        columns.assign(giver.columns, vec3(0));
        for (const Far& far : giver.far) columns[far.column] += far.weight * from[far.node];
        for (size_t i = 0; i < giver.columns; ++i)
            for (int c = 0; c < 3; ++c) {
                const float lx = columns[i][c], *weights = &giver.veils[i * places];
                float* sum = veil[size_t(c)].data();
                for (size_t p = 0; p < places; ++p) sum[p] += lx * weights[p];
            }
    }
    for (const UnseenLamp& lamp : lamps) {
        if (const auto entry = scatter_entry(own_.image, glm::transpose(own_.turn) * lamp.direction, kFinest)) {
            add(beyond.levels[size_t(entry->level)], splash(*entry), strides[size_t(entry->level)],
                vec3(lamp.illuminance));
            continue;
        }
        for (size_t p = 0; p < places; ++p) {
            const float per_lux = float(veil_.at(glm::dot(places_[p], lamp.direction)));
            for (int c = 0; c < 3; ++c) veil[size_t(c)][p] += per_lux * float(lamp.illuminance[c]);
        }
    }
    // Sharpened by what the splines on the way back blur (variance: 5/12 texels^2).
    const float sharpening = float(5.0 / 24 * (1 - std::exp2(-2 * levels_)));
    const size_t row = size_t(rows_.x);
    for (size_t y = 1; y + 1 < size_t(rows_.y); ++y)
        for (size_t x = 1; x + 1 < row; ++x) {
            vec4 sharp(0);
            for (int c = 0; c < 3; ++c) {
                const float* at = &veil[size_t(c)][y * row + x];
                sharp[c] =
                    std::max(0.0f, at[0] - sharpening * (at[1] + at[-1] + at[rows_.x] + at[-rows_.x] - 4 * at[0]));
            }
            beyond.veil.push_back(sharp);
        }
    return beyond;
}

uint64_t LightElsewhere::bytes() const {
    uint64_t sum = 0;
    for (const Giver& g : givers_)
        sum += g.nodes.size() * sizeof(uint32_t) + g.near.size() * sizeof(Near) + g.far.size() * sizeof(Far) +
               g.veils.size() * sizeof(float);
    return sum;
}

}  // namespace vesper::vision
