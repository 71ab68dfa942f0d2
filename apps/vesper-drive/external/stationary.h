// Things beside the road in messages: drawn of a trace, counted of a sender. SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "external/message_frame.h"
#include "scene/scene.h"

namespace vesper::drive {

/// Numbers of things by their kinds ("building", "traffic sign").
using KindCounts = std::map<std::string, size_t>;
/// "barrier: 2, building: 1".
std::string text_of(const KindCounts&);
std::string kind_of(const osi::StationaryObject&);

/// Nodes of what was drawn, and what was not.
struct StationaryNodes {
    std::vector<std::pair<uint32_t, double>> standing;  ///< nodes of things that stand, and half their heights (m)
    KindCounts shown, not_shown, of_roads;
};

/// Adds a node for each: boxes, poles and trees as cylinders, pylons as cones, signs as panels whose front is of class
/// RA2 (EN 12899-1). Not shown: bridges and structures over the road, whose box would close it, things without a size,
/// and things within 0.5 m of `roads` (world, m, seen from above), which the road file has already.
StationaryNodes add_stationary(scene::Scene&, std::span<const osi::StationaryObject>, const MessageFrame&,
                               std::span<const glm::dvec3> roads);

/// Counts each thing of a sender once, up to as many as a message may have.
class StationaryCensus {
public:
    void add(const osi::Message&);
    const KindCounts& counts() const { return counts_; }

private:
    std::set<osi::StationaryKey> known_;
    KindCounts counts_;
};

}  // namespace vesper::drive
