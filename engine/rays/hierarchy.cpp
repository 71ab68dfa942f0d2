#include "rays/hierarchy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "base/budget.h"
#include "scene/bounds.h"

namespace vesper::rays {
namespace {

using scene::Bounds;

constexpr uint32_t kBins = 16;
constexpr uint32_t kGreedyLevels = 44;  // deeper, boxes are halved by number: the levels of any input are bounded

/// A triangle while it is sorted.
struct Item {
    glm::vec3 low;
    uint32_t triangle;
    glm::vec3 high;
    uint32_t unused;
    float twice_middle(int axis) const { return low[axis] + high[axis]; }
};
static_assert(sizeof(Item) == 2 * sizeof(glm::vec4));

struct Range {
    uint32_t begin = 0, end = 0;
    Bounds bounds;
    uint32_t count() const { return end - begin; }
};

void add(Bounds& bounds, const Bounds& other) {
    bounds.low = glm::min(bounds.low, other.low), bounds.high = glm::max(bounds.high, other.high);
}

double half_area(const Bounds& bounds) {
    if (bounds.empty()) return 0;
    const glm::dvec3 size = glm::dvec3(bounds.high) - glm::dvec3(bounds.low);
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

/// At least kRounding larger than the triangle.
Bounds box_around(const Triangle& t) {
    Bounds box;
    for (const glm::vec3& corner : t.corners) box.add(corner);
    const glm::vec3 size = box.high - box.low;
    const float margin = (size.x + size.y + size.z) * kRounding;
    for (int axis = 0; axis < 3; ++axis) {
        box.low[axis] = std::nextafter(box.low[axis] - margin, -HUGE_VALF);
        box.high[axis] = std::nextafter(box.high[axis] + margin, HUGE_VALF);
    }
    return box;
}

/// Equal parts of an axis, by the middles of the boxes.
struct Binning {
    float low = 0, scale = 0;
    uint32_t bin(float twice_middle) const { return std::min(uint32_t((twice_middle - low) * scale), kBins - 1); }
};

struct Bin {
    Bounds bounds;
    uint32_t count = 0;
};
using Bins = std::array<Bin, kBins>;

/// A plane between two bins.
struct Cut {
    double cost = std::numeric_limits<double>::infinity();
    int axis = -1;
    uint32_t bin = 0;  ///< the first one behind it
};

class Builder {
public:
    explicit Builder(std::span<const Triangle> triangles) {
        nodes_.reserve(triangles.size() / 3 + 1);
        items_.reserve(triangles.size());
        Range all{0, uint32_t(triangles.size()), {}};
        for (const Triangle& t : triangles) {
            const Bounds box = box_around(t);
            items_.push_back({box.low, uint32_t(items_.size()), box.high, 0});
            add(all.bounds, box);
        }
        if (!items_.empty()) build(all, 0);
    }
    std::vector<Item> items_;
    std::vector<Node> nodes_;

private:
    uint32_t build(const Range& range, uint32_t level);
    std::pair<Range, Range> split(const Range& range, bool greedy);
    std::pair<Range, Range> part(const Range& range, const Binning& by, const Bins& bins, const Cut& cut);
    Range range_of(uint32_t begin, uint32_t end) const;
    Bounds middles_of(const Range& range) const;
    std::array<Bins, 3> fill_bins(const Range& range, const std::array<Binning, 3>& binning) const;
    uint32_t halve(const Range& range, int axis);
};

Range Builder::range_of(uint32_t begin, uint32_t end) const {
    Range range{begin, end, {}};
    for (uint32_t i = begin; i < end; ++i) add(range.bounds, {items_[i].low, items_[i].high});
    return range;
}

Bounds Builder::middles_of(const Range& range) const {
    Bounds middles;
    for (uint32_t i = range.begin; i < range.end; ++i) middles.add(items_[i].low + items_[i].high);
    return middles;
}

std::array<Bins, 3> Builder::fill_bins(const Range& range, const std::array<Binning, 3>& binning) const {
    std::array<Bins, 3> bins;
    for (uint32_t i = range.begin; i < range.end; ++i) {
        const Item& item = items_[i];
        for (int axis = 0; axis < 3; ++axis) {
            Bin& bin = bins[size_t(axis)][binning[size_t(axis)].bin(item.twice_middle(axis))];
            add(bin.bounds, {item.low, item.high});
            ++bin.count;
        }
    }
    return bins;
}

/// The cheapest plane of an axis, if it is cheaper than `best`: area times number of triangles on both sides.
void find_cut(const Bins& bins, int axis, Cut& best) {
    std::array<double, kBins> behind{};
    Bounds bounds;
    uint32_t count = 0;
    for (uint32_t b = kBins; b-- > 1;) {
        add(bounds, bins[b].bounds);
        count += bins[b].count;
        behind[b] = count > 0 ? half_area(bounds) * count : std::numeric_limits<double>::infinity();
    }
    bounds = {}, count = 0;
    for (uint32_t b = 1; b < kBins; ++b) {
        add(bounds, bins[b - 1].bounds);
        count += bins[b - 1].count;
        const double cost = half_area(bounds) * count + behind[b];
        if (count > 0 && cost < best.cost) best = {cost, axis, b};
    }
}

/// Sorts the lesser half of the boxes before the greater one. Returns the first of the latter.
uint32_t Builder::halve(const Range& range, int axis) {
    const uint32_t middle = range.begin + range.count() / 2;
    std::nth_element(items_.begin() + range.begin, items_.begin() + middle, items_.begin() + range.end,
                     [axis](const Item& a, const Item& b) {
                         return std::pair(a.twice_middle(axis), a.triangle) <
                                std::pair(b.twice_middle(axis), b.triangle);
                     });
    return middle;
}

std::pair<Range, Range> Builder::split(const Range& range, bool greedy) {
    const Bounds middles = middles_of(range);
    const glm::vec3 size = middles.high - middles.low;
    if (greedy) {
        std::array<Binning, 3> binning;
        for (int axis = 0; axis < 3; ++axis) {
            const float scale = float(kBins) / size[axis];
            if (size[axis] > 0 && scale < 1e30f) binning[size_t(axis)] = {middles.low[axis], scale};
        }
        const std::array<Bins, 3> bins = fill_bins(range, binning);
        Cut cut;
        for (int axis = 0; axis < 3; ++axis) find_cut(bins[size_t(axis)], axis, cut);
        if (cut.axis >= 0) return part(range, binning[size_t(cut.axis)], bins[size_t(cut.axis)], cut);
    }
    const uint32_t middle = halve(range, size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2));
    return {range_of(range.begin, middle), range_of(middle, range.end)};
}

std::pair<Range, Range> Builder::part(const Range& range, const Binning& by, const Bins& bins, const Cut& cut) {
    const auto found =
        std::partition(items_.begin() + range.begin, items_.begin() + range.end,
                       [by, cut](const Item& item) { return by.bin(item.twice_middle(cut.axis)) < cut.bin; });
    const auto middle = uint32_t(found - items_.begin());
    Range before{range.begin, middle, {}}, behind{middle, range.end, {}};
    for (uint32_t b = 0; b < kBins; ++b) add(b < cut.bin ? before.bounds : behind.bounds, bins[b].bounds);
    return {before, behind};
}

uint32_t Builder::build(const Range& range, uint32_t level) {
    check_time();
    std::array<Range, Node::kWidth> parts{range};
    uint32_t number = 1;
    while (number < Node::kWidth) {  // halve the largest
        Range* largest = nullptr;
        for (uint32_t i = 0; i < number; ++i)
            if (parts[i].count() > kLeafSize && (!largest || half_area(parts[i].bounds) > half_area(largest->bounds)))
                largest = &parts[i];
        if (!largest) break;
        std::tie(*largest, parts[number++]) = split(*largest, level < kGreedyLevels);
    }
    const auto index = uint32_t(nodes_.size());
    nodes_.emplace_back();
    Node node{};
    for (uint32_t i = 0; i < Node::kWidth; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            node.bounds[0][axis][i] = parts[i].bounds.low[axis];  // of a part that is not there: infinite
            node.bounds[1][axis][i] = parts[i].bounds.high[axis];
        }
        if (i >= number) continue;
        const bool leaf = parts[i].count() <= kLeafSize;
        node.count[i] = leaf ? parts[i].count() : 0;
        node.first[i] = leaf ? parts[i].begin : build(parts[i], level + 1);
    }
    nodes_[index] = node;
    return index;
}

/// triangles[i] becomes the one that was at items[i].triangle. Leaves the items without meaning.
void reorder(std::span<Triangle> triangles, std::vector<Item>& items) {
    for (uint32_t start = 0; start < items.size(); ++start) {
        const Triangle held = triangles[start];
        uint32_t at = start;
        while (items[at].triangle != start) {
            const uint32_t from = std::exchange(items[at].triangle, at);
            triangles[at] = triangles[from];
            at = from;
        }
        items[at].triangle = at;
        triangles[at] = held;
    }
}

}  // namespace

std::vector<Node> build_hierarchy(std::span<Triangle> triangles) {
    Builder built(triangles);
    reorder(triangles, built.items_);
    return std::move(built.nodes_);
}

}  // namespace vesper::rays
