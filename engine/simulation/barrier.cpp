#include "simulation/barrier.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vesper {
namespace {

using glm::dvec2;

double cross(dvec2 a, dvec2 b) { return a.x * b.y - a.y * b.x; }

// From the centre of mass, in the plane.
std::array<dvec2, 4> corners(const VehicleState& s, const VehicleParameters& p) {
    const double middle = (p.front_axle - p.rear_axle) / 2;
    const dvec2 front = (middle + p.length / 2) * s.forward(), rear = (middle - p.length / 2) * s.forward(), side = p.width / 2 * s.left();
    return {front + side, front - side, rear + side, rear - side};
}

// Whether the ways from a to b and from c to d cross.
bool meet(dvec2 a, dvec2 b, dvec2 c, dvec2 d) {
    const double first = cross(b - a, c - a) * cross(b - a, d - a), second = cross(d - c, a - c) * cross(d - c, b - c);
    return first <= 0 && second < 0;
}

void strike(VehicleState& s, const VehicleParameters& p, dvec2 arm, dvec2 normal) {
    // A turn to the left, seen from above, takes (x, z) to (z, -x).
    const auto velocity = [&] { return s.velocity() + s.yaw_rate * dvec2(arm.y, -arm.x); };
    const auto push = [&](dvec2 direction, double impulse) {
        const dvec2 changed = s.velocity() + impulse / p.mass * direction;
        s.speed = glm::dot(changed, s.forward()), s.lateral = glm::dot(changed, s.left());
        s.yaw_rate += impulse * (arm.y * direction.x - arm.x * direction.y) / p.yaw_inertia;
    };
    const auto inertia = [&](dvec2 direction) {
        const double lever = arm.y * direction.x - arm.x * direction.y;
        return 1 / (1 / p.mass + lever * lever / p.yaw_inertia);
    };
    const double into = -glm::dot(velocity(), normal);
    if (into <= 0) return;
    const double blow = into * inertia(normal);
    push(normal, blow);
    const dvec2 along(-normal.y, normal.x);
    const double sliding = glm::dot(velocity(), along), stop = std::abs(sliding) * inertia(along);
    push(along, -std::copysign(std::min(kScrape * blow, stop), sliding));
}

}  // namespace

bool collide(VehicleState& s, const VehicleState& before, const VehicleParameters& p, const std::vector<Barrier>& barriers) {
    bool hit = false;
    const auto was = corners(before, p);
    for (size_t i = 0; i < was.size(); ++i) {
        const dvec2 from = before.position + was[i];
        for (const Barrier& barrier : barriers)
            for (size_t k = 1; k < barrier.size(); ++k) {
                const dvec2 arm = corners(s, p)[i], to = s.position + arm, a = barrier[k - 1], b = barrier[k];
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
                hit = true;
            }
    }
    return hit;
}

}  // namespace vesper
