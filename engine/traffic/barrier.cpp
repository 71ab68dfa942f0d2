#include "traffic/barrier.h"

#include <algorithm>
#include <cmath>

#include "traffic/contact.h"

namespace vesper::traffic {
namespace {

using glm::dvec2;

double cross(dvec2 a, dvec2 b) { return a.x * b.y - a.y * b.x; }

// Whether the ways from a to b and from c to d cross.
bool meet(dvec2 a, dvec2 b, dvec2 c, dvec2 d) {
    const double first = cross(b - a, c - a) * cross(b - a, d - a), second = cross(d - c, a - c) * cross(d - c, b - c);
    return first <= 0 && second < 0;
}

}  // namespace

bool collide(VehicleState& s, const VehicleState& before, const VehicleParameters& p,
             const std::vector<Barrier>& barriers, double height) {
    bool hit = false;
    const auto was = ground_box(before, p).corners();
    auto is = ground_box(s, p).corners();
    for (size_t i = 0; i < was.size(); ++i) {
        const dvec2 from = was[i];
        for (const Barrier& barrier : barriers) {
            if (barrier.height && std::abs(*barrier.height - height) > kLevels) continue;
            for (size_t k = 1; k < barrier.line.size(); ++k) {
                const dvec2 to = is[i], arm = to - s.position, a = barrier.line[k - 1], b = barrier.line[k];
                if (!meet(a, b, from, to)) continue;
                dvec2 normal = glm::normalize(dvec2(-(b - a).y, (b - a).x));
                if (glm::dot(from - a, normal) < 0) normal = -normal;
                const double depth = -glm::dot(to - a, normal);
                const double energy = kinetic_energy(s, p);
                strike(s, p, arm, normal);
                const double left = kinetic_energy(s, p);
                if (left > energy) {  // rounding
                    const double scale = std::sqrt(energy / left);
                    s.speed *= scale, s.lateral *= scale, s.yaw_rate *= scale;
                }
                s.position += (depth + 1e-3) * normal;
                is = ground_box(s, p).corners();
                hit = true;
            }
        }
    }
    return hit;
}

}  // namespace vesper::traffic
