// What each pixel sees, by casting one ray against every surface. SPDX-License-Identifier: MIT
// Everything in the view frame: the eye at the origin, x right, y up, looking along -z.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

namespace vesper::reference {

using glm::dvec2, glm::dvec3, glm::dvec4;

enum class Wrapping { Repeat, Mirror, Clamp };
enum class Filter { Nearest, Bilinear, Area };  ///< Area: the mean over the pixel's footprint

/// A texture of linear values, rows from the top.
struct Texture {
    uint32_t width = 0, height = 0;
    std::vector<dvec4> texels;
    Wrapping wrap_u = Wrapping::Repeat, wrap_v = Wrapping::Repeat;

    static int64_t wrap(int64_t i, int64_t size, Wrapping how) {
        if (how == Wrapping::Clamp) return std::clamp<int64_t>(i, 0, size - 1);
        const int64_t period = how == Wrapping::Mirror ? 2 * size : size, m = ((i % period) + period) % period;
        return m < size ? m : 2 * size - 1 - m;
    }
    dvec4 texel(int64_t x, int64_t y) const {
        return texels[size_t(wrap(y, height, wrap_v) * width + wrap(x, width, wrap_u))];
    }
    dvec4 nearest(dvec2 uv) const {
        return texel(int64_t(std::floor(uv.x * width)), int64_t(std::floor(uv.y * height)));
    }
    dvec4 bilinear(dvec2 uv) const {
        const dvec2 at = uv * dvec2(width, height) - 0.5, low = glm::floor(at), f = at - low;
        const int64_t x = int64_t(low.x), y = int64_t(low.y);
        return glm::mix(glm::mix(texel(x, y), texel(x + 1, y), f.x),
                        glm::mix(texel(x, y + 1), texel(x + 1, y + 1), f.x), f.y);
    }
};

/// A material, as glTF has it, with linear values.
struct Surface {
    dvec4 base{1};  ///< reflectance and opacity
    double metallic = 0, roughness = 1;
    dvec3 emission{0};  ///< cd/m^2
    std::optional<Texture> base_texture, metallic_roughness_texture, emission_texture;
    std::optional<Texture> normal_texture;  ///< unit vectors; matt light goes by the length of their mean
    bool double_sided = false;
    double alpha_cutoff = 0;  ///< opacity below this is a hole; 0: none
};

/// Counter-clockwise seen from the front.
struct Triangle {
    std::array<dvec3, 3> position, normal;
    std::array<dvec2, 3> uv{};
    std::array<dvec4, 3> colour{dvec4(1), dvec4(1), dvec4(1)};
    uint32_t surface = 0;
};
struct Sphere {
    dvec3 centre{0};
    double radius = 1;
    uint32_t surface = 0;
};
struct EndlessPlane {
    dvec3 point{0}, normal{0, 1, 0};
    uint32_t surface = 0;
};

struct Geometry {
    std::vector<Triangle> triangles;
    std::vector<Sphere> spheres;
    std::vector<EndlessPlane> planes;
    std::vector<Surface> surfaces;
};

/// Where a ray through direction (x, y, -1) meets something.
struct Meeting {
    double depth = 0;  ///< along the view axis, m
    dvec3 normal{0};   ///< unit, as modelled
    dvec2 uv{0};
    dvec4 colour{1};
    uint32_t surface = 0;
    bool front = true;
    size_t which = 0;  ///< primitive: triangles, then spheres, then planes
};

/// Ray and triangle (Moeller and Trumbore 1997). Depth may be negative.
inline std::optional<Meeting> meet(const Triangle& t, dvec3 ray, bool bounded = true) {
    const dvec3 e1 = t.position[1] - t.position[0], e2 = t.position[2] - t.position[0], p = glm::cross(ray, e2);
    const double det = glm::dot(e1, p);
    if (det == 0) return std::nullopt;
    const dvec3 from = -t.position[0], q = glm::cross(from, e1);
    const double u = glm::dot(from, p) / det, v = glm::dot(ray, q) / det;
    if (bounded && (u < 0 || v < 0 || u + v > 1)) return std::nullopt;
    const double w = 1 - u - v;
    Meeting m;
    m.depth = glm::dot(e2, q) / det;
    m.normal = glm::normalize(w * t.normal[0] + u * t.normal[1] + v * t.normal[2]);
    m.uv = w * t.uv[0] + u * t.uv[1] + v * t.uv[2];
    m.colour = w * t.colour[0] + u * t.colour[1] + v * t.colour[2];
    m.surface = t.surface;
    m.front = det > 0;
    return m;
}

inline std::vector<Meeting> meet(const Sphere& s, dvec3 ray) {
    const double a = glm::dot(ray, ray), b = glm::dot(ray, s.centre),
                 c = glm::dot(s.centre, s.centre) - s.radius * s.radius;
    const double root = b * b - a * c;
    if (root < 0) return {};
    std::vector<Meeting> both;
    for (double sign : {-1.0, 1.0}) {
        Meeting m;
        m.depth = (b + sign * std::sqrt(root)) / a;
        m.normal = (ray * m.depth - s.centre) / s.radius;
        m.surface = s.surface;
        m.front = glm::dot(m.normal, ray) < 0;
        both.push_back(m);
    }
    return both;
}

inline std::optional<Meeting> meet(const EndlessPlane& p, dvec3 ray) {
    const double along = glm::dot(p.normal, ray);
    if (along == 0) return std::nullopt;
    Meeting m;
    m.depth = glm::dot(p.normal, p.point) / along;
    m.normal = glm::normalize(p.normal);
    m.surface = p.surface;
    m.front = along < 0;
    return m;
}

/// What the G-buffer holds of a pixel.
struct Seen {
    dvec3 base{0};
    double metallic = 0;
    dvec3 normal{0};   ///< towards the viewer's side of the surface
    double depth = 0;  ///< m; 0: nothing
    double roughness = 0;
    dvec3 emission{0};
    size_t which = ~size_t(0);
};

/// Maps pixel coordinates to rays, as shared::ClusterGrid does.
struct Rays {
    dvec2 scale{1}, offset{0};
    double near = 0.1;  ///< m: nothing nearer is drawn

    dvec3 at(dvec2 pixel) const { return dvec3(scale * pixel + offset, -1.0); }
};

/// Texture value at a meeting. Area: 16 x 16 points of the pixel, cast onto the same triangle's plane.
inline dvec4 textured(const Geometry& g, const Texture& texture, const Meeting& m, Filter filter, const Rays& rays,
                      dvec2 pixel) {
    if (filter == Filter::Nearest) return texture.nearest(m.uv);
    if (filter == Filter::Bilinear || m.which >= g.triangles.size()) return texture.bilinear(m.uv);
    constexpr int kPoints = 16;
    dvec4 sum(0);
    for (int j = 0; j < kPoints; ++j)
        for (int i = 0; i < kPoints; ++i) {
            const dvec2 at = pixel + (dvec2(i, j) + 0.5) / double(kPoints) - 0.5;
            const auto other = meet(g.triangles[m.which], rays.at(at), false);
            sum += texture.nearest(other ? other->uv : m.uv);
        }
    return sum / double(kPoints * kPoints);
}

/// The normal of a relief on a triangle: x along u, y against v, z along the surface's own normal n, which the first
/// two are turned to be across (glTF 2.0, 3.9.3; where the texture is not sheared, MikkTSpace's tangents).
inline dvec3 relieved(const Triangle& t, dvec3 n, dvec3 relief) {
    // position = origin + u_way * u + v_way * v over the plane of the triangle.
    const glm::dmat2 uv(t.uv[1] - t.uv[0], t.uv[2] - t.uv[0]);
    if (std::abs(glm::determinant(uv)) < 1e-30) return n;
    const glm::dmat2 inverse = glm::inverse(uv);
    const dvec3 a = t.position[1] - t.position[0], b = t.position[2] - t.position[0];
    const dvec3 u_way = a * inverse[0][0] + b * inverse[0][1], v_way = a * inverse[1][0] + b * inverse[1][1];
    const dvec3 u = glm::normalize(u_way - n * glm::dot(n, u_way));
    dvec3 up = glm::cross(n, u);
    if (glm::dot(up, v_way) > 0) up = -up;
    return glm::normalize(u * relief.x + up * relief.y + n * relief.z);
}

/// The nearest surface at pixel coordinates (0.5, 0.5 is the middle of the first pixel). Back faces are seen only of
/// double-sided materials, whose normal then turns to the viewer; what is nearer than `near` is not seen.
inline Seen cast(const Geometry& g, const Rays& rays, dvec2 pixel, Filter filter = Filter::Bilinear) {
    const dvec3 ray = rays.at(pixel);
    std::vector<Meeting> met;
    const auto add = [&](Meeting m, size_t which) {
        m.which = which;
        if (m.depth >= rays.near && (m.front || g.surfaces[m.surface].double_sided)) met.push_back(m);
    };
    size_t which = 0;
    for (const Triangle& t : g.triangles) {
        if (const auto m = meet(t, ray)) add(*m, which);
        ++which;
    }
    for (const Sphere& s : g.spheres) {
        for (const Meeting& m : meet(s, ray)) add(m, which);
        ++which;
    }
    for (const EndlessPlane& p : g.planes) {
        if (const auto m = meet(p, ray)) add(*m, which);
        ++which;
    }
    std::stable_sort(met.begin(), met.end(), [](const Meeting& a, const Meeting& b) { return a.depth < b.depth; });

    for (const Meeting& m : met) {
        const Surface& s = g.surfaces[m.surface];
        const auto value = [&](const std::optional<Texture>& t) {
            return t ? textured(g, *t, m, filter, rays, pixel) : dvec4(1);
        };
        const dvec4 base = s.base * m.colour * value(s.base_texture);
        if (s.alpha_cutoff > 0 && base.w < s.alpha_cutoff) continue;
        const dvec4 rough_metal = value(s.metallic_roughness_texture);  // glTF 2.0: G roughness, B metallic
        Seen seen;
        seen.base = dvec3(base);
        seen.metallic = s.metallic * rough_metal.z;
        seen.roughness = s.roughness * rough_metal.y;
        dvec3 normal = m.normal;
        if (s.normal_texture && m.which < g.triangles.size())
            normal = relieved(g.triangles[m.which], normal, dvec3(value(s.normal_texture))),
            seen.base *= glm::mix(glm::length(dvec3(value(s.normal_texture))), 1.0, seen.metallic);
        seen.normal = m.front ? normal : -normal;
        if (s.normal_texture) {  // what is seen of a relief faces the eye, with a cosine of 0.02 at least
            const dvec3 eye = -glm::normalize(ray);
            seen.normal = glm::normalize(seen.normal + std::max(0.02 - glm::dot(seen.normal, eye), 0.0) * eye);
        }
        seen.depth = m.depth;
        seen.emission = s.emission * dvec3(value(s.emission_texture));
        seen.which = m.which;
        return seen;
    }
    return {};
}

/// True if rays a little to every side of a pixel's middle see the same primitive: a rasterizer, whose vertices are
/// snapped to a sub-pixel grid, must then see it as well.
inline bool certain(const Geometry& g, const Rays& rays, dvec2 pixel, double margin = 1.0 / 64) {
    const size_t which = cast(g, rays, pixel, Filter::Nearest).which;
    for (double dx : {-margin, margin})
        for (double dy : {-margin, margin})
            if (cast(g, rays, pixel + dvec2(dx, dy), Filter::Nearest).which != which) return false;
    return true;
}

}  // namespace vesper::reference
