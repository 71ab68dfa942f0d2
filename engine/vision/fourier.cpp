#include "vision/fourier.h"

#include <algorithm>

#include <unsupported/Eigen/FFT>

#include "base/parallel.h"

namespace vesper::vision {
namespace {

using Complex = std::complex<double>;

constexpr size_t kLinesAtATime = 16;  // their transposed columns fill lines of the cache

// Of one line. The library has no transform of a single sample, which is the sample.
void transform(Eigen::FFT<double>& fft, Complex* to, const Complex* from, size_t length, bool inverse) {
    const auto n = Eigen::Index(length);
    if (length == 1)
        *to = *from;
    else if (inverse)
        fft.inv(to, from, n);
    else
        fft.fwd(to, from, n);
}

// Transforms each of `count` rows of `length`, and writes it as a column.
Complexes transformed(const Complexes& rows, size_t length, size_t count, bool inverse) {
    Complexes columns(rows.size());
    in_parallel(count, kLinesAtATime, [&](size_t begin, size_t end) {
        Eigen::FFT<double> fft;
        Complexes block((end - begin) * length);
        for (size_t row = begin; row < end; ++row)
            transform(fft, &block[(row - begin) * length], &rows[row * length], length, inverse);
        for (size_t x = 0; x < length; ++x)
            for (size_t row = begin; row < end; ++row) columns[x * count + row] = block[(row - begin) * length + x];
    });
    return columns;
}

// Both passes; the second one turns columns back into rows, which the caller does not want of a spectrum.
Complexes transformed_both_ways(const Complexes& lines, size_t length, size_t count, bool inverse) {
    Complexes turned = transformed(lines, length, count, inverse);
    in_parallel(length, kLinesAtATime, [&](size_t begin, size_t end) {
        Eigen::FFT<double> fft;
        Complexes line(count);
        for (size_t i = begin; i < end; ++i) {
            Complex* const at = &turned[i * count];
            transform(fft, line.data(), at, count, inverse);
            std::copy(line.begin(), line.end(), at);
        }
    });
    return turned;
}

}  // namespace

Complexes spectrum_of(const Complexes& rows, size_t width, size_t height) {
    return transformed_both_ways(rows, width, height, false);
}

Complexes picture_of(const Complexes& columns, size_t width, size_t height) {
    return transformed_both_ways(columns, height, width, true);
}

size_t fast_length(size_t least, size_t step) {
    for (size_t n = std::max<size_t>((least + step - 1) / step, 1);; ++n) {
        size_t rest = n;
        for (const size_t factor : {2, 3, 5})
            while (rest % factor == 0) rest /= factor;
        if (rest == 1) return n * step;
    }
}

}  // namespace vesper::vision
