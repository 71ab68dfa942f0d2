#include "gpu_scene/silhouette.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"

namespace vesper::gpu_scene {
namespace {

using glm::dmat2, glm::dvec2, glm::dvec3;

// Cuts a convex polygon with a half space (Sutherland and Hodgman 1974). `inside` is a distance, positive within.
template <class Point, class Inside>
std::vector<Point> cut(const std::vector<Point>& polygon, Inside inside) {
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

// The map of the image that widens an ellipse of half axes p, q to half axes of at least `smallest`.
dmat2 widening_of(dvec2 p, dvec2 q, double smallest) {
    const double xx = p.x * p.x + q.x * q.x, xy = p.x * p.y + q.x * q.y, yy = p.y * p.y + q.y * q.y;
    const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
    const double mean = (xx + yy) / 2, spread = std::hypot((xx - yy) / 2, xy);
    const dvec2 axis(std::cos(angle), std::sin(angle));
    const double longer = std::sqrt(mean + spread), shorter = std::abs(p.x * q.y - p.y * q.x) / longer;
    const double a = std::max(1.0, smallest / longer), b = std::max(1.0, smallest / shorter);
    const dmat2 along = glm::outerProduct(axis, axis);
    return a * along + b * (dmat2(1) - along);
}

}  // namespace

Silhouette project(const Opening& opening, const View& view, double smallest) {
    const dvec2 scale(view.ray_scale()), offset(view.ray_offset());
    const auto pixel = [&](dvec3 v) { return (dvec2(v) / -v.z - offset) / scale; };
    const double depth = -opening.centre.z;
    const bool before = depth > view.near;
    const dvec2 tangent = before ? dvec2(opening.centre) / depth : dvec2(0);
    const auto extent = [&](dvec3 axis) { return (dvec2(axis) + tangent * axis.z) / (depth * scale); };
    const double radius = std::max(glm::length(extent(opening.across)), glm::length(extent(opening.along)));
    const double pixels = before ? radius : 1e4;

    Silhouette silhouette;
    const std::vector<dvec3> seen = cut(corners(opening, pixels), [&](dvec3 v) { return -v.z - view.near; });
    for (const dvec3& point : seen) silhouette.vertices.push_back(pixel(point));
    if (before) {
        const dmat2 widen = widening_of(extent(opening.across), extent(opening.along), smallest);
        const dvec2 centre = pixel(opening.centre);
        for (dvec2& v : silhouette.vertices) v = centre + widen * (v - centre);
        silhouette.widening = glm::determinant(widen);
    }
    const dvec2 size(view.extent.width, view.extent.height);
    for (const int c : {0, 1}) {
        silhouette.vertices = cut(silhouette.vertices, [c](dvec2 v) { return v[c]; });
        silhouette.vertices = cut(silhouette.vertices, [c, size](dvec2 v) { return size[c] - v[c]; });
    }
    const double area = silhouette.vertices.empty() ? 0 : signed_area(silhouette.vertices);
    if (area < 0) std::reverse(silhouette.vertices.begin(), silhouette.vertices.end());
    if (!(std::abs(area) > 1e-9) || !std::isfinite(silhouette.widening)) silhouette.vertices.clear();
    return silhouette;
}

}  // namespace vesper::gpu_scene
