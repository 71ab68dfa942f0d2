// Discrete Fourier transforms of pictures. SPDX-License-Identifier: MIT
#pragma once

#include <complex>
#include <cstddef>
#include <vector>

namespace vesper::vision {

using Complexes = std::vector<std::complex<double>>;

/// Spectrum of a picture of width x height samples, row by row: the sum of sample (x, y) times exp(-2 pi i (u x / width
/// + v y / height)) stands at u * height + v, column by column. Runs on all processors.
Complexes spectrum_of(const Complexes& rows, size_t width, size_t height);

/// The inverse, scaled by 1 / (width height): samples row by row, of a spectrum column by column.
Complexes picture_of(const Complexes& columns, size_t width, size_t height);

/// The least number from `least` on that is `step` times a product of 2, 3 and 5: transforms of these are fast.
size_t fast_length(size_t least, size_t step);

}  // namespace vesper::vision
