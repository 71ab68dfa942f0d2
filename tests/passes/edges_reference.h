// The mean of what fills a pixel, found from what its neighbours see, in double. SPDX-License-Identifier: MIT
// Everything in the view frame: the eye at the origin, x right, y up, looking along -z.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include <glm/glm.hpp>

#include "passes/gbuffer_reference.h"

namespace vesper::reference {

using glm::ivec2;

/// Points of a pixel, at most.
constexpr uint32_t kPixelPoints = 16;

/// Where a surface has holes: where the opacity of its texture, in the last component, is less than this.
struct Mask {
    std::vector<Texture> levels;  ///< each half as wide and as high as the one before
    double cutoff = 0.5;
    bool nearest = false;  ///< magnified without interpolation
    double longest = 1;    ///< of what a texel stands for, over its width
};

/// What the middle of a pixel sees.
struct SeenFacet {
    uint32_t instance = 0, triangle = 0;  ///< 0: nothing
    std::vector<dvec3> corners;           ///< of its facet, in turn, m
    dvec3 normal{0, 0, 1}, position{0};   ///< unit; m
    bool masked = false;                  ///< it may have holes
    double placement = 0;                 ///< number of its mesh
    uint32_t region = 0;                  ///< of its mesh, over which colours go on
    std::shared_ptr<const Mask> mask;     ///< where its holes are, if that is known
    std::vector<dvec2> uv;                ///< of its corners, for the mask
};

/// A picture of such pixels: pixel (x, y), y down, sees along (scale (pixel + 1/2) + offset, -1).
struct SeenPicture {
    ivec2 size{0};
    dvec2 scale{1}, offset{0};
    std::vector<SeenFacet> facets;
    std::vector<dvec3> luminance;
    uint32_t points = kPixelPoints;  ///< of a pixel, each of which stands for as much of it

    bool has(ivec2 p) const { return p.x >= 0 && p.y >= 0 && p.x < size.x && p.y < size.y; }
    const SeenFacet& facet(ivec2 p) const { return facets[size_t(p.y) * size_t(size.x) + size_t(p.x)]; }
    const dvec3& light(ivec2 p) const { return luminance[size_t(p.y) * size_t(size.x) + size_t(p.x)]; }
};

/// The pixel, those beside it, those at its corners, in the order in which they are asked.
inline std::array<ivec2, 9> neighbourhood(ivec2 p) {
    std::array<ivec2, 9> places{p, p + ivec2(0, -1), p + ivec2(-1, 0), p + ivec2(1, 0), p + ivec2(0, 1)};
    places[5] = p + ivec2(-1, -1), places[6] = p + ivec2(1, -1), places[7] = p + ivec2(-1, 1), places[8] = p + 1;
    return places;
}

/// One surface is one region of one mesh, turns by less than 26 degrees between two pixels; each is on the other's
/// plane but for that bend and for 1/5000 of the depth.
inline bool is_one_surface(const SeenFacet& a, const SeenFacet& b) {
    if (a.instance != b.instance) return false;
    if (a.instance == 0) return true;
    if (a.region != b.region) return false;
    const dvec3 way = b.position - a.position;
    const double bend = glm::length(a.normal - b.normal) * glm::length(way),
                 rounding = 2e-4 * std::max(-a.position.z, -b.position.z);
    return glm::dot(a.normal, b.normal) >= 0.9 &&
           std::max(std::abs(glm::dot(a.normal, way)), std::abs(glm::dot(b.normal, way))) <= bend + rounding;
}

/// Whether a pixel is beside an edge that can be seen: by 2 % of its luminance, in some channel.
inline bool is_edge(const SeenPicture& picture, ivec2 p) {
    for (const ivec2 q : neighbourhood(p)) {
        if (!picture.has(q) || is_one_surface(picture.facet(p), picture.facet(q))) continue;
        const dvec3 change = glm::abs(picture.light(q) - picture.light(p));
        for (int c = 0; c < 3; ++c)
            if (!(change[c] <= 0.02 * std::abs(picture.light(p)[c]))) return true;
    }
    return false;
}

/// How a ray meets a facet and its plane.
struct Passing {
    double inside = 0;         ///< px from the nearest of the lines along its edges; negative: outside
    double inverse_depth = 0;  ///< of its plane, 1/m
};

inline Passing pass(const std::vector<dvec3>& corners, dvec3 ray, dvec2 scale) {
    dvec3 normal(0);
    for (size_t k = 2; k < corners.size(); ++k)
        normal += glm::cross(corners[k - 1] - corners[0], corners[k] - corners[0]);
    const double side = glm::dot(normal, corners[0]) < 0 ? -1 : 1;  // which one of the facet the eye is on
    Passing passing{std::numeric_limits<double>::infinity(), 0};
    for (size_t k = 0; k < corners.size(); ++k) {
        // The plane through the eye and the edge.
        const dvec3 plane = glm::cross(corners[k], corners[(k + 1) % corners.size()]);
        const double steepness = glm::length(dvec2(plane) * scale);
        passing.inside = std::min(passing.inside, side * glm::dot(plane, ray) / steepness);
    }
    const dvec3 first = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    passing.inverse_depth = glm::dot(first, ray) / glm::dot(first, corners[0]);
    return passing;
}

/// Whether a ray through a facet's plane meets a hole, and how far its opacity is from the one at which that changes.
struct Opening {
    bool is_hole = false;
    double doubt = std::numeric_limits<double>::infinity();  ///< of an opacity of 1, or of a level of the texture
};

/// `there`: px, the middle that sees the facet. The texture is that of the level whose texels are as large as a pixel
/// there.
inline Opening open(const SeenFacet& facet, const SeenPicture& picture, dvec2 there, dvec2 pixel) {
    const auto uv_at = [&](dvec2 at) {
        const dvec3 ray(picture.scale * at + picture.offset, -1);
        const dvec3 ab = facet.corners[1] - facet.corners[0], ac = facet.corners[2] - facet.corners[0],
                    normal = glm::cross(ab, ac);
        const dvec3 from_a = ray * (glm::dot(normal, facet.corners[0]) / glm::dot(normal, ray)) - facet.corners[0];
        const double b = glm::dot(glm::cross(from_a, ac), normal) / glm::dot(normal, normal),
                     c = glm::dot(glm::cross(ab, from_a), normal) / glm::dot(normal, normal);
        return facet.uv[0] + b * (facet.uv[1] - facet.uv[0]) + c * (facet.uv[2] - facet.uv[0]);
    };
    const Mask& mask = *facet.mask;
    constexpr double kStep = 1e-5;  // px
    const dvec2 size(mask.levels[0].width, mask.levels[0].height);
    const auto texels = [&](dvec2 way) {
        return glm::length(size * (uv_at(there + kStep * way) - uv_at(there - kStep * way))) / (2 * kStep);
    };
    const auto [shorter, longer] = std::minmax({texels({1, 0}), texels({0, 1})});
    const double wanted = std::log2(mask.nearest ? longer : std::max(shorter, longer / mask.longest)),
                 most = double(mask.levels.size()) - 1, level = std::clamp(std::floor(wanted + 0.5), 0.0, most);
    const Texture& texture = mask.levels[size_t(level)];
    const dvec2 uv = uv_at(pixel);
    const double opacity = (mask.nearest && wanted <= 0 ? texture.nearest(uv) : texture.bilinear(uv)).w;
    Opening opening{opacity < mask.cutoff, std::abs(opacity - mask.cutoff)};
    for (double border = 0.5; border < most; ++border)
        opening.doubt = std::min(opening.doubt, std::abs(wanted - border));
    if (mask.nearest) opening.doubt = std::min(opening.doubt, std::abs(wanted));
    return opening;
}

/// The least width of a facet where a ray meets it, px: between opposite sides, or half of the least height.
inline double width_of(const std::vector<dvec3>& corners, dvec3 ray, dvec2 scale) {
    // px from the image of a line to the ray, or to the image of a place.
    const auto distance = [&](dvec3 from, dvec3 to, dvec3 place) {
        const dvec3 plane = glm::cross(from, to);
        return std::abs(glm::dot(plane, place)) / (-place.z * glm::length(dvec2(plane) * scale));
    };
    if (corners.size() == 4) {
        const auto across = [&](size_t k) {
            return distance(corners[k], corners[k + 1], ray) + distance(corners[k + 2], corners[(k + 3) % 4], ray);
        };
        return std::min(across(0), across(1));
    }
    double least = std::numeric_limits<double>::infinity();
    for (size_t k = 0; k < 3; ++k)
        if (corners[(k + 2) % 3].z < 0)
            least = std::min(least, distance(corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]));
    return least / 2;
}

/// Point i of n, from the middle of the pixel: a Hammersley set, moved so that its mean is the middle, where n is a
/// power of two.
inline dvec2 point_of(uint32_t i, uint32_t n) {
    double down = 0, finest = 1;
    for (uint32_t level = 1; level < n; level *= 2) {
        finest /= 2;
        if (i & level) down += finest;
    }
    return {(i + 0.5) / n - 0.5, down + finest / 2 - 0.5};
}

struct EdgeMean {
    dvec3 luminance{0};
    double doubt = std::numeric_limits<double>::infinity();  ///< px: how near some point was to another choice
};

/// Whether another pixel of this neighbourhood sees its facet, before this one is asked.
inline bool is_known(const SeenPicture& picture, const std::array<ivec2, 9>& around, size_t which) {
    const SeenFacet& facet = picture.facet(around[which]);
    for (size_t k = 0; k < which; ++k)
        if (picture.has(around[k]) && picture.facet(around[k]).instance == facet.instance &&
            picture.facet(around[k]).triangle == facet.triangle)
            return true;
    return false;
}

/// The mean over the points of a pixel beside an edge.
inline EdgeMean edge_mean(const SeenPicture& picture, ivec2 p) {
    EdgeMean mean;
    const auto around = neighbourhood(p);
    for (uint32_t i = 0; i < picture.points; ++i) {
        const dvec2 way = point_of(i, picture.points);
        const dvec3 ray(picture.scale * (dvec2(p) + 0.5 + way) + picture.offset, -1);
        ivec2 seen = p;
        bool covered = false, nothing_near = false;
        ivec2 nothing = p;
        double nearest = 0, second = 0, closest = -1e30, next = -1e30;
        for (size_t k = 0; k < around.size(); ++k) {
            const ivec2 q = around[k];
            if (!picture.has(q) || is_known(picture, around, k)) continue;
            const SeenFacet& facet = picture.facet(q);
            if (facet.instance == 0) {
                if (!nothing_near) nothing = q;
                nothing_near = true;
                continue;
            }
            const dvec3 middle(picture.scale * (dvec2(q) + 0.5) + picture.offset, -1);
            const double width = width_of(facet.corners, middle, picture.scale);
            const bool unknown = facet.masked && !facet.mask, fills = unknown || width < 1;
            mean.doubt = std::min(mean.doubt, unknown ? 1 : std::abs(width - 1));
            if (fills && q != p) continue;
            const Passing passing = fills ? Passing{1, -1 / facet.position.z} : pass(facet.corners, ray, picture.scale);
            if (!fills && facet.masked) {
                const Opening opening = open(facet, picture, dvec2(q) + 0.5, dvec2(p) + 0.5 + way);
                // In steps of 1/255; two of them may be off by half.
                if (opening.doubt < 0.005) mean.doubt = 0;
                if (opening.is_hole) continue;
            }
            const ivec2 as = is_one_surface(picture.facet(p), facet) ? p : q;
            mean.doubt = std::min(mean.doubt, std::abs(passing.inside));
            if (!(passing.inverse_depth > 0)) continue;
            if (passing.inside >= 0) {
                if (passing.inverse_depth > nearest) {
                    if (as != seen || !covered) second = nearest;
                    nearest = passing.inverse_depth, seen = as, covered = true;
                } else if (as != seen) {
                    second = std::max(second, passing.inverse_depth);
                }
            } else if (!covered) {
                if (passing.inside > closest) {
                    if (as != seen) next = closest;
                    closest = passing.inside, seen = as;
                } else if (as != seen) {
                    next = std::max(next, passing.inside);
                }
            }
        }
        if (covered) mean.doubt = std::min(mean.doubt, 1e3 * (nearest - second) / nearest);
        if (!covered) {
            if (nothing_near)
                seen = nothing;
            else
                mean.doubt = std::min(mean.doubt, closest - next);
        }
        mean.luminance += picture.light(seen) / double(picture.points);
    }
    return mean;
}

}  // namespace vesper::reference
