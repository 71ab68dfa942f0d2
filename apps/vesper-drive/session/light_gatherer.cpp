#include "session/light_gatherer.h"

#include <exception>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "transport/kept_radiosity.h"

namespace vesper::drive {
namespace {

constexpr transport::RadiositySettings kWhole;  // as pictures have it
constexpr transport::RadiositySettings kRough{.cell_size = 2, .rays = 8, .looks = 16, .lamp_rays = 8, .fine_cells = 0};
constexpr double kRoughShare = 0.05;  // of the work

}  // namespace

LightGatherer::LightGatherer(const scene::Scene& scene, std::vector<glm::dmat4> world, std::vector<bool> moving,
                             std::shared_ptr<Cache> cache)
    : cache_(std::move(cache)) {
    const auto work = [this, &scene, world = std::move(world), moving = std::move(moving)] {
        try {
            run(scene, world, moving);
        } catch (const std::exception& error) {
            const std::lock_guard lock(mutex_);
            failure_ = error.what();
        }
        done_ = true;
    };
    try {
        thread_ = std::thread(work);
    } catch (const std::system_error&) {  // the host has no more: the first picture waits
        work();
    }
}

LightGatherer::~LightGatherer() {
    ends_ = true;
    if (thread_.joinable()) thread_.join();
}

void LightGatherer::give(transport::Radiosity&& radiosity, const std::string& problem) {
    auto given = std::make_shared<const transport::Radiosity>(std::move(radiosity));
    const std::lock_guard lock(mutex_);
    found_ = std::move(given), problem_ = problem;
}

void LightGatherer::run(const scene::Scene& scene, const std::vector<glm::dmat4>& world,
                        const std::vector<bool>& moving) {
    const auto gathered = [&](const transport::RadiositySettings& settings, double begins, double ends) {
        return transport::gather_radiosity(scene, world, moving, settings, [&](double share) {
            share_ = begins + (ends - begins) * share;
            return !ends_;
        });
    };
    const Digest::Value key = cache_ ? transport::radiosity_key(scene, world, moving, kWhole) : Digest::Value{};
    if (cache_)
        if (auto kept = transport::read_radiosity(*cache_, key)) return give(std::move(*kept));
    auto rough = gathered(kRough, 0, kRoughShare);
    if (!rough) return;
    give(std::move(*rough));
    auto whole = gathered(kWhole, kRoughShare, 1);
    if (!whole) return;
    std::string problem;
    if (cache_ && cache_->writes()) problem = transport::write_radiosity(*cache_, key, *whole);
    give(std::move(*whole), problem);
}

std::shared_ptr<const transport::Radiosity> LightGatherer::take() {
    const std::lock_guard lock(mutex_);
    if (!failure_.empty()) throw Error("light between surfaces: " + std::exchange(failure_, {}));
    return std::exchange(found_, nullptr);
}

std::string LightGatherer::problem() {
    const std::lock_guard lock(mutex_);
    return std::exchange(problem_, {});
}

}  // namespace vesper::drive
