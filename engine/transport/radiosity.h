// Light that surfaces at rest send each other, solved for cells of them. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "photometry/environment.h"
#include "transport/cell_grid.h"
#include "transport/moving_bodies.h"

namespace vesper::scene {
struct Scene;
}

namespace vesper::transport {

/// What lights a scene at one moment.
struct RadiosityLight {
    std::span<const float> factors;  ///< per node, on the light of its lamp and of its mesh; empty: 1
    glm::dvec3 sky{0};               ///< luminance of all directions without a surface, RGB cd/m^2
    const photometry::Irradiance9* sky_picture = nullptr;  ///< instead of it: illuminance by direction, unobstructed
    uint32_t reflections = 3;                              ///< that are counted, at most
    double reflection_error = 0;  ///< reflections end where those to come would add less than this part of the mean
};

/// Of the sky alone, RGB lx on a surface that sees nothing else.
glm::dvec3 open_sky(const RadiosityLight& light, glm::dvec3 normal);

/// The transport of light among the surfaces of a scene at rest (radiosity: Goral et al. 1984), for cells of them as
/// patches. It holds for any intensities: each cell knows what each source gives it directly, and which cells its rays
/// end at, half of them distributed as cosines (form factors: Malley 1988), half sent to what lamps light. Surfaces
/// count as matt.
struct Radiosity {
    /// Direct light of a cell from a lamp or an emitting mesh, at its full light.
    struct Source {
        uint32_t node;  ///< with kLamp, or of the mesh
        uint32_t lux;   ///< RGB, of kPackedUnit lx, as shared exponents (packF3x9_E1x5)
        glm::dvec3 illuminance() const;
    };
    static constexpr uint32_t kBeside = 8;
    static constexpr uint32_t kLamp = 1u << 31u;
    static constexpr double kPackedUnit = 16;  ///< lx
    static constexpr float kPartUnit = 1.0f / 4096;
    /// How far from the plane of a cell is another surface, cubes; the weight of such, and the least weight.
    static constexpr double kSameSurface = 0.75, kElsewhere = 1e-3, kLeastWeight = 1e-7;

    CellGrid grid;
    std::vector<uint32_t> numbers;  ///< of the cells, ascending
    std::vector<float> heights;     ///< of their mean plane over the middle of the cube, along its normal, m
    std::vector<float> areas;       ///< of them, m^2; 0 of those that only rays found
    std::vector<glm::vec3> normals;
    std::vector<glm::vec3> reflectances;
    std::vector<float> sky;              ///< part of the light of a uniform hemisphere that comes from the sky
    std::vector<uint32_t> first_source;  ///< of each, and the end
    std::vector<Source> sources;
    std::vector<uint32_t> first_met;  ///< of each, and the end
    std::vector<uint32_t> met;        ///< indices of the cells that its rays met, ascending
    std::vector<uint16_t> parts;      ///< of their exitance that it gets, in kPartUnit, halves; at most 1 for a cell
    std::vector<uint32_t> beside;     ///< of each the kBeside cells of the same surface around it, or itself
    std::vector<uint8_t> walls;       ///< of each bits of those around it that it does not see; empty: it sees all
    std::vector<uint8_t> steps;       ///< of each bits of those around it whose light differs; empty: none
    std::vector<CellCut> cuts;        ///< of each; empty: none
    MovingBodies bodies;              ///< that hide light of the cells

    /// Finds `beside` and `walls`, from the rest and from what `sees` says of two cells, by several threads.
    void connect(const std::function<bool(uint32_t, uint32_t)>& sees);
    /// Finds `steps`, from the light of all sources and from that of an even sky. They stay with any other light, so
    /// that all that surfaces get is the sum of what each source gives them.
    void find_steps();

    size_t cells() const { return numbers.size(); }
    std::vector<uint32_t> source_nodes() const;  ///< whose light any cell gets, ascending
    std::optional<uint32_t> find(uint32_t number) const;
    uint64_t bytes() const;

    /// Illuminance of each cell, RGB lx.
    struct Solution {
        std::vector<glm::vec3> lamps;  ///< directly
        std::vector<glm::vec3> other;  ///< from emitting surfaces and the sky, and all that is reflected
    };
    Solution solve(const RadiosityLight& light) const;

    /// Of cells' values, the one at a point of a surface: linear between the eight cells around it that face the same,
    /// those in its plane that no cut parts from it; where there is none, between those of the air. 0 where there
    /// are none either.
    glm::dvec3 at(std::span<const glm::vec3> values, glm::dvec3 point, glm::dvec3 normal) const;

private:
    struct Nearest {
        uint32_t index;
        double off;  // in cubes
    };
    Solution unsmoothed(const RadiosityLight& light) const;
    std::vector<glm::vec3> mean_of(const std::vector<glm::vec3>& lux, std::span<const uint8_t> apart) const;
    std::vector<glm::vec3> smoothed(const std::vector<glm::vec3>& lux) const;
    std::optional<uint32_t> cell_in(glm::dvec3 cube, uint32_t facing) const;  // its index
    CellCut cut_of(uint32_t index) const;
    double off_plane(uint32_t index, glm::dvec3 from_middle) const;  // of a point, from its cube's middle, in cubes
    static std::optional<uint32_t> number_beside(int across, int over);
    std::optional<Nearest> nearest(glm::dvec3 cube, glm::dvec3 place, uint32_t facing) const;
    glm::dvec3 in_air(std::span<const glm::vec3> values, glm::dvec3 place, glm::dvec3 normal, double& weights) const;
};

/// World transforms with those of nodes that are `moving` nowhere (NaN), so that their triangles and lamps count for
/// nothing.
std::vector<glm::dmat4> without_moving(std::span<const glm::dmat4> world, const std::vector<bool>& moving);

struct RadiositySettings {
    double cell_size = 0.125;       ///< m, at least
    uint32_t rays = 32;             ///< from each cell
    uint32_t looks = 64;            ///< of each cell at emitters
    uint32_t lamp_rays = 16;        ///< shadow rays to lamps, from each of four places
    uint64_t fine_cells = 125'000;  ///< roughly: cells are smaller than a metre only where there are no more; where
                                    ///< there are fewer, up to four times as many rays and looks go out from each
    uint64_t most_cells = 600'000;  ///< roughly: cells are larger than a metre where there would be more
};

/// For a scene with its nodes at `world`. Those that are `moving` (per node; empty: none) neither get light nor
/// send any; what they hide is found for them alone (Radiosity::bodies). `progress` is called with shares from 0 to 1,
/// from this thread; where it returns false the work ends and the result is empty. On all processors; the same scene
/// gives the same result.
std::optional<Radiosity> gather_radiosity(const scene::Scene& scene, std::span<const glm::dmat4> world,
                                          const std::vector<bool>& moving, const RadiositySettings& settings,
                                          const std::function<bool(double)>& progress = {});

}  // namespace vesper::transport
