#include "resident/light_maps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "shared/maps.h"

namespace vesper {
namespace {

constexpr size_t kMostTexels = size_t(1) << 24;  // a float counts them exactly
constexpr int64_t kUnit = 1000;                  // angles are whole multiples of 1/1000 degree
constexpr int64_t kFinest = 20, kUsual = 100;    // 1/1000 degree

// Equally spaced nodes, deg.
struct Nodes {
    double low, step;
    uint32_t count;
    bool exact;

    double at(int64_t i) const { return low + step * double(i); }
};

// The coarsest equal spacing of `low` to `high` that has all the angles among its nodes.
Nodes nodes_of(const std::vector<double>& angles, double low, double high) {
    int64_t divisor = std::llround((high - low) * kUnit);
    bool whole = true;
    for (const double angle : angles) {
        const double units = (angle - low) * kUnit;
        whole = whole && std::abs(units - std::round(units)) < 0.01;
        divisor = std::gcd(divisor, std::llround(units));
    }
    const bool exact = whole && divisor >= kFinest;
    const int64_t steps = std::max<int64_t>(1, exact ? std::llround((high - low) * kUnit) / divisor : std::llround((high - low) * kUnit / kUsual));
    return {low, (high - low) / double(steps), uint32_t(steps) + 1, exact};
}

// The frame a distribution is measured in: azimuth from `start` towards cross(start, pole), and the angle from the pole.
// C and gamma; H, and 90 degrees less V; minus V, and 90 degrees less H.
glm::dvec3 direction(Goniometry goniometry, double azimuth, double polar) {
    const double a = glm::radians(azimuth), s = std::sin(glm::radians(polar)), c = std::cos(glm::radians(polar));
    switch (goniometry) {
        case Goniometry::CGamma: return {s * std::cos(a), s * std::sin(a), -c};
        case Goniometry::TypeB: return {c, -s * std::sin(a), -s * std::cos(a)};
        case Goniometry::TypeA: break;
    }
    return {s * std::sin(a), c, -s * std::cos(a)};
}

struct Range {
    Nodes azimuth, polar;
    bool around, to_start, to_end;  // azimuth is periodic; the pole, and its opposite, are in the range
};

Range range_of(const Distribution& d) {
    std::vector<double> azimuth, polar;
    switch (d.goniometry) {
        case Goniometry::CGamma:
            azimuth = d.horizontal, polar = d.vertical;
            break;
        case Goniometry::TypeA:
            azimuth = d.horizontal;
            for (size_t i = d.vertical.size(); i-- > 0;) polar.push_back(90 - d.vertical[i]);
            break;
        case Goniometry::TypeB:
            for (size_t i = d.vertical.size(); i-- > 0;) azimuth.push_back(-d.vertical[i]);
            for (size_t i = d.horizontal.size(); i-- > 0;) polar.push_back(90 - d.horizontal[i]);
            break;
    }
    const bool around = d.goniometry == Goniometry::CGamma;
    return {around ? nodes_of(azimuth, -180, 180) : nodes_of(azimuth, azimuth.front(), azimuth.back()),
            nodes_of(polar, polar.front(), polar.back()), around, polar.front() <= 0, polar.back() >= 180};
}

// Values at the nodes; beyond them what goes on around, stays at a pole, or is nothing.
class Grid {
public:
    Grid(const Distribution& d, const Range& range, double largest) : range_(range) {
        // A node at the very end of the file's range must not fall outside it by rounding.
        const auto within = [](double value, const Nodes& nodes) {
            const double margin = 1e-9 * (nodes.at(nodes.count - 1) - nodes.low);
            return std::clamp(value, nodes.low + margin, nodes.at(nodes.count - 1) - margin);
        };
        for (uint32_t i = 0; i < range.azimuth.count; ++i)
            for (uint32_t j = 0; j < range.polar.count; ++j)
                values_.push_back(float(intensity(d, direction(d.goniometry, range.around ? range.azimuth.at(i) : within(range.azimuth.at(i), range.azimuth),
                                                               within(range.polar.at(j), range.polar))) / largest));
    }

    // Corners of a cell; cell (0, 0) lies before the first nodes.
    glm::vec4 cell(int64_t i, int64_t j) const {
        const int64_t columns = range_.azimuth.count, rows = range_.polar.count;
        if (range_.around) i = (i - 1 + columns - 1) % (columns - 1) + 1;
        const bool dark = i < 1 || i >= columns || (j < 1 && !range_.to_start) || (j >= rows && !range_.to_end);
        if (dark) return glm::vec4(0);
        const int64_t j0 = std::clamp<int64_t>(j - 1, 0, rows - 1), j1 = std::clamp<int64_t>(j, 0, rows - 1);
        return {at(i - 1, j0), at(i, j0), at(i - 1, j1), at(i, j1)};
    }

private:
    float at(int64_t i, int64_t j) const { return values_[size_t(i) * range_.polar.count + size_t(j)]; }

    Range range_;
    std::vector<float> values_;
};

// The least and the greatest cosine from one angle to another, deg.
glm::dvec2 cosines(double low, double high) {
    const double a = std::cos(glm::radians(low)), b = std::cos(glm::radians(high));
    const auto passes = [&](double angle) { return angle + 360 * std::ceil((low - angle) / 360) <= high; };
    return {passes(180) ? -1 : std::min(a, b), passes(0) ? 1 : std::max(a, b)};
}

// sin(a / 2) of the least and of the largest angle between a direction of a cell and the axis -Z, of which the cosine is that of the
// polar angle in type C, and sin(polar) cos(azimuth) in the others. Angles in deg.
glm::dvec2 angles_from_axis(Goniometry goniometry, glm::dvec2 azimuth, glm::dvec2 polar) {
    polar = glm::clamp(polar, 0.0, 180.0);
    glm::dvec2 cosine = cosines(polar.x, polar.y);
    if (goniometry != Goniometry::CGamma) {
        const glm::dvec2 turn = cosines(azimuth.x, azimuth.y), sine = cosines(polar.x - 90, polar.y - 90);
        cosine = {turn.x * (turn.x > 0 ? sine.x : sine.y), turn.y * (turn.y > 0 ? sine.y : sine.x)};
    }
    return glm::sqrt(glm::max(glm::dvec2(1 - cosine.y, 1 - cosine.x) / 2.0, 0.0));
}

// The rows of the envelope, from the first.
std::vector<glm::vec4> envelope_rows(const std::array<float, shared::kEnvelope>& rings) {
    std::vector<glm::vec4> rows;
    for (const float value : rings) rows.emplace_back(value * 1.001f);
    for (uint32_t row = 1; row < shared::kEnvelopeRows; ++row)
        for (uint32_t k = 0; k < shared::kEnvelope; ++k) {
            const uint32_t before = (row - 1) * shared::kEnvelope, half = 1u << (row - 1);
            rows.push_back(glm::max(rows[before + k], rows[before + std::min(k + half, shared::kEnvelope - 1)]));
        }
    return rows;
}

LightMaps::Intensities add_intensities(const Distribution& d, std::vector<glm::vec4>& texels) {
    LightMaps::Intensities map;
    const double largest = largest_intensity(d);
    map.largest = float(largest), map.goniometry = d.goniometry;
    if (!(largest > 0)) return map;
    const Range range = range_of(d);
    map.exact = range.azimuth.exact && range.polar.exact;
    map.cells = {range.azimuth.count + 1, range.polar.count + 1};
    map.low = {glm::radians(range.azimuth.low), glm::radians(range.polar.low)};
    map.step = {glm::radians(range.azimuth.step), glm::radians(range.polar.step)};
    if (size_t(map.cells.x) * map.cells.y > kMostTexels)
        throw Error("the light distribution '" + d.name + "' is too fine: " + std::to_string(map.cells.x) + " x " + std::to_string(map.cells.y) + " cells");

    const Grid grid(d, range, largest);
    std::array<float, shared::kEnvelope> rings{};
    std::vector<glm::vec4> cells;
    for (int64_t i = 0; i < map.cells.x; ++i)
        for (int64_t j = 0; j < map.cells.y; ++j) {
            const glm::vec4 corners = grid.cell(i, j);
            cells.push_back(corners);
            const float value = std::max({corners.x, corners.y, corners.z, corners.w});
            if (!(value > 0)) continue;
            const auto span = [](const Nodes& nodes, int64_t first) { return glm::dvec2(nodes.at(first), nodes.at(first + 1)); };
            const glm::dvec2 angles = angles_from_axis(d.goniometry, span(range.azimuth, i - 1), span(range.polar, j - 1)) * double(shared::kEnvelope);
            for (auto ring = uint32_t(angles.x); ring <= std::min(uint32_t(angles.y), shared::kEnvelope - 1); ++ring) rings[ring] = std::max(rings[ring], value);
        }
    map.envelope = uint32_t(texels.size());
    const std::vector<glm::vec4> envelope = envelope_rows(rings);
    texels.insert(texels.end(), envelope.begin(), envelope.end());
    map.first = uint32_t(texels.size());
    texels.insert(texels.end(), cells.begin(), cells.end());
    return map;
}

uint32_t add_road(const ReflectionTable& table, std::vector<glm::vec4>& texels) {
    const double last = table.tan_gamma.back();
    const auto value = [&](uint32_t t, uint32_t b) {
        return float(1e4 * reduced_luminance_coefficient(table, last * t / shared::kRoadTanCells, 180.0 * b / shared::kRoadBetaCells));
    };
    texels.emplace_back(float(shared::kRoadTanCells / last), float(last), 0.0f, 0.0f);
    const auto first = uint32_t(texels.size());
    for (uint32_t t = 0; t < shared::kRoadTanCells; ++t)
        for (uint32_t b = 0; b < shared::kRoadBetaCells; ++b)
            texels.emplace_back(value(t, b), value(t + 1, b), value(t, b + 1), value(t + 1, b + 1));
    return first;
}

}  // namespace

LightMaps light_maps(const Scene& scene) {
    LightMaps maps;
    const auto check_size = [&] {
        if (maps.texels.size() > kMostTexels)
            throw Error("the scene's light distributions need more than " + std::to_string(kMostTexels) + " cells in all");
    };
    for (const Distribution& d : scene.distributions) maps.intensities.push_back(add_intensities(d, maps.texels)), check_size();
    for (const ReflectionTable& table : scene.reflection_tables) maps.roads.push_back(add_road(extended(table), maps.texels)), check_size();
    return maps;
}

}  // namespace vesper
