// Light that other pictures of the same eye scatter into one, so that their glare has no seams. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <vector>

#include "vision/light_sums.h"

namespace vesper {

/// One of several pictures of one eye.
struct EyePicture {
    ImageAngles image;
    glm::dmat3 turn{1};   ///< from its view frame (x right, y up, along -z) to that of the eye
    int guard = 0;        ///< px along its border that are there for the glare alone, and not shown
    bool operator==(const EyePicture&) const = default;

    /// Towards a point, px from the top left corner, in the frame of the eye; not of unit length.
    glm::dvec3 towards(glm::dvec2 pixels) const { return turn * glm::dvec3(image.at(pixels), -1); }
};

/// A lamp that no picture shows.
struct UnseenLamp {
    glm::dvec3 direction{0, 0, -1};  ///< from the eye, in its frame, of unit length
    glm::dvec3 illuminance{0};       ///< RGB lx, on a plane at the eye that faces it
};

/// What goes into the pyramid of glare from beyond a picture, cd/m^2 RGB.
struct OffscreenLight {
    std::vector<std::vector<glm::vec4>> levels;  ///< 0 .. the top: of each texel with its margin, row by row; none in the first two
    std::vector<glm::vec4> veil;                 ///< of the top: what each texel that takes has of light too far for that
};

/// Finds, for the pictures of one eye, what light of the others one of them takes, once, and then adds it up for every frame.
/// Every direction counts once: as that picture has it, or where it does not, as the others have it, in proportion to their depths there; over its guard they
/// take over gradually. Light falls into the margins of
/// the pyramid at the angle it comes from, or, beyond them, veils by the angle to each texel of the top: all of it up to 90 degrees, none from 100 on.
class LightElsewhere {
public:
    LightElsewhere(const EyeScatter&, std::span<const EyePicture> pictures, size_t own);

    /// `sums`: of each picture, the own one included. Their borders (EyePicture::guard) are kGuard wide: nothing is shown that light goes past.
    OffscreenLight of(std::span<const LightSums> sums, std::span<const UnseenLamp> lamps) const;
    /// Of the host's memory.
    uint64_t bytes() const;

    /// px. From more than 11 px away only levels from 2 on have a say: kernels of 7 x 7 on texels of 2 px, and what these take and give.
    static constexpr int kGuard = 12;

private:
    /// The splines of a place among the texels of a level.
    struct Splash {
        uint32_t level = 0, first = 0;  ///< the texel at the top left of five by five
        std::array<float, 5> x{}, y{};  ///< y: times cd/m^2 of a texel per lx
    };
    struct Near {
        uint32_t node;
        float weight;
        Splash splash;
    };
    struct Far {
        uint32_t node, column;
        float weight;
    };
    /// What one other picture gives.
    struct Giver {
        size_t picture = 0;
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
    glm::ivec2 rows_;                  // texels of the top that take, and one more all around
    std::vector<glm::dvec3> places_;   // of these, in the frame of the eye, of unit length
    std::vector<Giver> givers_;
};

}  // namespace vesper
