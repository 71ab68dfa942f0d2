#include "light_gatherer.h"

#include <exception>
#include <utility>

#include "base/error.h"
#include "transport/kept_radiosity.h"

namespace vesper::drive {
namespace {

constexpr transport::RadiositySettings kRough{.cell_size = 2, .rays = 8, .looks = 16, .lamp_looks = 8};
constexpr double kRoughShare = 0.05;  // of the work

}  // namespace

LightGatherer::LightGatherer(const scene::Scene& scene, std::vector<glm::dmat4> world, std::vector<bool> moving,
                             std::shared_ptr<Cache> cache)
    : cache_(std::move(cache)), thread_([this, &scene, world = std::move(world), moving = std::move(moving)] {
          try {
              run(scene, world, moving);
          } catch (const std::exception& error) {
              const std::lock_guard lock(mutex_);
              failure_ = error.what();
          }
          done_ = true;
      }) {}

LightGatherer::~LightGatherer() {
    ends_ = true;
    thread_.join();
}

bool LightGatherer::gather(const scene::Scene& scene, const std::vector<glm::dmat4>& world,
                           const std::vector<bool>& moving, const transport::RadiositySettings& settings,
                           double begins) {
    const bool whole = begins > 0;
    const double width = whole ? 1 - begins : kRoughShare;
    std::string problem;
    auto radiosity = transport::kept_or_gathered(
        scene, world, moving, settings, whole ? cache_.get() : nullptr,
        [&](double share) {
            share_ = begins + width * share;
            return !ends_;
        },
        &problem);
    if (!radiosity) return false;
    auto given = std::make_shared<const transport::Radiosity>(std::move(*radiosity));
    const std::lock_guard lock(mutex_);
    found_ = std::move(given), problem_ = problem;
    return true;
}

void LightGatherer::run(const scene::Scene& scene, const std::vector<glm::dmat4>& world,
                        const std::vector<bool>& moving) {
    if (cache_)
        if (auto kept = transport::read_radiosity(*cache_, transport::radiosity_key(scene, world, moving, {}))) {
            const std::lock_guard lock(mutex_);
            found_ = std::make_shared<const transport::Radiosity>(std::move(*kept));
            return;
        }
    if (gather(scene, world, moving, kRough, 0)) gather(scene, world, moving, {}, kRoughShare);
}

std::shared_ptr<const transport::Radiosity> LightGatherer::take() {
    const std::lock_guard lock(mutex_);
    if (!failure_.empty()) throw Error("light between surfaces: " + std::exchange(failure_, {}));
    return std::exchange(found_, nullptr);
}

std::string LightGatherer::problem() const {
    const std::lock_guard lock(mutex_);
    return problem_;
}

}  // namespace vesper::drive
