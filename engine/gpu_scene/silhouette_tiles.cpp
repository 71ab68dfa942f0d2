#include "gpu_scene/silhouette_tiles.h"

#include <algorithm>
#include <limits>

#include "shared/luminaire.h"

namespace vesper::gpu_scene {
namespace {

using glm::dvec2;

uint32_t tiles_along(uint32_t pixels) { return (pixels + shared::kLuminaireTile - 1) / shared::kLuminaireTile; }

// Where a convex polygon crosses a horizontal line: empty (low > high) outside it.
struct Span {
    double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
    void add(double x) { low = std::min(low, x), high = std::max(high, x); }
};

Span span_at(std::span<const dvec2> polygon, double y) {
    Span span;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const dvec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        if (std::min(a.y, b.y) > y || std::max(a.y, b.y) < y) continue;
        span.add(a.y == b.y ? a.x : a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
        if (a.y == b.y) span.add(b.x);
    }
    return span;
}

// Calls touch(column, row, whole) for every tile the polygon touches.
template <class Touch>
void for_each_tile(std::span<const dvec2> polygon, VkExtent2D image, Touch touch) {
    constexpr double kTile = shared::kLuminaireTile;
    const auto higher = [](dvec2 a, dvec2 b) { return a.y < b.y; };
    const auto [top, bottom] = std::minmax_element(polygon.begin(), polygon.end(), higher);
    const uint32_t columns = tiles_along(image.width), rows = tiles_along(image.height);
    const uint32_t last_row = std::min(rows - 1, uint32_t(bottom->y / kTile));
    for (uint32_t row = uint32_t(top->y / kTile); row <= last_row; ++row) {
        const double y0 = row * kTile, y1 = y0 + kTile;
        const Span above = span_at(polygon, y0), below = span_at(polygon, y1);
        Span touched{std::min(above.low, below.low), std::max(above.high, below.high)};
        for (const dvec2& v : polygon)
            if (v.y >= y0 && v.y <= y1) touched.add(v.x);
        if (touched.low > touched.high) continue;
        const double whole_low = std::max(above.low, below.low), whole_high = std::min(above.high, below.high);
        const uint32_t last = std::min(columns - 1, uint32_t(touched.high / kTile));
        for (uint32_t column = uint32_t(touched.low / kTile); column <= last; ++column)
            touch(column, row, whole_low <= column * kTile && whole_high >= (column + 1) * kTile);
    }
}

}  // namespace

SilhouetteTiles::SilhouetteTiles(VkExtent2D image)
    : image_(image), columns_(tiles_along(image.width)), counts_(size_t(columns_) * tiles_along(image.height)) {}

SilhouetteTiles::Place SilhouetteTiles::add(std::span<const dvec2> polygon) {
    dvec2 low = polygon.front();
    for (const dvec2& v : polygon) low = glm::min(low, v);
    const dvec2 origin = glm::floor(low);
    const Place place{glm::vec2(origin), uint32_t(silhouettes_.size()), uint32_t(polygon.size())};
    for (const dvec2& v : polygon) silhouettes_.emplace_back(v - origin);
    for_each_tile(polygon, image_, [&](uint32_t column, uint32_t row, bool whole) {
        const uint32_t tile = row * columns_ + column;
        touched_.push_back({tile, count_ | (whole ? shared::kCoversTile : 0)});
        ++counts_[tile];
    });
    ++count_;
    return place;
}

SilhouetteTiles::Load SilhouetteTiles::load_of(std::span<const dvec2> polygon) const {
    Load load{};
    for_each_tile(polygon, image_, [&](uint32_t column, uint32_t row, bool) {
        ++load.tiles, load.most = std::max(load.most, counts_[row * columns_ + column]);
    });
    return load;
}

SilhouetteList SilhouetteTiles::list() const {
    SilhouetteList list{silhouettes_, {}, std::vector<uint32_t>(touched_.size())};
    std::vector<uint32_t> next(counts_.size());  // place of an entry of each tile
    uint32_t first = 0;
    for (uint32_t tile = 0; tile < counts_.size(); ++tile) {
        next[tile] = first;
        if (counts_[tile] > 0) list.tiles.emplace_back(tile % columns_, tile / columns_, first, counts_[tile]);
        first += counts_[tile];
    }
    for (const Touched& t : touched_) list.entries[next[t.tile]++] = t.entry;
    return list;
}

}  // namespace vesper::gpu_scene
