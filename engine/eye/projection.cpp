#include "eye/projection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "base/budget.h"
#include "base/error.h"
#include "base/one_line.h"

namespace vesper::eye {
namespace {

constexpr double kEdge = 1e-9;              // of a triangle: by so much of it pixels on its edges may be outside
constexpr double kLeastDoubleArea = 1e-12;  // px^2, of a triangle that has pixels
constexpr uint64_t kMostLayers = 64;

std::string text_of(uint32_t width, uint32_t height) { return std::to_string(width) + " x " + std::to_string(height); }

void check_extent(const char* what, VkExtent2D extent) {
    for (const uint32_t side : {extent.width, extent.height})
        if (side == 0 || side > kMaxProjectionSide)
            throw Error(std::string(what) + " has " + text_of(extent.width, extent.height) + " px, not 1 to " +
                        std::to_string(kMaxProjectionSide) + " each way");
}

/// A node in pixels: a place on the projector's picture from its top left, and what is shown there.
struct PlacedNode {
    glm::dvec2 place;
    glm::dvec3 shown;  // px of the rendered picture from its top left, intensity
    bool drawn;
};

/// Draws a mesh into the pixels of a projection, cell by cell.
class MeshDrawing {
public:
    MeshDrawing(Projection& to, const vision::WarpMesh& mesh) : to_(to), mesh_(mesh) {
        if (mesh.columns < 2 || mesh.rows < 2 || mesh.nodes.size() != size_t{mesh.columns} * mesh.rows)
            throw Error(one_line(mesh.name) + ": a mesh of " + text_of(mesh.columns, mesh.rows) +
                        " nodes does not have " + std::to_string(mesh.nodes.size()));
        const uint64_t cells = uint64_t{mesh.columns - 1} * (mesh.rows - 1);
        work_left_ = kMostLayers * (cells + uint64_t{to.extent.width} * to.extent.height);
    }
    void draw() {
        for (uint32_t row = 0; row + 1 < mesh_.rows; ++row)
            for (uint32_t column = 0; column + 1 < mesh_.columns; ++column) {
                const PlacedNode a = node(column, row), b = node(column + 1, row), c = node(column + 1, row + 1),
                                 d = node(column, row + 1);
                if (!(a.drawn && b.drawn && c.drawn && d.drawn)) continue;
                draw(a, b, c);
                draw(a, c, d);
            }
    }

private:
    PlacedNode node(uint32_t column, uint32_t row) const {
        const vision::WarpNode& n = mesh_.nodes[size_t{row} * mesh_.columns + column];
        const double width = to_.extent.width, height = to_.extent.height, aspect = width / height;
        return {{(n.x / aspect + 1) / 2 * width, (1 - n.y) / 2 * height},
                {n.u * to_.picture.width, (1 - n.v) * to_.picture.height, n.intensity},
                n.intensity >= 0};
    }
    void spend_work(uint64_t work) {
        if (work > work_left_)
            throw Error(one_line(mesh_.name) + ": the cells of the mesh lie on one another more than " +
                        std::to_string(kMostLayers) + " times");
        work_left_ -= work;
    }
    void draw(const PlacedNode& a, const PlacedNode& b, const PlacedNode& c) {
        const auto cross = [](glm::dvec2 p, glm::dvec2 q) { return p.x * q.y - p.y * q.x; };
        const double area = cross(b.place - a.place, c.place - a.place);
        if (!(std::abs(area) > kLeastDoubleArea)) return;
        // Weights of the nodes: at[k] + x right[k] + y down[k], of the middle of pixel (x, y).
        const std::array<glm::dvec2, 3> from{b.place, c.place, a.place}, to{c.place, a.place, b.place};
        glm::dvec3 at, right, down;
        for (int k = 0; k < 3; ++k) {
            const glm::dvec2 edge = to[size_t(k)] - from[size_t(k)];
            at[k] = cross(edge, glm::dvec2(0.5) - from[size_t(k)]) / area;
            right[k] = -edge.y / area, down[k] = edge.x / area;
        }
        const glm::dmat3 shown(a.shown, b.shown, c.shown);
        const auto [first, last] = std::minmax({a.place.y, b.place.y, c.place.y});
        const auto [top, bottom] = inside(first, last, to_.extent.height);
        for (int64_t y = top; y <= bottom; ++y) {
            const glm::dvec3 weights = at + double(y) * down;
            const auto [low, high] = span(weights, right);
            spend_work(1 + uint64_t(std::max<int64_t>(high - low + 1, 0)));
            for (int64_t x = low; x <= high; ++x) put(x, y, shown * (weights + double(x) * right));
        }
        check_time();
    }
    /// The first and the last of `count` pixels whose middles are between two places, px, or nearly so.
    static std::pair<int64_t, int64_t> inside(double low, double high, uint32_t count) {
        const auto clamped = [&](double at) { return int64_t(std::clamp(at, -1.0, double(count))); };
        return {std::max<int64_t>(clamped(std::ceil(low - 0.5 - kEdge)), 0),
                std::min<int64_t>(clamped(std::floor(high - 0.5 + kEdge)), int64_t{count} - 1)};
    }
    /// The pixels of a row where no weight is negative.
    std::pair<int64_t, int64_t> span(const glm::dvec3& weights, const glm::dvec3& right) const {
        double low = 0, high = to_.extent.width - 1.0;
        for (int k = 0; k < 3; ++k) {
            if (right[k] > 0) low = std::max(low, (-kEdge - weights[k]) / right[k]);
            if (right[k] < 0) high = std::min(high, (-kEdge - weights[k]) / right[k]);
            if (right[k] == 0 && weights[k] < -kEdge) high = -1;
        }
        if (!(low <= high)) return {0, -1};
        return {int64_t(std::ceil(low)), int64_t(std::floor(high))};
    }
    void put(int64_t x, int64_t y, const glm::dvec3& shown) {
        to_.pixels[size_t(y) * to_.extent.width + size_t(x)] = {glm::vec2(shown), float(std::max(shown.z, 0.0))};
    }

    Projection& to_;
    const vision::WarpMesh& mesh_;
    uint64_t work_left_ = 0;  // rows of triangles and pixels
};

void fill(Projection& to) {
    const auto [width, height] = to.extent;
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x)
            to.pixels[size_t{y} * width + x] = {
                {float((x + 0.5) * to.picture.width / width), float((y + 0.5) * to.picture.height / height)}, 1};
}

}  // namespace

Projection projection_of(VkExtent2D picture, VkExtent2D projector, const vision::WarpMesh* mesh,
                         const vision::BlendMask* mask) {
    check_extent("the rendered picture", picture);
    check_extent("the projector's picture", projector);
    if (mask && (mask->width != projector.width || mask->height != projector.height))
        throw Error(one_line(mask->name) + ": the blend mask has " + text_of(mask->width, mask->height) +
                    " px, the projector's picture " + text_of(projector.width, projector.height));
    const size_t pixels = size_t{projector.width} * projector.height;
    spend(pixels * sizeof(shared::ProjectedPixel));
    Projection made{picture, projector, std::vector<shared::ProjectedPixel>(pixels, {{0, 0}, kNotDrawn})};
    if (mesh)
        MeshDrawing(made, *mesh).draw();
    else
        fill(made);
    if (mask)
        for (size_t i = 0; i < pixels; ++i)
            if (made.pixels[i].factor >= 0) made.pixels[i].factor *= mask->factors[i];
    return made;
}

}  // namespace vesper::eye
