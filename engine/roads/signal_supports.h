// Posts, masts and beams that carry signals. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "roads/object_kind.h"
#include "roads/object_places.h"

namespace vesper::roads {

constexpr double kGantrySteel = 0.3;  ///< m, of legs and beams of a gantry

/// A gantry whose file states its bounding box alone.
struct Portal {
    Segment beam;       ///< its axis, in the file's frame
    double bottom = 0;  ///< z of the feet, m
};

/// The portal that an object is if its box is as high and as wide as one over a lane: a box would close the road.
std::optional<Portal> portal_of(const Road&, const RoadObject&, const Placed&, ObjectKind);

/// True if a point of a road lies on a driven lane of this or another road.
bool is_lane_below(const RoadBuild&, const Road&, double s, double t);

/// A box with its bottom middle in the frame's origin: a sign, or the housing of a traffic light.
struct Hanging {
    BodyFrame frame;  ///< x: its front
    double width = 0, height = 0;
    double ground = 0;       ///< z of the road below, m
    bool over_lane = false;  ///< a driven lane is below it
};

/// Stands signals on posts, and hangs signals over lanes on masts, gantries and arms.
class SignalSupports {
public:
    /// Finds the posts and beams among the objects of all roads.
    explicit SignalSupports(RoadBuild& build);

    /// Adds the support of a signal, in this order: a beam of the file within reach, a post of the file at its place, a
    /// new pole if there is no lane below, an arm from the nearest post, nothing.
    void carry(RoadMesh& mesh, const Road& road, const RoadSignal& signal, const Hanging& body);
    /// Adds the arms of the posts. Called once, after all signals.
    void add_arms(RoadMesh& mesh);

private:
    struct Post {
        glm::dvec3 foot{0};
        double top = 0;  ///< z, m
        std::vector<Hanging> load{};
    };

    void find(const Road&, const RoadObject&, const Placed&, ObjectKind);
    const Segment* beam_at(const Hanging&) const;
    bool has_post(const Hanging&) const;
    Post* nearest_post(const Hanging&);
    size_t first_within(double x) const;
    /// Adds the poles that stand beside lanes: two of a board; false if there is none.
    bool stands(RoadMesh&, const Road&, const RoadSignal&, const Hanging&) const;
    void stand(RoadMesh&, const Hanging&, double beside) const;

    RoadBuild& build_;
    std::vector<Post> posts_;  ///< by x
    std::vector<Segment> beams_;
    size_t on_beams_ = 0, on_arms_ = 0, free_ = 0;
};

}  // namespace vesper::roads
