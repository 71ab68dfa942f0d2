#include "gpu_scene/intensity_tables.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <glm/gtc/packing.hpp>

#include "base/error.h"
#include "scene/scene.h"
#include "shared/tables.h"

namespace vesper::gpu_scene {
namespace {

using photometry::Goniometry;

constexpr size_t kMostTexels = size_t(1) << 24;  // a float counts them exactly
constexpr int64_t kUnit = 1000;                  // nodes are whole multiples of 1/1000 degree, or of tan(gamma)

// The finest spacing that may be taken, and what is where that is not enough; in 1/kUnit.
struct Spacing {
    double finest, otherwise;
};
constexpr Spacing kAngles{20, 100};

// Equally spaced nodes.
struct Nodes {
    double low, step;
    uint32_t count;
    bool exact;

    double at(int64_t i) const { return low + step * double(i); }
};

// The coarsest equal spacing of `low` to `high` that has all the values among its nodes.
Nodes nodes_of(const std::vector<double>& values, double low, double high, Spacing spacing) {
    int64_t divisor = std::llround((high - low) * kUnit);
    bool whole = true;
    for (const double value : values) {
        const double units = (value - low) * kUnit;
        whole = whole && std::abs(units - std::round(units)) < 0.01;
        divisor = std::gcd(divisor, std::llround(units));
    }
    const bool exact = whole && double(divisor) >= spacing.finest;
    const int64_t steps =
        std::max<int64_t>(1, std::llround((high - low) * kUnit / (exact ? double(divisor) : spacing.otherwise)));
    return {low, (high - low) / double(steps), uint32_t(steps) + 1, exact};
}

// The frame a distribution is measured in: azimuth from `start` towards cross(start, pole), and the angle from the
// pole. C and gamma; H, and 90 degrees less V; minus V, and 90 degrees less H.
glm::dvec3 direction(Goniometry goniometry, double azimuth, double polar) {
    const double a = glm::radians(azimuth), s = std::sin(glm::radians(polar)), c = std::cos(glm::radians(polar));
    switch (goniometry) {
        case Goniometry::CGamma:
            return {s * std::cos(a), s * std::sin(a), -c};
        case Goniometry::TypeB:
            return {c, -s * std::sin(a), -s * std::cos(a)};
        case Goniometry::TypeA:
            break;
    }
    return {s * std::sin(a), c, -s * std::cos(a)};
}

struct Range {
    Nodes azimuth, polar;
    bool around, to_start, to_end;  // azimuth is periodic; the pole, and its opposite, are in the range
};

Range range_of(const photometry::Distribution& d) {
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
    return {
        around ? nodes_of(azimuth, -180, 180, kAngles) : nodes_of(azimuth, azimuth.front(), azimuth.back(), kAngles),
        nodes_of(polar, polar.front(), polar.back(), kAngles), around, polar.front() <= 0, polar.back() >= 180};
}

// Values at the nodes; beyond them what goes on around, stays at a pole, or is nothing.
class Grid {
public:
    Grid(const photometry::Distribution& d, const Range& range, double largest) : range_(range) {
        // A node at the very end of the file's range must not fall outside it by rounding.
        const auto within = [](double value, const Nodes& nodes) {
            const double margin = 1e-9 * (nodes.at(nodes.count - 1) - nodes.low);
            return std::clamp(value, nodes.low + margin, nodes.at(nodes.count - 1) - margin);
        };
        for (uint32_t i = 0; i < range.azimuth.count; ++i)
            for (uint32_t j = 0; j < range.polar.count; ++j)
                values_.push_back(float(
                    photometry::intensity(
                        d, direction(d.goniometry,
                                     range.around ? range.azimuth.at(i) : within(range.azimuth.at(i), range.azimuth),
                                     within(range.polar.at(j), range.polar))) /
                    largest));
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

// Bins of directions, or windows of them: values by ring and sector.
using Windows = std::vector<std::vector<float>>;

// The largest value that cells have in each bin. Within a cell they are bilinear, so the largest in a part of it is at
// one of the corners of that part.
class Bins {
public:
    Bins() {
        for (uint32_t r = 0; r <= shared::kRings; ++r)
            rings_.push_back(glm::degrees(2 * std::asin(double(r) / shared::kRings)));
    }

    // The range of a cell, deg, and its values.
    void add(glm::dvec2 azimuth, glm::dvec2 polar, const glm::vec4& corners) {
        const auto part = [](double angle, glm::dvec2 range) {
            return std::clamp((angle - range.x) / (range.y - range.x), 0.0, 1.0);
        };
        const auto sector = [](int64_t s) { return 360.0 * double(s) / shared::kSectors - 180; };
        const auto first_ring = size_t(std::sin(glm::radians(std::clamp(polar.x, 0.0, 180.0) / 2)) * shared::kRings);
        for (auto s = int64_t(std::floor((azimuth.x + 180) / 360 * shared::kSectors)); sector(s) <= azimuth.y; ++s)
            for (size_t r = first_ring; r < shared::kRings && rings_[r] <= polar.y; ++r) {
                const double u[]{part(sector(s), azimuth), part(sector(s + 1), azimuth)},
                    v[]{part(rings_[r], polar), part(rings_[r + 1], polar)};
                float& largest = values[r][size_t((s % shared::kSectors + shared::kSectors) % shared::kSectors)];
                for (const double x : u)
                    for (const double y : v)
                        largest = std::max(largest, 1.001f * float(glm::mix(glm::mix(corners.x, corners.y, x),
                                                                            glm::mix(corners.z, corners.w, x), y)));
            }
    }

    Windows values = Windows(shared::kRings, std::vector<float>(shared::kSectors));

private:
    std::vector<double> rings_;  // where they begin, deg
};

Windows transposed(const Windows& w) {
    Windows t(w.front().size(), std::vector<float>(w.size()));
    for (size_t i = 0; i < w.size(); ++i)
        for (size_t j = 0; j < w[i].size(); ++j) t[j][i] = w[i][j];
    return t;
}

// Windows of every length along the first coordinate (shared/tables.h), which goes on around, from bins; 3 N of N, of
// which the last two hold all.
Windows windows_of(Windows bins) {
    const size_t count = bins.size();
    for (size_t below = 0, number = count, length = 2; length <= count; length *= 2) {
        // A window is two of half its length, which begin every bin, or half of theirs.
        const size_t step = length == 2 ? 1 : 2, first = below;
        below = bins.size();
        for (size_t k = 0; k < 2 * count / length; ++k) {
            std::vector<float> both = bins[first + step * k];
            const std::vector<float>& other = bins[first + (step * (k + 1)) % number];
            for (size_t i = 0; i < both.size(); ++i) both[i] = std::max(both[i], other[i]);
            bins.push_back(std::move(both));
        }
        number = bins.size() - below;
    }
    bins.resize(3 * count, std::vector<float>(bins.back()));
    return bins;
}

void append_windows(const Bins& bins, std::vector<glm::vec4>& texels) {
    const Windows windows = windows_of(transposed(windows_of(transposed(bins.values))));
    for (const std::vector<float>& row : windows)
        for (size_t i = 0; i < row.size(); i += 4) texels.emplace_back(row[i], row[i + 1], row[i + 2], row[i + 3]);
}

IntensityTables::Intensities add_intensities(const photometry::Distribution& d, std::vector<glm::vec4>& texels) {
    IntensityTables::Intensities table;
    const double largest = photometry::largest_intensity(d);
    table.largest = float(largest), table.goniometry = d.goniometry;
    if (!(largest > 0)) return table;
    const Range range = range_of(d);
    table.exact = range.azimuth.exact && range.polar.exact;
    table.cells = {range.azimuth.count + 1, range.polar.count + 1};
    table.low = {glm::radians(range.azimuth.low), glm::radians(range.polar.low)};
    table.step = {glm::radians(range.azimuth.step), glm::radians(range.polar.step)};
    if (size_t(table.cells.x) * table.cells.y > kMostTexels)
        throw Error("the light distribution '" + d.name + "' is too fine: " + std::to_string(table.cells.x) + " x " +
                    std::to_string(table.cells.y) + " cells");

    const Grid grid(d, range, largest);
    Bins bins;
    std::vector<glm::vec4> cells;
    for (int64_t i = 0; i < table.cells.x; ++i)
        for (int64_t j = 0; j < table.cells.y; ++j) {
            cells.push_back(grid.cell(i, j));
            bins.add({range.azimuth.at(i - 1), range.azimuth.at(i)}, {range.polar.at(j - 1), range.polar.at(j)},
                     cells.back());
        }
    append_windows(bins, texels);
    table.first = uint32_t(texels.size());
    texels.insert(texels.end(), cells.begin(), cells.end());
    return table;
}

// Adds the cells of a table, `budget` of them at most, and returns what its head says.
glm::vec4 add_road(const photometry::ReflectionTable& table, size_t budget, std::vector<glm::vec4>& texels) {
    const auto nodes = [](const std::vector<double>& values, uint32_t most) {
        const double finest = values.back() * kUnit / most;
        return nodes_of(values, 0, values.back(), {finest, finest});
    };
    glm::uvec2 most = shared::kMostRoadCells, cells;
    Nodes tan_gamma, beta;
    do {
        tan_gamma = nodes(table.tan_gamma, most.x), beta = nodes(table.beta, most.y);
        cells = {tan_gamma.count - 1, beta.count - 1};
        most /= 2u;
    } while (size_t(cells.x) * cells.y > budget && most.x > 30);

    // Beyond the last tan(gamma) there may be nothing: no node may get there by rounding.
    const double last = table.tan_gamma.back();
    const double scale = std::numbers::pi / reflectance_in_diffuse(table);
    const auto value = [&](uint32_t t, uint32_t b) {
        return float(scale *
                     photometry::reduced_luminance_coefficient(table, std::min(tan_gamma.at(t), last), beta.at(b)));
    };
    const glm::vec4 head(cells.x / last, last, cells.y / std::numbers::pi, texels.size());
    for (uint32_t t = 0; t < cells.x; ++t)
        for (uint32_t b = 0; b < cells.y; ++b)
            texels.emplace_back(value(t, b), value(t + 1, b), value(t, b + 1), value(t + 1, b + 1));
    return head;
}

}  // namespace

photometry::ReflectionTable rendered_table(const scene::Scene& scene, size_t index) {
    const photometry::ReflectionTable& table = scene.reflection_tables.at(index);
    return scene.beyond_tables ? photometry::extended(table) : table;
}

float reflectance_in_diffuse(const photometry::ReflectionTable& rendered) {
    // Normal numbers of half floats: a table that is darker or brighter than any road is as the texels say, which are
    // relative to this.
    const double wanted =
        std::clamp(std::numbers::pi * photometry::diffuse_luminance_coefficient(rendered), 0x1p-14, 65504.0);
    return glm::unpackHalf1x16(glm::packHalf1x16(float(wanted)));
}

IntensityTables intensity_tables(const scene::Scene& scene) {
    IntensityTables tables;
    const auto check_size = [&] {
        if (tables.texels.size() > kMostTexels)
            throw Error("the scene's light distributions need more than " + std::to_string(kMostTexels) +
                        " texels in all");
    };
    for (const photometry::Distribution& d : scene.distributions)
        tables.intensities.push_back(add_intensities(d, tables.texels)), check_size();
    if (const size_t count = scene.reflection_tables.size()) {
        tables.roads = uint32_t(tables.texels.size());
        tables.texels.resize(tables.texels.size() + count);
        for (size_t i = 0; i < count; ++i) {
            const glm::vec4 head = add_road(rendered_table(scene, i), kMostTexels / 2 / count, tables.texels);
            tables.texels[tables.roads + i] = head, check_size();
        }
    }
    return tables;
}

}  // namespace vesper::gpu_scene
