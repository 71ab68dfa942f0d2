// An eye that adapts: pigment, fast and slow neural adaptation, and its thresholds during adaptation.
// SPDX-License-Identifier: MIT
// Mechanisms of Irawan, Ferwerda and Marschner 2005. Equations and constants are a reconstruction
// (docs/reconstructions.md): the adapted eye has exactly the published thresholds.
#pragma once

#include <optional>

#include "vision/thresholds.h"

namespace vesper::vision {

/// Parameters of cones or rods: response R = L / (L + sigma), and the time course of sigma.
struct Receptors {
    double weber;                 ///< log10 of threshold over luminance where Weber's law holds
    double semi_saturation = 2;   ///< c: sigma over luminance there; at least 1
    double threshold_factor = 1;  ///< times all thresholds: age, low vision
    double fast_seconds;          ///< time constant of fast neural adaptation
    double slow_seconds;          ///< of slow neural adaptation
    double fast_share;            ///< part of the neural adaptation, in log units, that is fast
    double bleach_seconds;        ///< time constant of the pigment
    double bleach_trolands;       ///< td that bleach half of it

    static Receptors cones();  ///< Rushton and Henry 1968; Pattanaik et al. 2000; slow ones and shares are choices
    static Receptors rods();
};

/// State of adaptation of receptors.
struct ReceptorState {
    double pigment = 1;  ///< unbleached part
    double fast = 0;     ///< log10 of the factor of fast neural adaptation on sigma
    double slow = 0;     ///< likewise, slow
};

enum class ReceptorKind : unsigned char { Cones, Rods };

/// Thresholds of receptors in any state. All luminances cd/m^2.
class ReceptorModel {
public:
    ReceptorModel(ReceptorKind kind, const Receptors& receptors,
                  ThresholdBreaks breaks = ThresholdBreaks::continuous());

    /// Threshold of the eye adapted to L, cd/m^2 (Ferwerda et al. 1996), times the factor of the observer.
    double adapted_threshold(double luminance) const;
    double response_step() const { return step_; }  ///< Delta R: the just noticeable difference of the response
    double dark_sigma() const { return dark_; }     ///< sigma in the dark, cd/m^2
    /// Half saturation of the eye adapted to L, cd/m^2, in closed form from its threshold.
    double adapted_sigma(double luminance) const;
    double adapted_pigment(double luminance) const;  ///< p = I0 / (I0 + I)
    ReceptorState adapted(double luminance) const;

    /// State after `seconds` at a constant luminance; exact for any duration.
    ReceptorState after(const ReceptorState& state, double luminance, double seconds) const;
    double sigma(const ReceptorState& state) const;  ///< dark sigma * 10^(fast + slow) / pigment

    /// Least visible small difference at L, cd/m^2: Delta R (L + sigma)^2 / sigma.
    double threshold(double luminance, double sigma) const;
    /// Least visible increment and decrement, cd/m^2, with saturation; empty if none is visible.
    std::optional<double> increment(double luminance, double sigma) const;
    std::optional<double> decrement(double luminance, double sigma) const;

private:
    /// log10 of the factor of neural adaptation on sigma, adapted to L.
    double neural(double luminance) const;

    ReceptorKind kind_;
    Receptors receptors_;
    ThresholdBreaks breaks_;
    double step_, dark_;
};

/// An observer.
struct Observer {
    double age = 23;        ///< years; raises thresholds (Adrian 1989)
    double low_vision = 1;  ///< times all thresholds
    bool use_rods = false;  ///< true: the lower threshold of cones and rods; false: foveal vision
    Receptors cones = Receptors::cones();
    Receptors rods = Receptors::rods();

    /// Receptors with the thresholds of this observer.
    Receptors observed_cones() const;
    Receptors observed_rods() const;
};

}  // namespace vesper::vision
