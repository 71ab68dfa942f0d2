// Triangles of a road's surroundings, by material, on their way into a scene. Not a public header.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <initializer_list>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "roads/road_network.h"
#include "scene/scene.h"

namespace vesper::roads {

/// Road materials; road_materials.cpp has their reflection.
enum class RoadMaterial : uint8_t {
    Asphalt,
    Shoulder,
    Bikeway,
    Pavement,
    Kerb,
    Grass,
    Gravel,
    Concrete,
    MarkWhite,
    MarkYellow,
    MarkRed,
    MarkBlue,
    MarkGreen,
    MarkBlack,
    Steel,
    PoleSteel,
    Post,
    PostBand,
    PostReflector,
    Bark,
    Leaves,
    Wall,
    SignWhite,
    SignRed,
    SignYellow,
    SignBlue,
    SignGreen,
    SignBlack,
    SignBack,
    Housing,
    Luminaire,
    Count
};

/// Materials of the scene by kind; adds them, with their tables and reflectors, on first use.
class RoadMaterials {
public:
    explicit RoadMaterials(scene::Scene& scene)
        : scene_(scene), index_(static_cast<size_t>(RoadMaterial::Count), scene::kNone) {}
    uint32_t index_of(RoadMaterial stuff);

private:
    scene::Scene& scene_;
    std::vector<uint32_t> index_;
};

/// Collects triangles, given in the frame of the file, in the frame of the world.
class RoadMesh {
public:
    explicit RoadMesh(const RoadNetwork& network) : network_(network) {}

    struct Corner {
        glm::dvec3 position{0}, normal{0, 0, 1};
    };
    /// Adds a triangle, counter-clockwise seen from the front, unless its area is 0.
    void triangle(RoadMaterial stuff, const Corner& a, const Corner& b, const Corner& c);
    void quad(RoadMaterial stuff, const Corner& a, const Corner& b, const Corner& c, const Corner& d);
    /// The same, flat.
    void quad(RoadMaterial stuff, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, glm::dvec3 d);
    /// A flat, convex polygon.
    void polygon(RoadMaterial stuff, std::span<const glm::dvec3> corners);
    /// A simple polygon in a plane with this normal, not necessarily convex; counter-clockwise.
    void any_polygon(RoadMaterial stuff, std::vector<glm::dvec3> corners, glm::dvec3 normal);

    bool empty() const { return primitives_.empty(); }
    /// Adds the triangles to a scene as one mesh on one node, and empties itself.
    void place(scene::Scene& scene, RoadMaterials& materials, const std::string& name);

private:
    const RoadNetwork& network_;
    std::map<RoadMaterial, scene::Primitive> primitives_;
};

/// A frame for bodies: origin and three unit axes.
struct BodyFrame {
    glm::dvec3 origin{0}, x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
    glm::dvec3 at(double u, double v, double w) const { return origin + x * u + y * v + z * w; }
    /// Turned about z, then y, then x (heading, pitch, roll as OpenDRIVE has them), rad.
    BodyFrame turned(double heading, double pitch, double roll) const;
    BodyFrame moved(double u, double v, double w) const { return {at(u, v, w), x, y, z}; }
};

/// Bodies that stand on the frame's origin: without a bottom face.
void add_box(RoadMesh& mesh, RoadMaterial stuff, const BodyFrame& frame, double length, double width, double height);
void add_cylinder(RoadMesh& mesh, RoadMaterial stuff, const BodyFrame& frame, double radius, double height,
                  double top_radius = -1);
/// A straight line between two points.
struct Segment {
    glm::dvec3 from{0}, to{0};
};
/// A closed square tube along a segment, `thickness` m wide.
void add_tube(RoadMesh& mesh, RoadMaterial stuff, const Segment& axis, double thickness);
/// A ball around the origin, squeezed along z.
void add_ball(RoadMesh& mesh, RoadMaterial stuff, const BodyFrame& frame, double radius, double half_height);
/// Walls over a closed outline and a roof on it; bottoms and tops counter-clockwise, corner by corner.
void add_prism(RoadMesh& mesh, RoadMaterial stuff, std::span<const glm::dvec3> bottoms,
               std::span<const glm::dvec3> tops);

}  // namespace vesper::roads
