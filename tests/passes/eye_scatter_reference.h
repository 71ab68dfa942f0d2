// Light scattered in the eye: the definition, and the fitted pyramid step by step, in double.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/glm.hpp>

#include "eye/scatter.h"
#include "vision/light_elsewhere.h"
#include "vision/scatter_fit.h"

namespace vesper::reference {

using glm::dvec2, glm::dvec3, glm::ivec2;

/// Light of a rectangle of texels; none beyond it.
struct Plane {
    ivec2 size{0};
    std::vector<dvec3> texels;

    explicit Plane(ivec2 extent) : size(extent), texels(size_t(extent.x * extent.y), dvec3(0)) {}
    bool has(ivec2 p) const { return p.x >= 0 && p.y >= 0 && p.x < size.x && p.y < size.y; }
    dvec3& operator[](ivec2 p) { return texels[size_t(p.y * size.x + p.x)]; }
    dvec3 at(ivec2 p) const { return has(p) ? texels[size_t(p.y * size.x + p.x)] : dvec3(0); }
};

// --- The definition: seen(q) = integral over directions of L * G(angle to q), pixels being of uniform luminance. ---

inline dvec3 direction_of(const vision::ImageAngles& image, dvec2 pixels) {
    const dvec2 span = image.high - image.low;
    return glm::normalize(
        dvec3(image.low.x + span.x * pixels.x / image.width, image.high.y - span.y * pixels.y / image.height, -1));
}

inline double degrees_apart(dvec3 a, dvec3 b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 180 / std::numbers::pi;
}

/// sr, about a direction, of the part `scale` x `scale` of a pixel.
inline double solid_angle(const vision::ImageAngles& image, dvec3 direction, double scale = 1) {
    const dvec2 span = image.high - image.low;
    const double cosine = -direction.z;
    return scale * scale * span.x * span.y / (double(image.width) * image.height) * cosine * cosine * cosine;
}

/// What a pixel of 1 cd/m^2 is seen with from the middle of another, by `parts` x `parts` midpoints. In its own middle
/// the function is too sharp for that: rings about the axis, of which the pixel has a part.
inline double exact_response(const vision::EyeScatter& psf, const vision::ImageAngles& image, ivec2 to, ivec2 from,
                             int parts) {
    const dvec3 axis = direction_of(image, dvec2(to) + 0.5);
    if (to == from) {
        // Rays from the middle to the edge, straight in the picture: each has the light within the angle of its end.
        constexpr int kRays = 720;
        const dvec3 side = glm::normalize(glm::cross(axis, dvec3(0.3, 1, 0.2))), up = glm::cross(side, axis);
        double sum = 0;
        for (int i = 0; i < kRays; ++i) {
            const double turn = 2 * std::numbers::pi * (i + 0.5) / kRays;
            double low = 0, high = 90;  // degrees, by halving
            for (int k = 0; k < 45; ++k) {
                const double t = 0.5 * (low + high), a = t * std::numbers::pi / 180;
                const dvec3 d = std::cos(a) * axis + std::sin(a) * (std::cos(turn) * side + std::sin(turn) * up);
                const dvec2 span = image.high - image.low, tangents = dvec2(d) / -d.z;
                const dvec2 p((tangents.x - image.low.x) / span.x * image.width,
                              (image.high.y - tangents.y) / span.y * image.height);
                const bool within = d.z < 0 && std::abs(p.x - from.x - 0.5) < 0.5 && std::abs(p.y - from.y - 0.5) < 0.5;
                (within ? low : high) = t;
            }
            sum += psf.within(low);
        }
        return sum / kRays;
    }
    double sum = 0;
    for (int y = 0; y < parts; ++y)
        for (int x = 0; x < parts; ++x) {
            const dvec3 d = direction_of(image, dvec2(from) + (dvec2(x, y) + 0.5) / double(parts));
            sum += psf(degrees_apart(axis, d)) * solid_angle(image, d, 1.0 / parts);
        }
    return sum;
}

inline int parts_for(ivec2 to, ivec2 from) {
    const int away = std::max(std::abs(to.x - from.x), std::abs(to.y - from.y));
    return away <= 1 ? 48 : away <= 3 ? 20 : away <= 8 ? 8 : away <= 30 ? 4 : away <= 100 ? 2 : 1;
}

/// Seen at one pixel: every pixel, and lamps outside. Exact, and slow.
inline dvec3 exact_at(const vision::EyeScatter& psf, const vision::ImageAngles& image, const Plane& scene,
                      const std::vector<eye::OffscreenLamp>& lamps, ivec2 to) {
    dvec3 sum(0);
    for (int y = 0; y < scene.size.y; ++y)
        for (int x = 0; x < scene.size.x; ++x)
            if (scene.at({x, y}) != dvec3(0))
                sum += scene.at({x, y}) * exact_response(psf, image, to, {x, y}, parts_for(to, {x, y}));
    const dvec3 axis = direction_of(image, dvec2(to) + 0.5);
    for (const eye::OffscreenLamp& lamp : lamps) {
        if (lamp.direction.z < 0) sum += psf(degrees_apart(axis, lamp.direction)) * lamp.illuminance;
    }
    return sum;
}

/// For whole frames: as exact_at within 64 pixels, sums over blocks of 4 x 4 at the middle of their light beyond. A
/// block of 4 px seen from 64 px is off by n^2 / 2 * 1.25 / 64^2 for a function of power n: 0.1 % for n = 2.5.
class ExactFrame {
public:
    ExactFrame(const vision::EyeScatter& psf, const vision::ImageAngles& image, const Plane& scene)
        : psf_(psf), image_(image), scene_(scene), blocks_((scene.size + 3) / 4), middles_(blocks_.size) {
        for (int y = 0; y < scene.size.y; ++y)
            for (int x = 0; x < scene.size.x; ++x) {
                const dvec3 direction = direction_of(image, dvec2(x, y) + 0.5),
                            light = scene.at({x, y}) * solid_angle(image, direction);
                blocks_[{x / 4, y / 4}] += light;
                middles_[{x / 4, y / 4}] += (light.x + light.y + light.z) * direction;
            }
    }
    dvec3 at(ivec2 to) const {
        constexpr int kNear = 16;  // blocks
        const ivec2 block = to / 4;
        const dvec3 axis = direction_of(image_, dvec2(to) + 0.5);
        dvec3 sum(0);
        for (int v = 0; v < blocks_.size.y; ++v)
            for (int u = 0; u < blocks_.size.x; ++u)
                if (std::abs(u - block.x) > kNear || std::abs(v - block.y) > kNear)
                    sum += psf_(degrees_apart(axis, middles_.at({u, v}))) * blocks_.at({u, v});
        const ivec2 low = glm::max(4 * (block - kNear), ivec2(0)),
                    high = glm::min(4 * (block + kNear + 1), scene_.size);
        for (int y = low.y; y < high.y; ++y)
            for (int x = low.x; x < high.x; ++x)
                sum += scene_.at({x, y}) * exact_response(psf_, image_, to, {x, y}, parts_for(to, {x, y}));
        return sum;
    }

private:
    const vision::EyeScatter& psf_;
    const vision::ImageAngles& image_;
    const Plane& scene_;
    Plane blocks_, middles_;
};

// --- The pyramid: what the passes do. ---

inline double quartic(double x) {
    const auto fourth = [](double a) { return a > 0 ? a * a * a * a : 0; };
    double sum = 0;  // of its knots, -2.5 .. 2.5
    const double signs[]{1, -5, 10, -10, 5, -1};
    for (int k = 0; k < 6; ++k) sum += signs[k] * fourth(x + 2.5 - k);
    return sum / 24;
}

inline int floor_half(int i) { return int(std::floor(i / 2.0)); }

/// One level up. `margin` is that of `from`, which begins there; lamps as GpuScatter::lamps_of has them.
/// `beyond`: of each texel, from other pictures; or none.
inline Plane scatter_up(const Plane& from, int margin, ivec2 size, const std::vector<glm::vec4>& lamps,
                        const std::vector<glm::vec4>& beyond = {}) {
    Plane to(size + 2 * vision::kScatterMargin);
    for (int y = 0; y < to.size.y; ++y)
        for (int x = 0; x < to.size.x; ++x) {
            const ivec2 j = ivec2(x, y) - vision::kScatterMargin;
            dvec3 sum(0);
            for (int v = 0; v < 6; ++v)
                for (int u = 0; u < 6; ++u)
                    sum += vision::kScatterFilter[size_t(u)] * vision::kScatterFilter[size_t(v)] / 1024 *
                           from.at(2 * j - 2 + ivec2(u, v) + margin);
            for (size_t i = 0; i + 1 < lamps.size(); i += 2) {
                const dvec2 d = dvec2(j) + 0.5 - dvec2(lamps[i]);
                sum += quartic(d.x) * quartic(d.y) * dvec3(lamps[i + 1]);
            }
            if (!beyond.empty()) sum += dvec3(beyond[size_t(y) * size_t(to.size.x) + size_t(x)]);
            to[{x, y}] = sum;
        }
    return to;
}

/// Taps of a level at a place of the picture (px), linear between nodes.
inline std::vector<double> taps_at(const vision::ScatterFit& fit, dvec2 pixels, int level) {
    const dvec2 place = glm::clamp(pixels / dvec2(fit.image.width, fit.image.height), 0.0, 1.0) * dvec2(fit.nodes - 1);
    const ivec2 first = glm::min(ivec2(place), fit.nodes - 2);
    std::vector<double> taps(size_t(fit.taps()), 0);
    for (int i = 0; i < 4; ++i) {
        const ivec2 node = first + ivec2(i & 1, i >> 1);
        const dvec2 near = 1.0 - glm::abs(place - dvec2(node));
        const float* of = &fit.kernels[size_t(((node.y * fit.nodes.x + node.x) * fit.levels + level) * fit.taps())];
        for (size_t t = 0; t < taps.size(); ++t) taps[t] += near.x * near.y * double(of[t]);
    }
    return taps;
}

/// What a pixel near the border keeps beyond that, linear between places: every one of those near a corner, some of the
/// sides.
inline double edge_light(const vision::ScatterFit& fit, ivec2 pixel) {
    const vision::EdgeLight& edge = fit.edge;
    const ivec2 size(fit.image.width, fit.image.height), last(edge.x.places() - 1, edge.y.places() - 1);
    const ivec2 away = glm::min(pixel, size - 1 - pixel);
    if (away.x >= edge.x.deep && away.y >= edge.y.deep) return 0;
    const dvec2 place(edge.x.place(pixel.x), edge.y.place(pixel.y));
    const ivec2 first = glm::min(ivec2(place), last), next = glm::min(first + 1, last);
    const dvec2 part = place - dvec2(first);
    const auto at = [&](int x, int y) { return double(edge.kept[size_t(y * (last.x + 1) + x)]); };
    return glm::mix(glm::mix(at(first.x, first.y), at(next.x, first.y), part.x),
                    glm::mix(at(first.x, next.y), at(next.x, next.y), part.x), part.y);
}

/// The whole operator. Over strips of texels taps are linear from top to bottom, in the middle of their columns; every
/// two rows have those of the line between them, for what they give. Not finite: scatters nothing, and is not finite.
inline Plane scatter(const Plane& scene, const vision::ScatterFit& fit,
                     const std::vector<std::vector<glm::vec4>>& lamps = {}, const std::vector<glm::vec4>& veil = {},
                     const vision::OffscreenLight& beyond = {}) {
    Plane clean = scene;
    for (dvec3& t : clean.texels)
        if (!(std::abs(t.x) <= 3.4e38 && std::abs(t.y) <= 3.4e38 && std::abs(t.z) <= 3.4e38)) t = dvec3(0);
    std::vector<Plane> levels{clean};
    for (int l = 1; l <= fit.levels; ++l)
        levels.push_back(scatter_up(levels.back(), l == 1 ? 0 : vision::kScatterMargin,
                                    vision::scatter_size(fit.image, l),
                                    lamps.empty() ? std::vector<glm::vec4>{} : lamps[size_t(l)],
                                    beyond.levels.empty() ? std::vector<glm::vec4>{} : beyond.levels[size_t(l)]));

    Plane seen(fit.top_rows());
    const size_t columns = levels.back().texels.size();
    for (size_t r = 0; r < seen.texels.size(); ++r) {
        if (!veil.empty()) seen.texels[r] = dvec3(veil[r]);
        if (!beyond.veil.empty()) seen.texels[r] += dvec3(beyond.veil[r]);
        for (size_t c = 0; c < columns; ++c)
            seen.texels[r] += double(fit.top[r * columns + c]) * levels.back().texels[c];
    }
    const double spline[2][3]{{5.0 / 16, 10.0 / 16, 1.0 / 16}, {1.0 / 16, 10.0 / 16, 5.0 / 16}};
    for (int l = fit.levels - 1; l >= 0; --l) {
        const int margin = l == 0 ? 0 : vision::kScatterReach, inner = l == 0 ? 0 : vision::kScatterMargin;
        Plane made(vision::scatter_size(fit.image, l) + 2 * margin);
        const ivec2 strip(fit.strip.x, vision::scatter_strip(fit.image, fit.nodes, l, fit.strip.y));
        const std::vector<ivec2> taps = vision::scatter_taps(fit.reach);
        for (int sy = 0; sy < made.size.y; sy += strip.y)
            for (int sx = 0; sx < made.size.x; sx += strip.x) {
                const dvec2 upper = dvec2(ivec2(sx, sy) - margin) + dvec2(0.5 * strip.x, 0),
                            lower = upper + dvec2(0, strip.y);
                const std::vector<double> above = taps_at(fit, std::exp2(l) * upper, l),
                                          below = taps_at(fit, std::exp2(l) * lower, l);
                for (int y = sy; y < std::min(sy + strip.y, made.size.y); ++y)
                    for (int x = sx; x < std::min(sx + strip.x, made.size.x); ++x) {
                        const ivec2 at = ivec2(x, y) - margin;
                        dvec3 sum(0);
                        for (int v = 0; v < 3; ++v)
                            for (int u = 0; u < 3; ++u)
                                sum += spline[at.x & 1][u] * spline[at.y & 1][v] *
                                       seen.at(ivec2(floor_half(at.x), floor_half(at.y)) - 1 + ivec2(u, v) +
                                               vision::kScatterReach);
                        for (size_t t = 0; t < above.size(); ++t)
                            for (const int side : {1, -1}) {
                                const ivec2 d = side * taps[t];
                                const double part = (2 * floor_half(y - sy + d.y) + 1.0) / strip.y;
                                const Plane& from = l == 0 && t == 0 ? scene : levels[size_t(l)];
                                if (t > 0 || side > 0)
                                    sum += glm::mix(above[t], below[t], part) * from.at(at + d + inner);
                            }
                        if (l == 0) sum += edge_light(fit, at) * clean.at(at);
                        made[{x, y}] = sum;
                    }
            }
        seen = made;
    }
    return seen;
}

}  // namespace vesper::reference
