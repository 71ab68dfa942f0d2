// Obstacles of light within the eye, and their motion. SPDX-License-Identifier: MIT
// After Ritschel, Ihrke, Frisvad, Coppens, Myszkowski and Seidel 2009 (Temporal Glare). Lengths in mm, in the plane of
// the pupil.
#pragma once

#include <complex>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace vesper::vision {

/// Diameter of a pupil that is never at rest (hippus), mm: p + u(t) (p_max / p) sqrt(1 - p / p_max), p_max = 9 mm
/// (Ritschel et al. 2009, with u(t) in place of u(t / p)). u is smooth noise of three octaves from 0.4 Hz, about 0.2
/// mm.
double restless_pupil(double diameter, double seconds, uint32_t seed);

/// Choice of an eye, and whether it squints.
struct ApertureSettings {
    uint32_t seed = 1;    ///< selects the places of all obstacles
    bool lashes = false;  ///< lashes of the upper lid cover a part of the pupil
    bool operator==(const ApertureSettings&) const = default;
};

/// The pupil and its obstacles: the fibres of the lens, radial and outside of its middle 3 mm; particles in the lens,
/// which shear with its unrest; particles in the vitreous humour, which drift after every movement of the eye;
/// particles on the cornea, at rest.
class EyeAperture {
public:
    static constexpr int kSide = 512;              ///< samples along either side
    static constexpr double kWindow = 8;           ///< mm covered by the samples: no pupil is wider
    static constexpr double kWavelength = 575e-6;  ///< mm, wavelength of the samples
    static constexpr double kDefocus = 0.5;  ///< dioptres: the eye is short-sighted at night (Leibowitz and Owens 1975)

    explicit EyeAperture(const ApertureSettings& = {});

    /// Complex amplitude of the light of a far lamp behind a pupil of `diameter` at a time, row by row. Depends only on
    /// the arguments, not on earlier calls.
    std::vector<std::complex<double>> amplitude(double diameter, double seconds) const;

private:
    struct Particle {
        glm::dvec2 place;  // mm from the middle
        double area;       // of its shadow, mm^2
    };
    struct Fibre {
        glm::dvec2 from, to;
        double width;  // mm
    };
    ApertureSettings settings_;
    std::vector<Particle> cornea_, lens_, vitreous_;
    std::vector<Fibre> fibres_, lashes_;
};

/// Intensity of light behind an amplitude, by the angle: |F|^2 on a grid as fine as the amplitude's, its middle
/// straight ahead, kWavelength / kWindow rad from one to the next (Fraunhofer; the lens has brought infinity to the
/// retina).
std::vector<double> far_field(const std::vector<std::complex<double>>& amplitude, int side);

}  // namespace vesper::vision
