#include "transport/radiosity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/gtc/packing.hpp>

#include "base/luminance.h"
#include "base/parallel.h"

namespace vesper::transport {
namespace {

template <class T>
uint64_t bytes_of(const std::vector<T>& values) {
    return values.size() * sizeof(T);
}

// The cells around one, across its side, and the weights of a binomial filter.
struct Offset {
    int across, over;
    float weight;
};
constexpr std::array<Offset, Radiosity::kBeside> kOffsets{
    {{-1, -1, 1}, {0, -1, 2}, {1, -1, 1}, {-1, 0, 2}, {1, 0, 2}, {-1, 1, 1}, {0, 1, 2}, {1, 1, 1}}};
constexpr float kOwnWeight = 4;
constexpr uint32_t kMeans = 3;           // after the first, each of the one before
constexpr uint32_t kMeansGivenBack = 5;  // of what these took away: it has all the noise
constexpr float kStep = 0.25f;           // of the illuminance: these leave out cells that differ by more
constexpr float kOneSurface = 0.9f;      // cosine between the normals of cells that are
constexpr double kOnePlane = 0.25;       // cubes: how far off they may be
constexpr size_t kAtATime = 4096;        // cells

template <class Work>
void each_of(size_t cells, const Work& work) {
    in_parallel(cells, kAtATime, [&work](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) work(i);
    });
}

float largest(glm::vec3 rgb) { return std::max({rgb.r, rgb.g, rgb.b}); }

struct Axes {
    int along, across, over;
};
Axes axes_of(uint32_t facing) {
    const int axis = axis_of(facing);
    return {axis, (axis + 1) % 3, (axis + 2) % 3};
}

glm::dvec3 full_sky_on(const RadiosityLight& light, glm::dvec3 normal) {
    if (!light.sky_picture) return std::numbers::pi * light.sky;
    return photometry::evaluate(*light.sky_picture, normal);
}

}  // namespace

glm::dvec3 open_sky(const RadiosityLight& light, glm::dvec3 normal) {
    if (light.sky_picture) return photometry::evaluate(*light.sky_picture, normal);
    return std::numbers::pi * (1 + normal.y) / 2 * light.sky;
}

glm::dvec3 Radiosity::Source::illuminance() const { return kPackedUnit * glm::dvec3(glm::unpackF3x9_E1x5(lux)); }

std::optional<uint32_t> Radiosity::find(uint32_t number) const {
    const auto at = std::ranges::lower_bound(numbers, number);
    if (at == numbers.end() || *at != number) return std::nullopt;
    return uint32_t(at - numbers.begin());
}

uint64_t Radiosity::bytes() const {
    return bytes_of(numbers) + bytes_of(heights) + bytes_of(areas) + bytes_of(normals) + bytes_of(reflectances) +
           bytes_of(sky) + bytes_of(first_source) + bytes_of(sources) + bytes_of(first_met) + bytes_of(met) +
           bytes_of(parts) + bytes_of(beside) + bytes_of(walls) + bytes_of(steps) + bytes_of(cuts);
}

void Radiosity::connect(const std::function<bool(uint32_t, uint32_t)>& sees) {
    beside.assign(cells() * kBeside, 0), walls.assign(cells(), 0);
    each_of(cells(), [&](size_t i) {
        const uint32_t facing = grid.facing(numbers[i]);
        const Axes axes = axes_of(facing);
        const glm::dvec3 cube = grid.place(grid.middle(numbers[i])), normal(normals[i]);
        const glm::dvec3 middle = cube + double(heights[i]) / grid.size * normal;
        for (size_t k = 0; k < kBeside; ++k) {
            uint32_t& other = beside[i * kBeside + k] = uint32_t(i);
            if (grid.is_air(numbers[i])) continue;
            glm::dvec3 place = middle, column = cube;
            place[axes.across] += kOffsets[k].across, place[axes.over] += kOffsets[k].over;
            place[axes.along] -=
                (normal[axes.across] * kOffsets[k].across + normal[axes.over] * kOffsets[k].over) / normal[axes.along];
            column[axes.across] += kOffsets[k].across, column[axes.over] += kOffsets[k].over;
            column[axes.along] = place[axes.along];
            const std::optional<Nearest> cell = nearest(glm::floor(column), place, facing);
            if (!cell) continue;
            if (!sees(uint32_t(i), cell->index))
                walls[i] |= uint8_t(1u << k);
            else if (cell->off <= kOnePlane && glm::dot(normals[cell->index], normals[i]) >= kOneSurface)
                other = cell->index;
        }
    });
}

std::vector<uint32_t> Radiosity::source_nodes() const {
    std::vector<bool> gives;
    for (const Source& source : sources) {
        const uint32_t node = source.node & ~kLamp;
        if (node >= gives.size()) gives.resize(node + size_t{1});
        gives[node] = true;
    }
    std::vector<uint32_t> nodes;
    for (uint32_t node = 0; node < gives.size(); ++node)
        if (gives[node]) nodes.push_back(node);
    return nodes;
}

Radiosity::Solution Radiosity::unsmoothed(const RadiosityLight& light) const {
    Solution result{std::vector<glm::vec3>(cells()), {}};
    std::vector<glm::vec3> unreflected(cells()), sent(cells());
    each_of(cells(), [&](size_t i) {
        glm::dvec3 of_lamps(0), of_meshes(0);
        for (uint32_t s = first_source[i]; s < first_source[i + 1]; ++s) {
            const uint32_t node = sources[s].node & ~kLamp;
            const double factor = light.factors.empty() ? 1 : double(light.factors[node]);
            (sources[s].node & kLamp ? of_lamps : of_meshes) += factor * sources[s].illuminance();
        }
        result.lamps[i] = glm::vec3(of_lamps);
        unreflected[i] = glm::vec3(of_meshes + double(sky[i]) * full_sky_on(light, glm::dvec3(normals[i])));
    });
    std::vector<glm::vec3>& other = result.other = unreflected;
    const auto sum_of = [](const std::vector<glm::vec3>& lux_of_cells) {
        double sum = 0;
        for (const glm::vec3& lux : lux_of_cells) sum += luminance(glm::dvec3(lux));
        return sum;
    };
    double before = sum_of(other), gained = 0;  // all other light; what the last reflection added
    for (uint32_t reflection = 0; reflection < light.reflections; ++reflection) {
        each_of(cells(), [&](size_t i) { sent[i] = reflectances[i] * (result.lamps[i] + other[i]); });
        each_of(cells(), [&](size_t i) {
            glm::vec3 sum(0);
            for (uint32_t k = first_met[i]; k < first_met[i + 1]; ++k)
                sum += glm::unpackHalf1x16(parts[k]) * sent[met[k]];
            other[i] = unreflected[i] + kPartUnit * sum;
        });
        if (!(light.reflection_error > 0)) continue;
        const double all = sum_of(other);
        // What is added falls by about the same factor each time, so that all that is to come is a geometric series.
        const double gain = all - before, factor = gained > 0 ? gain / gained : 1;
        if (reflection > 0 && factor < 1 && gain * factor / (1 - factor) <= light.reflection_error * all) break;
        before = all, gained = gain;
    }
    return result;
}

// Of each cell and those beside it that `apart` (bits of each; empty: none) has no bit for; binomial weights.
std::vector<glm::vec3> Radiosity::mean_of(const std::vector<glm::vec3>& lux, std::span<const uint8_t> apart) const {
    std::vector<glm::vec3> means(cells());
    each_of(cells(), [&](size_t i) {
        glm::vec3 sum = kOwnWeight * lux[i];
        float weights = kOwnWeight;
        for (size_t k = 0; k < kBeside; ++k) {
            if (!apart.empty() && apart[i] >> k & 1) continue;
            sum += kOffsets[k].weight * lux[beside[i * kBeside + k]], weights += kOffsets[k].weight;
        }
        means[i] = sum / weights;
    });
    return means;
}

// A mean; of it others, which leave out `steps`; and more of them of what all these took away, which is given back
// (twicing: Tukey 1977), so that peaks and valleys of the light keep their heights. Linear: where `steps` are those of
// other light there may be a little less than 0.
std::vector<glm::vec3> Radiosity::smoothed(const std::vector<glm::vec3>& lux) const {
    const auto means = [&](std::vector<glm::vec3> of, uint32_t count) {
        for (uint32_t mean = 0; mean < count; ++mean) of = mean_of(of, steps);
        return of;
    };
    std::vector<glm::vec3> result = means(mean_of(lux, {}), kMeans), rest(cells());
    each_of(cells(), [&](size_t i) { rest[i] = lux[i] - result[i]; });
    rest = means(std::move(rest), kMeansGivenBack);
    each_of(cells(), [&](size_t i) { result[i] += rest[i]; });
    return result;
}

Radiosity::Solution Radiosity::solve(const RadiosityLight& light) const {
    Solution solution = unsmoothed(light);
    solution.other = smoothed(solution.other);
    return solution;
}

void Radiosity::find_steps() {
    steps.assign(cells(), 0);
    const std::vector<uint32_t> nodes = source_nodes();
    const std::vector<float> dark(nodes.empty() ? 0 : nodes.back() + size_t{1}, 0.0f);
    for (const RadiosityLight& light : {RadiosityLight{}, RadiosityLight{.factors = dark, .sky = glm::dvec3(1)}}) {
        std::vector<glm::vec3> other = mean_of(unsmoothed(light).other, {});
        std::vector<uint8_t> found(cells());
        // With each mean there is less noise, and fewer of the steps are its.
        for (uint32_t mean = 0; mean <= kMeans; ++mean) {
            each_of(cells(), [&](size_t i) {
                found[i] = 0;
                for (size_t k = 0; k < kBeside; ++k) {
                    const glm::vec3 there = other[beside[i * kBeside + k]];
                    if (largest(glm::abs(there - other[i])) > kStep * 0.5f * largest(there + other[i]))
                        found[i] |= uint8_t(1u << k);
                }
            });
            if (mean < kMeans) other = mean_of(other, found);
        }
        each_of(cells(), [&](size_t i) { steps[i] |= found[i]; });
    }
}

std::optional<uint32_t> Radiosity::cell_in(glm::dvec3 cube, uint32_t facing) const {
    const std::optional<uint32_t> number = grid.cell(cube, facing);
    return number ? find(*number) : std::nullopt;
}

double Radiosity::off_plane(uint32_t index, glm::dvec3 from_middle) const {
    return std::abs(glm::dot(glm::dvec3(normals[index]), from_middle) - double(heights[index]) / grid.size);
}

CellCut Radiosity::cut_of(uint32_t index) const { return cuts.empty() ? CellCut() : cuts[index]; }

// In the cube of a point or one beside it along the axis, that whose plane is nearest.
std::optional<Radiosity::Nearest> Radiosity::nearest(glm::dvec3 cube, glm::dvec3 place, uint32_t facing) const {
    std::optional<Nearest> found;
    for (const double layer : {0.0, -1.0, 1.0}) {
        glm::dvec3 there = cube;
        there[axes_of(facing).along] += layer;
        const std::optional<uint32_t> index = cell_in(there, facing);
        if (!index) continue;
        const double off = off_plane(*index, place - there - 0.5);
        if (!found || off < found->off) found = Nearest{*index, off};
    }
    return found;
}

// Of two cells beside each other across a side, the one as the other sees it, in the order of `beside`; none if it is
// the same or over it.
std::optional<uint32_t> Radiosity::number_beside(int across, int over) {
    const int number = 3 * (over + 1) + across + 1;
    if (number == 4) return std::nullopt;
    return uint32_t(number > 4 ? number - 1 : number);
}

glm::dvec3 Radiosity::at(std::span<const glm::vec3> values, glm::dvec3 point, glm::dvec3 normal) const {
    const uint32_t facing = facing_of(normal);
    const glm::dvec3 place = grid.place(point), corner = glm::floor(place - 0.5), share = place - 0.5 - corner;
    const Axes axes = axes_of(facing);
    // The cell of the point's cube says which of the others it sees; where it is cut off, that on the same side of the
    // cut.
    glm::dvec3 own = glm::floor(place);
    std::optional<uint32_t> own_index = cell_in(own, facing);
    if (own_index && !cut_of(*own_index).has(place - own, facing)) {
        own += cut_of(*own_index).beyond(place - own, facing);
        own_index = cell_in(own, facing);
    }
    const uint32_t hidden = own_index && !walls.empty() ? walls[*own_index] : 0;
    glm::dvec3 sum(0);
    double weights = 0;
    for (uint32_t k = 0; k < 8; ++k) {
        const glm::dvec3 offset(k & 1, k >> 1 & 1, k >> 2), cube = corner + offset, step = cube - own,
                                                            linear = glm::mix(1.0 - share, share, offset);
        const std::optional<uint32_t> index = cell_in(cube, facing);
        if (!index) continue;
        const std::optional<uint32_t> beside_own = number_beside(int(step[axes.across]), int(step[axes.over]));
        if (beside_own && hidden >> *beside_own & 1) continue;
        const double off = off_plane(*index, place - cube - 0.5);
        const double same = cut_of(*index).has(place - cube, facing) ? std::max(1 - off / kSameSurface, kElsewhere) : 0;
        const double weight = linear.x * linear.y * linear.z * same + kLeastWeight;
        sum += weight * glm::dvec3(values[*index]), weights += weight;
    }
    double weights_of_air = 0;
    if (weights < 2 * kElsewhere) {
        const glm::dvec3 air = in_air(values, place, normal, weights_of_air);
        if (weights_of_air > 0) return air / weights_of_air;
    }
    return weights > 0 ? sum / weights : glm::dvec3(0);
}

// Linear between eight cubes of air; in each the three sides that the normal goes to by the squares of its components.
glm::dvec3 Radiosity::in_air(std::span<const glm::vec3> values, glm::dvec3 place, glm::dvec3 normal,
                             double& weights) const {
    const glm::dvec3 air = place / double(grid.air_cubes()) - 0.5, corner = glm::floor(air), share = air - corner;
    const glm::dvec3 unit = normal / glm::length(normal);
    glm::dvec3 sum(0);
    for (uint32_t k = 0; k < 8; ++k) {
        const glm::dvec3 offset(k & 1, k >> 1 & 1, k >> 2), linear = glm::mix(1.0 - share, share, offset);
        for (uint32_t axis = 0; axis < 3; ++axis) {
            const double part = unit[int(axis)] * unit[int(axis)];
            const uint32_t side = 2 * axis + (unit[int(axis)] < 0 ? 1 : 0);
            const std::optional<uint32_t> number = grid.air_cell(corner + offset, side);
            const std::optional<uint32_t> index = number ? find(*number) : std::nullopt;
            if (!index) continue;
            const double weight = part * (linear.x * linear.y * linear.z + kLeastWeight);
            sum += weight * glm::dvec3(values[*index]), weights += weight;
        }
    }
    return sum;
}

}  // namespace vesper::transport
