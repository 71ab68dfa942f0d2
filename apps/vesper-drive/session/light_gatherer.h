// Light between surfaces, gathered beside the drive. SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "base/cache.h"
#include "transport/radiosity.h"

namespace vesper::drive {

/// A thread that gathers what surfaces at rest of a scene send each other: first roughly, as a stand-in, then as
/// pictures have it; or takes it from a cache. Ends its work when it is destroyed.
class LightGatherer {
public:
    /// The scene must stay as it is meanwhile. `cache`: for this thread alone, or null.
    LightGatherer(const scene::Scene& scene, std::vector<glm::dmat4> world, std::vector<bool> moving,
                  std::shared_ptr<Cache> cache);
    ~LightGatherer();
    LightGatherer(const LightGatherer&) = delete;
    LightGatherer& operator=(const LightGatherer&) = delete;

    /// What was found since the last call; null: nothing new. Throws Error if the work failed.
    std::shared_ptr<const transport::Radiosity> take();
    bool done() const { return done_; }
    double share() const { return share_; }  ///< of the work that is done, 0 to 1
    /// Why it is not kept for later runs, once; empty: it is, or is not yet found.
    std::string problem();

private:
    void run(const scene::Scene& scene, const std::vector<glm::dmat4>& world, const std::vector<bool>& moving);
    void give(transport::Radiosity&& radiosity, const std::string& problem = {});

    std::shared_ptr<Cache> cache_;
    std::atomic<bool> ends_{false}, done_{false};
    std::atomic<double> share_{0};
    std::mutex mutex_;  // of what follows
    std::shared_ptr<const transport::Radiosity> found_;
    std::string problem_, failure_;
    std::thread thread_;
};

}  // namespace vesper::drive
