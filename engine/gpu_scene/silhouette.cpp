#include "gpu_scene/silhouette.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angle.h"

namespace vesper::gpu_scene {
namespace {

using glm::dmat2, glm::dvec2, glm::dvec3;

// Cuts a convex polygon with a half space (Sutherland and Hodgman 1974). `inside` is a distance, positive within.
template <class Point, class Inside>
std::vector<Point> cut(std::vector<Point> polygon, Inside inside) {
    if (std::ranges::all_of(polygon, [&](const Point& p) { return inside(p) >= 0; })) return polygon;
    std::vector<Point> kept;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double from = inside(a), to = inside(b);
        if (from >= 0) kept.push_back(a);
        if ((from >= 0) != (to >= 0)) kept.push_back(a + (b - a) * (from / (from - to)));
    }
    return kept;
}

std::vector<dvec3> corners(const Opening& o, double pixels) {
    if (!o.round)
        return {o.centre - o.across - o.along, o.centre + o.across - o.along, o.centre + o.across + o.along,
                o.centre - o.across + o.along};
    // The polygon's edge strays from the ellipse by radius (pi / n)^2 / 4 either way.
    const int n = std::clamp(4 * int(std::ceil(0.25 * kPi * std::sqrt(pixels / 0.2))), 8, 128);
    const double scale = std::sqrt(2 * kPi / (n * std::sin(2 * kPi / n)));
    std::vector<dvec3> points;
    for (int i = 0; i < n; ++i) {
        const double angle = 2 * kPi * (i + 0.5) / n;
        points.push_back(o.centre + scale * (std::cos(angle) * o.across + std::sin(angle) * o.along));
    }
    return points;
}

double signed_area(const std::vector<dvec2>& polygon) {
    double twice = 0;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const dvec2 a = polygon[i] - polygon[0], b = polygon[(i + 1) % polygon.size()] - polygon[0];
        twice += a.x * b.y - b.x * a.y;
    }
    return twice / 2;
}

// Of the ellipse of half axes p, q.
struct Axes {
    dvec2 longer;  // direction
    double long_half, short_half;
};

Axes axes_of(dvec2 p, dvec2 q) {
    const double xx = p.x * p.x + q.x * q.x, xy = p.x * p.y + q.x * q.y, yy = p.y * p.y + q.y * q.y;
    const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
    const double mean = (xx + yy) / 2, spread = std::hypot((xx - yy) / 2, xy);
    const double longer = std::sqrt(mean + spread);
    return {{std::cos(angle), std::sin(angle)}, longer, std::abs(p.x * q.y - p.y * q.x) / longer};
}

// The map of the image that widens an ellipse to half axes of at least `smallest`.
dmat2 widening_of(const Axes& axes, double smallest) {
    const double a = std::max(1.0, smallest / axes.long_half), b = std::max(1.0, smallest / axes.short_half);
    const dmat2 along = glm::outerProduct(axes.longer, axes.longer);
    return a * along + b * (dmat2(1) - along);
}

struct Pixels {
    dvec2 scale, offset;
    explicit Pixels(const View& view) : scale(view.ray_scale()), offset(view.ray_offset()) {}
    dvec2 of(dvec3 v) const { return (dvec2(v) / -v.z - offset) / scale; }
};

void widen(Silhouette& silhouette, const Axes& axes, dvec2 centre, double smallest) {
    const dmat2 wider = widening_of(axes, smallest);
    for (dvec2& v : silhouette.vertices) v = centre + wider * (v - centre);
    silhouette.widening = glm::determinant(wider);
    silhouette.width = 2 * axes.short_half, silhouette.length = 2 * axes.long_half;
}

// Leaves what is within the image, with y down, if anything is.
void cut_to_image(Silhouette& silhouette, const View& view) {
    const dvec2 size(view.extent.width, view.extent.height);
    for (const int c : {0, 1}) {
        silhouette.vertices = cut(std::move(silhouette.vertices), [c](dvec2 v) { return v[c]; });
        silhouette.vertices = cut(std::move(silhouette.vertices), [c, size](dvec2 v) { return size[c] - v[c]; });
    }
    const double area = silhouette.vertices.empty() ? 0 : signed_area(silhouette.vertices);
    if (area < 0) std::reverse(silhouette.vertices.begin(), silhouette.vertices.end());
    if (!(std::abs(area) > 1e-9) || !std::isfinite(silhouette.widening)) silhouette.vertices.clear();
}

}  // namespace

Silhouette project(const Opening& opening, const View& view, double smallest) {
    const Pixels pixel(view);
    const double depth = -opening.centre.z;
    const bool before = depth > view.near;
    const dvec2 tangent = before ? dvec2(opening.centre) / depth : dvec2(0);
    const auto extent = [&](dvec3 axis) { return (dvec2(axis) + tangent * axis.z) / (depth * pixel.scale); };
    const dvec2 across = extent(opening.across), along = extent(opening.along);
    const double pixels = before ? std::max(glm::length(across), glm::length(along)) : 1e4;

    Silhouette silhouette;
    const std::vector<dvec3> seen = cut(corners(opening, pixels), [&](dvec3 v) { return -v.z - view.near; });
    for (const dvec3& point : seen) silhouette.vertices.push_back(pixel.of(point));
    if (before) widen(silhouette, axes_of(across, along), pixel.of(opening.centre), smallest);
    cut_to_image(silhouette, view);
    return silhouette;
}

Silhouette project(std::span<const dvec3> corners, const View& view, double smallest) {
    const Pixels pixel(view);
    const std::vector<dvec3> seen =
        cut(std::vector(corners.begin(), corners.end()), [&](dvec3 v) { return -v.z - view.near; });
    Silhouette silhouette;
    silhouette.vertices.reserve(seen.size());
    for (const dvec3& point : seen) silhouette.vertices.push_back(pixel.of(point));
    const bool before = std::ranges::all_of(corners, [&](dvec3 v) { return -v.z > view.near; });
    if (before) {
        const std::vector<dvec2>& v = silhouette.vertices;
        dvec2 centre(0);
        for (const dvec2& vertex : v) centre += vertex / double(v.size());
        const dvec2 a = v[0], b = v[1], c = v[2], d = v.back();
        const Axes axes = v.size() == 4 ? axes_of((b - a + c - d) / 4.0, (d - a + c - b) / 4.0)
                                        : axes_of((b - a) / 2.0, (2.0 * c - a - b) / 4.0);
        widen(silhouette, axes, centre, smallest);
    }
    cut_to_image(silhouette, view);
    return silhouette;
}

}  // namespace vesper::gpu_scene
