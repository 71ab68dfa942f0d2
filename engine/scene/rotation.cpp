#include "scene/rotation.h"

#include <cmath>

#include "base/error.h"
#include "base/one_line.h"
#include "scene/scene.h"

namespace vesper::scene {

std::optional<glm::quat> unit_rotation(glm::vec4 xyzw) {
    const glm::dvec4 q(xyzw);
    const double length = glm::length(q);
    if (!(length > 1e-6) || !std::isfinite(length)) return std::nullopt;
    return glm::quat(static_cast<float>(q.w / length), static_cast<float>(q.x / length),
                     static_cast<float>(q.y / length), static_cast<float>(q.z / length));
}

namespace {

glm::quat read_again(const glm::quat& q) { return unit_rotation({q.x, q.y, q.z, q.w}).value_or(q); }

}  // namespace

glm::quat settled_rotation(const glm::dquat& rotation) {
    glm::quat settled(rotation);
    for (int step = 0; step < 4; ++step) settled = read_again(settled);
    if (read_again(settled) == settled) return settled;
    for (int c = 0; c < 4; ++c)  // two neighbours take turns: one beside them stays
        for (const float towards : {-2.0f, 2.0f}) {
            glm::quat beside = settled;
            beside[c] = std::nextafter(settled[c], towards);
            if (read_again(beside) == beside) return beside;
        }
    return settled;
}

void check_transforms(const Scene& scene, const std::string& name) {
    const std::vector<glm::dmat4> world = world_transforms(scene, 0);
    for (size_t i = 0; i < world.size(); ++i)
        for (int c = 0; c < 4; ++c)
            for (int r = 0; r < 4; ++r)
                if (!std::isfinite(static_cast<float>(world[i][c][r])))
                    throw Error(name + ": node '" + one_line(scene.nodes[i].name) +
                                "': its transform and those above it multiply to a number that is not finite");
}

}  // namespace vesper::scene
