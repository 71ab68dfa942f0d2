// Off-screen light: other pictures of the same eye scatter light into one, so that their glare has no seams.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <vector>

#include "vision/light_nodes.h"
#include "vision/scatter_fit.h"

namespace vesper::vision {

/// One of several pictures of one eye.
struct EyePicture {
    ImageAngles image;
    glm::dmat3 turn{1};  ///< from its view frame (x right, y up, along -z) to that of the eye
    int guard = 0;       ///< px along its border that are rendered for glare and not shown
    bool operator==(const EyePicture&) const = default;

    /// Towards a point, px from the top left corner, in the frame of the eye; not of unit length.
    glm::dvec3 towards(glm::dvec2 pixels) const { return turn * glm::dvec3(image.at(pixels), -1); }
};

/// A lamp that no picture shows.
struct UnseenLamp {
    glm::dvec3 direction{0, 0, -1};  ///< from the eye, in its frame, of unit length
    glm::dvec3 illuminance{0};       ///< RGB lx, on a plane at the eye that faces it
};

/// Light that enters the glare pyramid from outside a picture, cd/m^2 RGB.
struct OffscreenLight {
    std::vector<std::vector<glm::vec4>> levels;  ///< 0 .. the top: all texels with margin, row by row; empty in the
                                                 ///< first two
    std::vector<glm::vec4> veil;                 ///< of the top: light from too far for a margin, by texel
};

/// Sums, for one picture of an eye, the light of the other pictures that is scattered into it. The geometry is computed
/// once, the sums for every frame. Every direction counts once: from the own picture, else from the others in
/// proportion to their depths; over the guard the others take over gradually. Light enters the margins of the pyramid
/// at its angle. Beyond the margins it veils each texel of the top by its angle: fully up to 90 degrees, not at all
/// from 100.
class LightElsewhere {
public:
    LightElsewhere(const EyeScatter&, std::span<const EyePicture> pictures, size_t own);

    /// The nodes of a picture whose light it takes, ascending.
    const std::vector<uint32_t>& nodes(size_t picture) const { return givers_[picture].nodes; }
    /// Off-screen light of a frame. `light`: of each picture, including the own one, that of its nodes()
    /// (LightSums::at), lx. Borders (EyePicture::guard) are kGuard wide.
    OffscreenLight of(std::span<const std::vector<glm::vec3>> light, std::span<const UnseenLamp> lamps) const;
    /// Bytes of host memory.
    uint64_t bytes() const;

    /// px. Beyond 11 px only levels from 2 on contribute: kernels of 7 x 7 on texels of 2 px, with their filters.
    static constexpr int kGuard = 12;

private:
    /// The splines of a place among the texels of a level.
    struct Splash {
        uint32_t level = 0, first = 0;  ///< the texel at the top left of five by five
        std::array<float, 5> x{}, y{};  ///< y: times cd/m^2 of a texel per lx
    };
    struct Near {
        uint32_t node;  // index in Giver::nodes
        float weight;
        Splash splash;
    };
    struct Far {
        uint32_t node, column;
        float weight;
    };
    /// Contributions of one other picture.
    struct Giver {
        std::vector<uint32_t> nodes;
        std::vector<Near> near;
        std::vector<Far> far;
        size_t columns = 0;
        std::vector<float> veils;  // of each column, at all places: cd/m^2 per lx
    };
    /// The function by the cosine of the angle, without a step at its end.
    class Veil {
    public:
        explicit Veil(const EyeScatter&);
        double at(double cosine) const;

    private:
        EyeScatter psf_;
        std::vector<float> table_;
    };
    class Finder;

    Splash splash(const ScatterEntry&) const;
    static void add(std::vector<glm::vec4>& level, const Splash&, int stride, glm::vec3 light);
    int stride(uint32_t level) const { return scatter_size(own_.image, int(level)).x + 2 * kScatterMargin; }

    EyePicture own_;
    int levels_;
    Veil veil_;
    glm::ivec2 rows_;                 // texels of the top that take, and one more all around
    std::vector<glm::dvec3> places_;  // of these, in the frame of the eye, of unit length
    std::vector<Giver> givers_;
};

}  // namespace vesper::vision
