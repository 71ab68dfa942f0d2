// An eye that adapts: pigment, fast and slow neural adaptation, and what it can see meanwhile. SPDX-License-Identifier: MIT
// After the mechanisms that Irawan, Ferwerda and Marschner 2005 name. Their equations and constants were not at hand: those
// here are a reconstruction (docs/tone.md), chosen so that the adapted eye has the published thresholds exactly.
#pragma once

#include <optional>

#include "vision/thresholds.h"

namespace vesper {

/// Cones or rods: how they respond, R = L / (L + sigma), and how sigma follows the luminance they look at.
struct Receptors {
    double weber;             ///< log10 of threshold over luminance where Weber's law holds
    double semi_saturation = 2;  ///< c: sigma over luminance there; free, at least 1
    double threshold_factor = 1; ///< times all thresholds: age, low vision
    double fast_seconds;      ///< time constant of fast neural adaptation
    double slow_seconds;      ///< of slow neural adaptation
    double fast_share;        ///< part of the neural adaptation, in log units, that is fast
    double bleach_seconds;    ///< time constant of the pigment
    double bleach_trolands;   ///< td that bleach half of it

    static Receptors cones();  ///< Rushton and Henry 1968; Pattanaik et al. 2000; slow ones and shares are choices
    static Receptors rods();
};

/// What receptors remember.
struct ReceptorState {
    double pigment = 1;  ///< unbleached part
    double fast = 0;     ///< log10 of the factor that fast neural adaptation has on sigma
    double slow = 0;     ///< likewise, slow
};

enum class ReceptorKind : unsigned char { Cones, Rods };

/// Thresholds of receptors in any state. All luminances cd/m^2.
class ReceptorModel {
public:
    ReceptorModel(ReceptorKind kind, const Receptors& receptors, ThresholdBreaks breaks = ThresholdBreaks::continuous());

    /// Of the eye adapted to L; published (Ferwerda et al. 1996), times the factor of the observer.
    double adapted_threshold(double luminance) const;
    double response_step() const { return step_; }    ///< Delta R: the just noticeable difference of the response
    double dark_sigma() const { return dark_; }       ///< sigma in the dark, cd/m^2
    /// Half saturation of the eye adapted to L (closed form: its threshold at L is the published one).
    double adapted_sigma(double luminance) const;
    double adapted_pigment(double luminance) const;   ///< p = I0 / (I0 + I)
    ReceptorState adapted(double luminance) const;

    /// After `seconds` at a constant luminance, exactly, however long.
    ReceptorState after(const ReceptorState& state, double luminance, double seconds) const;
    double sigma(const ReceptorState& state) const;   ///< dark sigma * 10^(fast + slow) / pigment

    /// Smallest visible difference at L in state sigma, for small differences: Delta R (L + sigma)^2 / sigma.
    double threshold(double luminance, double sigma) const;
    /// Smallest visible increment and decrement, saturation included; nothing if none can be seen.
    std::optional<double> increment(double luminance, double sigma) const;
    std::optional<double> decrement(double luminance, double sigma) const;

private:
    /// log10 of what neural adaptation multiplies sigma with when adapted to L.
    double neural(double luminance) const;

    ReceptorKind kind_;
    Receptors receptors_;
    ThresholdBreaks breaks_;
    double step_, dark_;
};

/// Somebody who looks.
struct Observer {
    double age = 23;              ///< years: raises thresholds as Adrian 1989 has it
    double low_vision = 1;        ///< times all thresholds
    bool use_rods = false;        ///< the threshold is the lower one of cones and rods; without: foveal vision
    Receptors cones = Receptors::cones();
    Receptors rods = Receptors::rods();

    /// Receptors with the thresholds of this observer.
    Receptors observed_cones() const;
    Receptors observed_rods() const;
};

}  // namespace vesper
