// Plain figures of the difference of two pictures. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace vesper::analysis {

/// Perceptually uniform values of luminance in cd/m^2 (Mantiuk and Azimi 2021, PU21, fit "banding_glare"): 0 at 0.005
/// cd/m^2 and below, 256 at 100, 595 at 10,000 and above.
double pu21(double luminance);

/// Root mean square difference of log10 of luminance, cd/m^2, of which what is below 1e-4 counts as that, and what is
/// not finite is left out.
double log_rmse(std::span<const float> a, std::span<const float> b);

/// Peak signal-to-noise ratio of pu21(), dB, for a peak of 256; infinite for equal pictures.
double pu21_psnr(std::span<const float> a, std::span<const float> b);

/// Mean structural similarity of pu21() for a range of 256 (Wang, Bovik, Sheikh and Simoncelli 2004: Gaussian windows
/// of 11 x 11 px, sigma 1.5 px, K1 0.01, K2 0.03), over the windows within the picture; none where there is no window.
std::optional<double> pu21_ssim(std::span<const float> a, std::span<const float> b, uint32_t width, uint32_t height);

}  // namespace vesper::analysis
