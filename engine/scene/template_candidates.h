// Nodes whose names say that they are lamps. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include <set>
#include <string>
#include <vector>

#include "scene/template_rules.h"

namespace vesper::scene {

/// Chooses nodes by their names: of an object whose parts are named, the part that shines. Nodes are parts of one lamp
/// only where their parent is one by its extent: a common root of a file is none.
class LampCandidates {
public:
    LampCandidates(const Scene&, const SceneSource&, const LampPlaces&);

    bool has(uint32_t node) const { return sounding_[node] && !covered_[node]; }
    /// Nodes without a light that are named as lamps and are parts of others: has() leaves them out.
    size_t parts_left_out() const { return left_out_; }
    /// The words of a node's name and of as many names above it, see parts_of().
    std::vector<std::vector<std::string>> parts(uint32_t node, size_t most_above) const;
    /// Whether the origin of this node is the foot of the lamps below it: it is a lamp or a pole by name and extent, or
    /// is as small and has one lamp alone. kNone is none.
    bool is_foot(uint32_t node) const;

private:
    void measure(const LampPlaces&);
    void find_holders();
    void drop_other_parts(const LampPlaces&);
    void drop(uint32_t node);
    void count_lamps();
    bool has_light(uint32_t node) const;
    bool fits(uint32_t node, double width) const;

    const Scene& scene_;
    std::vector<bool> sounding_;  ///< like a lamp
    std::vector<bool> covered_;   ///< of these, the ones with parts below them that shine, and groups of lamps
    std::vector<Bounds> extent_;  ///< of what is at and below each node, and of lamps below that have no mesh; m, world
    std::vector<uint32_t> lamps_;  ///< below each node
    size_t left_out_ = 0;
};

}  // namespace vesper::scene
