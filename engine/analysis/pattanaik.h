// Visual adaptation after Pattanaik, Tumblin, Yee and Greenberg 2000, on Hunt's model. SPDX-License-Identifier: MIT
#pragma once

namespace vesper::analysis::pattanaik {

/// Pattanaik adaptation state. Luminances in cd/m^2; pigment is the unbleached part.
struct State {
    double cones = 0, rods = 0;  ///< adaptation luminance, pattanaik
    double cone_pigment = 1, rod_pigment = 1;
};

/// 5e5 as in Hunt and in the paper; pfstmo_pattanaik00 has 5e4.
constexpr double kRodConstant = 5e5;

/// n: responses are x / (1 + x), x = (L / sigma)^n.
constexpr double kExponent = 0.73;

/// Half saturation of cones and rods adapted to a luminance, cd/m^2.
double cone_sigma(double adaptation);
double rod_sigma(double adaptation, double rod_constant = kRodConstant);

/// `scotopic`: of the goal, scotopic cd/m^2, for rods.
State adapted(double goal, double scotopic);
/// After `seconds` of looking at `goal`, exactly.
State after(const State&, double goal, double scotopic, double seconds);

/// Appearance of a luminance on a display whose viewer is adapted to 25 cd/m^2.
struct Shown {
    double luminance;        ///< relative to the display's white of 125 cd/m^2; may exceed 1
    double colour_exponent;  ///< of the colour's ratios
    double cone_share;       ///< of the response; the rest is grey
};
class Appearance {
public:
    explicit Appearance(const State&, double rod_constant = kRodConstant);
    Shown operator()(double luminance, double scotopic) const;

    /// Responses of the display's viewer to a luminance and to a scotopic luminance; the total is their sum plus
    /// offset().
    double cones(double luminance) const;
    double rods(double scotopic) const;
    double offset() const { return offset_; }

private:
    State state_;
    double cone_sigma_, rod_sigma_;
    double scale_ = 1, offset_ = 0;
};

}  // namespace vesper::analysis::pattanaik
