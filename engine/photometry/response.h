// The response of a camera: codes over exposure. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include <glm/glm.hpp>

#include "io/image_file.h"

namespace vesper::photometry {

/// One of several pictures of the same scene.
struct Exposure {
    Image image;          ///< 8-bit codes
    double exposure = 1;  ///< relative amount of light let in, > 0: time * ISO speed / f-number^2
    glm::ivec2 shift{0};  ///< pixel (x, y) of the scene is at (x, y) + shift in this image, px
};

/// g(Z) = ln X of Debevec and Malik 1997: the exposure X that gives code Z, for R, G and B. Only ratios have a meaning:
/// g(128) = 0. The scales of the three channels are such that three codes of 128 are grey.
struct Response {
    std::array<std::array<double, 256>, 3> ln_exposure{};
};

/// Codes proportional to X^(1/gamma); gamma 1 is a linear sensor. Code 0 counts as 1/2.
Response gamma_response(double gamma);
/// The inverse of IEC 61966-2-1.
Response srgb_response();

/// Weight of a code: 0 at both ends of the range, where noise and saturation are, 1 in its middle (eq. 4).
constexpr double code_weight(int code) { return (code < 128 ? code : 255 - code) / 127.5; }

/// Precision of ln X from a code of one channel with equal noise of codes: 1 / g'(Z)^2, the inverse of its variance,
/// lowered within 32 codes of both ends, where pictures saturate. (M. Robertson et al., "Estimation-theoretic approach
/// to dynamic range enhancement using multiple exposures", Journal of Electronic Imaging 12(2), 2003, have this weight
/// for light instead of its logarithm.)
std::array<double, 256> code_precisions(const std::array<double, 256>& ln_exposure);

struct RecoveredResponse {
    Response response;
    std::array<double, 3> error{};   ///< weighted rms of g(Z) - ln E - ln t: a relative error of exposures
    std::array<size_t, 3> pixels{};  ///< that were looked at
    std::array<int, 3> falls{};      ///< codes from 1 to 254 that stand for less light than the code below
};

/// Recovers the response from at least two pictures of equal size and different exposure: minimizes (eq. 3) sum w(Z)^2
/// (g(Z) - ln E - ln t)^2 + lambda^2 sum w(z)^2 s''(z)^2 over g and the irradiances E of pixels spread over the picture
/// and over all codes, where s is g less its best a ln z + b ln(z + 0.055) + c ln(1.1 - z), z from 0 to 1.
/// Deterministic. `smoothness` is lambda, where each code has data of weight one. Throws Error if the pictures do not
/// determine it.
RecoveredResponse recover_response(std::span<const Exposure>, double smoothness = 100);

/// Number of codes from 1 to 254 that stand for less light than the code below.
std::array<int, 3> count_falls(const Response&);

/// A table of 256 lines "code, g of R, G and B" under one line of headings that name the channels. Throws Error.
void write_response(const std::filesystem::path& file, const Response&);
Response read_response(const std::filesystem::path& file);

}  // namespace vesper::photometry
