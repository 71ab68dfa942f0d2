// Triangles and bodies. SPDX-License-Identifier: MIT
#include "roads/road_mesh.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/budget.h"
#include "base/error.h"

namespace vesper::roads {
namespace {

constexpr size_t kMaxVertices = 60'000'000;  // of one mesh; a bound on memory, far above what renders

constexpr size_t kCopies = 3;  // of the geometry: while its arrays grow, and while it is written to a file

double signed_area(const std::vector<glm::dvec2>& points) {
    double sum = 0;
    for (size_t i = 0; i < points.size(); ++i) {
        const glm::dvec2 a = points[i], b = points[(i + 1) % points.size()];
        sum += a.x * b.y - b.x * a.y;
    }
    return sum / 2;
}

bool is_left_turn(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 1e-12;
}

}  // namespace

void RoadMesh::triangle(RoadMaterial stuff, const Corner& a, const Corner& b, const Corner& c) {
    if (glm::length(glm::cross(b.position - a.position, c.position - a.position)) < 1e-9) return;
    scene::Primitive& primitive = primitives_[stuff];
    if (primitive.vertices.size() > kMaxVertices)
        throw Error("the roads have more triangles than " + std::to_string(kMaxVertices / 3));
    spend(3 * (sizeof(scene::Vertex) + sizeof(uint32_t)) * kCopies);
    for (const Corner* corner : {&a, &b, &c}) {
        scene::Vertex vertex;
        vertex.position = glm::vec3(network_.to_world(corner->position));
        vertex.normal = glm::vec3(glm::normalize(RoadNetwork::direction_to_world(corner->normal)));
        primitive.indices.push_back(static_cast<uint32_t>(primitive.vertices.size()));
        primitive.vertices.push_back(vertex);
        primitive.bounds.add(vertex.position);
    }
}

void RoadMesh::quad(RoadMaterial stuff, const Corner& a, const Corner& b, const Corner& c, const Corner& d) {
    triangle(stuff, a, b, c);
    triangle(stuff, a, c, d);
}

void RoadMesh::quad(RoadMaterial stuff, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, glm::dvec3 d) {
    const glm::dvec3 normal = glm::cross(c - a, d - b);
    if (glm::length(normal) < 1e-9) return;
    quad(stuff, {a, normal}, {b, normal}, {c, normal}, {d, normal});
}

void RoadMesh::polygon(RoadMaterial stuff, std::span<const glm::dvec3> corners) {
    if (corners.size() < 3) return;
    glm::dvec3 normal(0);
    for (size_t i = 1; i + 1 < corners.size(); ++i)
        normal += glm::cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    if (glm::length(normal) < 1e-9) return;
    for (size_t i = 1; i + 1 < corners.size(); ++i)
        triangle(stuff, {corners[0], normal}, {corners[i], normal}, {corners[i + 1], normal});
}

void RoadMesh::any_polygon(RoadMaterial stuff, std::vector<glm::dvec3> corners, glm::dvec3 normal) {
    // Ears are cut off one by one; outlines have few corners.
    const glm::dvec3 z = glm::normalize(normal),
                     helper = std::abs(z.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 x = glm::normalize(glm::cross(helper, z)), y = glm::cross(z, x);
    std::vector<glm::dvec2> flat;
    for (const glm::dvec3& corner : corners) flat.emplace_back(glm::dot(corner, x), glm::dot(corner, y));
    if (signed_area(flat) < 0) std::reverse(flat.begin(), flat.end()), std::reverse(corners.begin(), corners.end());
    while (corners.size() > 3) {
        size_t ear = corners.size();
        for (size_t i = 0; i < corners.size() && ear == corners.size(); ++i) {
            check_time();
            const size_t a = (i + corners.size() - 1) % corners.size(), c = (i + 1) % corners.size();
            if (!is_left_turn(flat[a], flat[i], flat[c])) continue;
            bool free = true;
            for (size_t k = 0; k < corners.size() && free; ++k)
                free = k == a || k == i || k == c ||
                       !(is_left_turn(flat[a], flat[i], flat[k]) && is_left_turn(flat[i], flat[c], flat[k]) &&
                         is_left_turn(flat[c], flat[a], flat[k]));
            if (free) ear = i;
        }
        if (ear == corners.size()) break;  // it crosses itself: what is left is taken as it is
        const size_t a = (ear + corners.size() - 1) % corners.size(), c = (ear + 1) % corners.size();
        triangle(stuff, {corners[a], z}, {corners[ear], z}, {corners[c], z});
        corners.erase(corners.begin() + static_cast<ptrdiff_t>(ear));
        flat.erase(flat.begin() + static_cast<ptrdiff_t>(ear));
    }
    for (size_t i = 1; i + 1 < corners.size(); ++i)
        triangle(stuff, {corners[0], z}, {corners[i], z}, {corners[i + 1], z});
}

void RoadMesh::place(scene::Scene& scene, RoadMaterials& materials, const std::string& name) {
    if (primitives_.empty()) return;
    scene::Mesh mesh{.name = name};
    for (auto& [stuff, primitive] : primitives_) {
        primitive.material = materials.index_of(stuff);
        mesh.primitives.push_back(std::move(primitive));
    }
    primitives_.clear();
    scene::Node node{.name = name};
    node.mesh = static_cast<uint32_t>(scene.meshes.size());
    scene.meshes.push_back(std::move(mesh));
    scene.nodes.push_back(node);
}

BodyFrame BodyFrame::turned(double heading, double pitch, double roll) const {
    const auto turn = [](glm::dvec3& a, glm::dvec3& b, double angle) {  // a towards b
        const glm::dvec3 new_a = a * std::cos(angle) + b * std::sin(angle);
        b = b * std::cos(angle) - a * std::sin(angle);
        a = new_a;
    };
    BodyFrame made = *this;
    turn(made.x, made.y, heading);
    turn(made.z, made.x, pitch);
    turn(made.y, made.z, roll);
    return made;
}

void add_box(RoadMesh& mesh, RoadMaterial stuff, const BodyFrame& f, double length, double width, double height) {
    const double u = length / 2, v = width / 2;
    const std::array<glm::dvec3, 4> bottoms{f.at(-u, -v, 0), f.at(u, -v, 0), f.at(u, v, 0), f.at(-u, v, 0)};
    const std::array<glm::dvec3, 4> tops{f.at(-u, -v, height), f.at(u, -v, height), f.at(u, v, height),
                                         f.at(-u, v, height)};
    add_prism(mesh, stuff, bottoms, tops);
}

void add_tube(RoadMesh& mesh, RoadMaterial stuff, const Segment& axis, double thickness) {
    const glm::dvec3 way = axis.to - axis.from;
    const double length = glm::length(way), half = thickness / 2;
    if (length < 1e-6) return;
    const glm::dvec3 z = way / length, helper = std::abs(z.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
    const glm::dvec3 x = glm::normalize(glm::cross(helper, z)), y = glm::cross(z, x);
    const BodyFrame f{axis.from, x, y, z};
    const auto ring = [&](double w) {
        return std::array{f.at(-half, -half, w), f.at(half, -half, w), f.at(half, half, w), f.at(-half, half, w)};
    };
    const std::array<glm::dvec3, 4> a = ring(0), b = ring(length);
    for (size_t i = 0; i < 4; ++i) mesh.quad(stuff, a[i], a[(i + 1) % 4], b[(i + 1) % 4], b[i]);
    mesh.quad(stuff, a[3], a[2], a[1], a[0]);
    mesh.quad(stuff, b[0], b[1], b[2], b[3]);
}

void add_cylinder(RoadMesh& mesh, RoadMaterial stuff, const BodyFrame& f, double radius, double height,
                  double top_radius) {
    const int sides = radius < 0.3 ? 8 : 16;
    const double upper = top_radius < 0 ? radius : top_radius;
    const auto around = [&](int i, double r, double z) {
        const double angle = 2 * kPi * i / sides;
        return RoadMesh::Corner{f.at(r * std::cos(angle), r * std::sin(angle), z),
                                f.x * std::cos(angle) + f.y * std::sin(angle)};
    };
    std::vector<glm::dvec3> top;
    for (int i = 0; i < sides; ++i) {
        mesh.quad(stuff, around(i, radius, 0), around(i + 1, radius, 0), around(i + 1, upper, height),
                  around(i, upper, height));
        top.push_back(around(i, upper, height).position);
    }
    mesh.polygon(stuff, top);
}

void add_ball(RoadMesh& mesh, RoadMaterial stuff, const BodyFrame& f, double radius, double half_height) {
    constexpr int kSides = 12, kRings = 6;
    const auto around = [&](int ring, int i) {
        const double polar = kPi * ring / kRings, angle = 2 * kPi * i / kSides;
        const double across = std::sin(polar), up = -std::cos(polar);
        const glm::dvec3 out = f.x * (across * std::cos(angle)) + f.y * (across * std::sin(angle));
        return RoadMesh::Corner{f.origin + out * radius + f.z * (up * half_height),
                                out / radius + f.z * (up / half_height)};
    };
    for (int ring = 0; ring < kRings; ++ring)
        for (int i = 0; i < kSides; ++i)
            mesh.quad(stuff, around(ring, i), around(ring, i + 1), around(ring + 1, i + 1), around(ring + 1, i));
}

void add_prism(RoadMesh& mesh, RoadMaterial stuff, std::span<const glm::dvec3> bottoms,
               std::span<const glm::dvec3> tops) {
    glm::dvec3 area(0);
    for (size_t i = 1; i + 1 < tops.size(); ++i) area += glm::cross(tops[i] - tops[0], tops[i + 1] - tops[0]);
    const bool clockwise = area.z < 0;
    for (size_t i = 0; i < bottoms.size(); ++i) {
        const size_t j = (i + 1) % bottoms.size();
        if (clockwise)
            mesh.quad(stuff, bottoms[j], bottoms[i], tops[i], tops[j]);
        else
            mesh.quad(stuff, bottoms[i], bottoms[j], tops[j], tops[i]);
    }
    if (glm::length(area) > 1e-9) mesh.any_polygon(stuff, {tops.begin(), tops.end()}, clockwise ? -area : area);
}

}  // namespace vesper::roads
