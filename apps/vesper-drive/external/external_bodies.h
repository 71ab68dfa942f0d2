// Bodies for what another program moves: of models, of nodes that the scene has, or boxes with lamps.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "external/message_source.h"
#include "external/model_table.h"
#include "osi/timeline.h"
#include "scene/scene.h"
#include "traffic/world_file.h"

namespace vesper::drive {

/// A body for an external object.
struct ExternalBody {
    std::string kind;    ///< bodies of one kind stand in for each other
    glm::dvec3 size{0};  ///< of a box: length, width, height (m), to be scaled to the object's; 0: not scaled
};

/// All bodies, in the order of WorldDescription::external_nodes, and which of them an object may have.
class ExternalBodies {
public:
    /// Adds bodies to the scene, to the world as its external nodes, and to its roles of lamps. Nodes of the world's
    /// traffic and walkers become external, too: objects whose model is their name move them. `messages`: all of a
    /// source that is not live. Throws Error.
    ExternalBodies(scene::Scene&, traffic::WorldFile&, const MessageSource&, std::span<const osi::Message> messages);
    ExternalBodies() = default;

    const std::vector<ExternalBody>& all() const { return all_; }
    const std::vector<std::string>& notes() const { return notes_; }  ///< of the models
    /// Which bodies it may have.
    std::string kind_of(const osi::MovingObject&) const;
    /// The size to which an object's body is made, m: as stated, or as is usual.
    static glm::dvec3 size_of(const osi::MovingObject&);

private:
    void add_plain(scene::Scene&, traffic::WorldFile&, const std::string& kind, size_t count);
    void add_model(scene::Scene&, traffic::WorldFile&, size_t model, size_t count);

    std::vector<ExternalBody> all_;
    std::vector<Model> models_;
    std::set<std::string> nodes_;  // of the world that objects move by their models' names
    std::vector<std::string> notes_;
};

/// Most objects of each kind at once.
std::map<std::string, size_t> most_at_once(const ExternalBodies&, std::span<const osi::Message>);

}  // namespace vesper::drive
