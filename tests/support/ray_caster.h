// Rays through a scene, in double precision: what stands between two points. SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "scene/scene.h"

namespace vesper::test {

/// Triangles in a hierarchy of boxes, each halved at the middle of its longest side.
class RayCaster {
public:
    /// A triangle and the group it belongs to, which a ray can leave out.
    struct Triangle {
        std::array<glm::dvec3, 3> corners;  ///< m
        uint32_t group = 0;
        uint32_t material = scene::kNone;  ///< of masked ones, whose texture is looked at
        std::array<glm::vec3, 3> uv_opacity{};
    };

    RayCaster() = default;
    explicit RayCaster(std::vector<Triangle> triangles, const scene::Scene* scene = nullptr)
        : triangles_(std::move(triangles)), scene_(scene) {
        order_.resize(triangles_.size());
        std::iota(order_.begin(), order_.end(), 0u);
        if (!order_.empty()) build(0, uint32_t(order_.size()));
    }
    /// All triangles of a scene; groups are nodes.
    RayCaster(const scene::Scene& scene, std::span<const glm::dmat4> world)
        : RayCaster(triangles_of(scene, world), &scene) {}

    size_t size() const { return triangles_.size(); }

    /// The nearest share of the way from `a` to `b`, in (from, to), at which there is a triangle of a group for which
    /// `counts` holds; infinite without one.
    template <class Counts>
    double hit(glm::dvec3 a, glm::dvec3 b, double from, double to, const Counts& counts) const {
        double nearest = std::numeric_limits<double>::infinity();
        const glm::dvec3 way = b - a, inverse = 1.0 / way;
        std::vector<uint32_t> open;
        if (!boxes_.empty()) open.push_back(0);
        while (!open.empty()) {
            const Box& box = boxes_[open.back()];
            open.pop_back();
            const glm::dvec3 t0 = (box.low - a) * inverse, t1 = (box.high - a) * inverse;
            const glm::dvec3 in = glm::min(t0, t1), out = glm::max(t0, t1);
            const double enter = std::max({in.x, in.y, in.z, from}),
                         leave = std::min({out.x, out.y, out.z, std::min(to, nearest)});
            if (!(enter <= leave * (1 + 1e-12) + 1e-15)) continue;
            if (box.count == 0) {
                open.push_back(box.first), open.push_back(box.second);
                continue;
            }
            for (uint32_t i = box.first; i < box.first + box.count; ++i) {
                const Triangle& t = triangles_[order_[i]];
                if (!counts(t.group)) continue;
                const double at = meet(t, a, way);
                if (at > from && at < to && at < nearest) nearest = at;
            }
        }
        return nearest;
    }

    static std::vector<Triangle> triangles_of(const scene::Scene& scene, std::span<const glm::dmat4> world) {
        std::vector<Triangle> all;
        for (uint32_t n = 0; n < scene.nodes.size(); ++n) {
            if (scene.nodes[n].mesh == scene::kNone) continue;
            for (const scene::Primitive& p : scene.meshes[scene.nodes[n].mesh].primitives)
                for (size_t i = 0; i + 2 < p.indices.size(); i += 3) {
                    Triangle t;
                    t.group = n;
                    const scene::Material& m = scene.materials[p.material];
                    if (m.alpha == scene::Material::Alpha::Mask) t.material = p.material;
                    for (size_t k = 0; k < 3; ++k) {
                        const scene::Vertex& v = p.vertices[p.indices[i + k]];
                        t.corners[k] = glm::dvec3(world[n] * glm::dvec4(v.position, 1));
                        t.uv_opacity[k] = glm::vec3(v.uv, float(v.colour[3]) / 65535);
                    }
                    all.push_back(t);
                }
        }
        return all;
    }

private:
    struct Box {
        glm::dvec3 low{1e300}, high{-1e300};
        uint32_t first = 0, second = 0, count = 0;  // triangles, or without any two boxes
    };

    uint32_t build(uint32_t begin, uint32_t end) {
        const uint32_t index = uint32_t(boxes_.size());
        boxes_.emplace_back();
        Box box;
        for (uint32_t i = begin; i < end; ++i)
            for (const glm::dvec3& c : triangles_[order_[i]].corners)
                box.low = glm::min(box.low, c), box.high = glm::max(box.high, c);
        const glm::dvec3 size = box.high - box.low;
        const int axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
        if (end - begin <= 4) {
            box.first = begin, box.count = end - begin;
        } else {
            const uint32_t middle = (begin + end) / 2;
            const auto centre = [&](uint32_t t) {
                const auto& c = triangles_[t].corners;
                return c[0][axis] + c[1][axis] + c[2][axis];
            };
            std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                             [&](uint32_t x, uint32_t y) { return centre(x) < centre(y); });
            box.first = build(begin, middle);
            box.second = build(middle, end);
        }
        boxes_[index] = box;
        return index;
    }

    // Möller and Trumbore 1997. Infinite where the triangle is not met, or lets light through.
    double meet(const Triangle& t, glm::dvec3 a, glm::dvec3 way) const {
        constexpr double kNever = std::numeric_limits<double>::infinity();
        const glm::dvec3 e1 = t.corners[1] - t.corners[0], e2 = t.corners[2] - t.corners[0], p = glm::cross(way, e2);
        const double det = glm::dot(e1, p);
        if (det == 0) return kNever;
        const glm::dvec3 s = a - t.corners[0];
        const double u = glm::dot(s, p) / det;
        if (u < 0 || u > 1) return kNever;
        const glm::dvec3 q = glm::cross(s, e1);
        const double v = glm::dot(way, q) / det;
        if (v < 0 || u + v > 1) return kNever;
        if (t.material != scene::kNone && !opaque(t, float(u), float(v))) return kNever;
        return glm::dot(e2, q) / det;
    }

    bool opaque(const Triangle& t, float u, float v) const {
        const scene::Material& m = scene_->materials[t.material];
        const glm::vec3 at = (1 - u - v) * t.uv_opacity[0] + u * t.uv_opacity[1] + v * t.uv_opacity[2];
        float opacity = m.base_colour.a * at.z;
        if (m.base_colour_texture.image != scene::kNone) {
            const Image& image = scene_->images[m.base_colour_texture.image];
            const auto texel = [](float x, uint32_t size, scene::Wrap wrap) {
                if (wrap == scene::Wrap::Clamp) x = std::clamp(x, 0.0f, 1.0f);
                if (wrap == scene::Wrap::Mirror) x = 1 - std::abs(x - 2 * std::floor(x / 2) - 1);
                x -= std::floor(x);
                return std::min(uint32_t(x * float(size)), size - 1);
            };
            const uint32_t x = texel(at.x, image.width, m.base_colour_texture.wrap_u),
                           y = texel(at.y, image.height, m.base_colour_texture.wrap_v);
            opacity *= float(image.rgba[4 * (size_t(y) * image.width + x) + 3]) / 255;
        }
        return opacity >= m.alpha_cutoff;
    }

    std::vector<Triangle> triangles_;
    std::vector<uint32_t> order_;
    std::vector<Box> boxes_;
    const scene::Scene* scene_ = nullptr;
};

}  // namespace vesper::test
