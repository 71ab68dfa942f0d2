#include "window/light_probe.h"

#include <algorithm>
#include <cmath>

#include "scene/lamp.h"

namespace vesper::drive {
namespace {

using glm::dvec3;

struct Ray {
    dvec3 origin, direction;  // the direction is as long as one m along the view axis
};

/// Where a ray enters a box, as a factor of its direction; nothing if it passes by.
bool meets(const scene::Bounds& box, const Ray& ray, double nearest) {
    double enter = 0, leave = nearest;
    for (int i = 0; i < 3; ++i) {
        const double a = (double(box.low[i]) - ray.origin[i]) / ray.direction[i],
                     b = (double(box.high[i]) - ray.origin[i]) / ray.direction[i];
        if (std::isnan(a) || std::isnan(b)) continue;  // along a face
        enter = std::max(enter, std::min(a, b)), leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave;
}

/// Moeller and Trumbore 1997. A factor of the direction; infinite if it misses.
double distance_to(const dvec3& a, const dvec3& b, const dvec3& c, const Ray& ray) {
    const dvec3 e1 = b - a, e2 = c - a, p = glm::cross(ray.direction, e2);
    const double determinant = glm::dot(e1, p);
    if (determinant == 0) return HUGE_VAL;
    const dvec3 t = ray.origin - a, q = glm::cross(t, e1);
    const double u = glm::dot(t, p) / determinant, v = glm::dot(ray.direction, q) / determinant;
    return u >= 0 && v >= 0 && u + v <= 1 ? glm::dot(e2, q) / determinant : HUGE_VAL;
}

}  // namespace

std::optional<SurfacePoint> surface_at(const scene::Scene& scene, const gpu_scene::SceneFrame& frame,
                                       const gpu_scene::View& view, glm::uvec2 pixel) {
    const glm::dmat4 view_to_world = glm::inverse(view.world_to_view);
    const glm::vec2 tangents = view.ray_scale() * (glm::vec2(pixel) + 0.5f) + view.ray_offset();
    const Ray world{dvec3(view_to_world[3]),
                    dvec3(view_to_world * glm::dvec4(double(tangents.x), double(tangents.y), -1, 0))};
    double nearest = HUGE_VAL;
    SurfacePoint found;
    for (uint32_t n = 0; n < scene.nodes.size(); ++n) {
        if (scene.nodes[n].mesh == scene::kNone) continue;
        const glm::dmat4 to_world(frame.world[n]), to_mesh = glm::inverse(to_world);
        const Ray ray{dvec3(to_mesh * glm::dvec4(world.origin, 1)), dvec3(to_mesh * glm::dvec4(world.direction, 0))};
        for (const scene::Primitive& part : scene.meshes[scene.nodes[n].mesh].primitives) {
            if (!meets(part.bounds, ray, nearest)) continue;
            const bool both = scene.materials[part.material].double_sided;
            for (size_t i = 0; i + 2 < part.indices.size(); i += 3) {
                const dvec3 a(part.vertices[part.indices[i]].position), b(part.vertices[part.indices[i + 1]].position),
                    c(part.vertices[part.indices[i + 2]].position);
                const double at = distance_to(a, b, c, ray);
                if (!(at > double(view.near) && at < nearest)) continue;
                const dvec3 outside = glm::cross(b - a, c - a);
                if (!both && glm::dot(outside, ray.direction) > 0) continue;  // its back is not drawn
                nearest = at;
                // A normal goes by the inverse transpose.
                dvec3 normal = glm::normalize(glm::transpose(glm::dmat3(to_mesh)) * outside);
                if (glm::dot(normal, world.direction) > 0) normal = -normal;
                found = {world.origin + at * world.direction, normal, at * glm::length(world.direction), n};
            }
        }
    }
    if (std::isinf(nearest)) return std::nullopt;
    return found;
}

double lamp_illuminance(const scene::Scene& scene, const gpu_scene::SceneFrame& frame, const SurfacePoint& point) {
    double sum = 0;
    for (uint32_t n = 0; n < scene.nodes.size(); ++n) {
        if (scene.nodes[n].lamp == scene::kNone) continue;
        const scene::Lamp& lamp = scene.lamps[scene.nodes[n].lamp];
        const glm::dmat4 m(frame.world[n]);
        const auto unit = [&](int column) { return glm::normalize(dvec3(m[column])); };
        const double dimming = double(frame.dimming_of(n));
        if (lamp.kind == scene::Lamp::Kind::Directional) {
            sum += dimming * double(lamp.intensity) * std::max(glm::dot(unit(2), point.normal), 0.0);
            continue;
        }
        const dvec3 to_lamp = dvec3(m[3]) - point.position;
        const double squared = glm::dot(to_lamp, to_lamp);
        const double cosine = glm::dot(to_lamp, point.normal) / std::sqrt(squared);
        if (!(cosine > 0) || !(dimming > 0)) continue;
        const dvec3 from_lamp(-glm::dot(to_lamp, unit(0)), -glm::dot(to_lamp, unit(1)), -glm::dot(to_lamp, unit(2)));
        sum += dimming * scene::luminous_intensity(lamp, scene.distributions, from_lamp) * cosine / squared;
    }
    return sum;
}

}  // namespace vesper::drive
