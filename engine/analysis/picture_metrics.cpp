#include "analysis/picture_metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/parallel.h"

namespace vesper::analysis {
namespace {

constexpr double kDarkest = 1e-4;  // cd/m^2, of logarithms
constexpr double kRange = 256;     // of PU21, at 100 cd/m^2
constexpr uint32_t kWindow = 11;
constexpr double kSigma = 1.5;

double squares(std::span<const float> a, std::span<const float> b, double (*value)(double)) {
    double sum = 0, pixels = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        const double difference = value(double(a[i])) - value(double(b[i]));
        if (std::isfinite(difference)) sum += difference * difference, ++pixels;
    }
    return pixels > 0 ? sum / pixels : 0;
}

std::array<double, kWindow> window() {
    std::array<double, kWindow> weights{};
    double sum = 0;
    for (uint32_t i = 0; i < kWindow; ++i) {
        const double x = (i - (kWindow - 1) / 2.0) / kSigma;
        sum += weights[i] = std::exp(-x * x / 2);
    }
    for (double& weight : weights) weight /= sum;
    return weights;
}

// Means of both, of their squares and of their product.
using Moments = std::array<double, 5>;

double similarity(const Moments& m) {
    constexpr double c1 = 0.01 * kRange * 0.01 * kRange, c2 = 0.03 * kRange * 0.03 * kRange;
    const double va = m[2] - m[0] * m[0], vb = m[3] - m[1] * m[1], ab = m[4] - m[0] * m[1];
    return (2 * m[0] * m[1] + c1) * (2 * ab + c2) / ((m[0] * m[0] + m[1] * m[1] + c1) * (va + vb + c2));
}

}  // namespace

double pu21(double luminance) {
    constexpr std::array p{0.353487901,   0.3734658629, 8.277049286e-05, 0.9062562627,
                           0.09150303166, 0.9099517204, 596.3148142};
    const double y = std::pow(std::clamp(luminance, 0.005, 10000.0), p[3]);
    return std::max(p[6] * (std::pow((p[0] + p[1] * y) / (1 + p[2] * y), p[4]) - p[5]), 0.0);
}

double log_rmse(std::span<const float> a, std::span<const float> b) {
    return std::sqrt(squares(a, b, [](double l) { return std::isfinite(l) ? std::log10(std::max(l, kDarkest)) : l; }));
}

double pu21_psnr(std::span<const float> a, std::span<const float> b) {
    return 20 * std::log10(kRange / std::sqrt(squares(a, b, [](double l) { return std::isfinite(l) ? pu21(l) : l; })));
}

std::optional<double> pu21_ssim(std::span<const float> a, std::span<const float> b, uint32_t width, uint32_t height) {
    if (width < kWindow || height < kWindow) return std::nullopt;
    const std::array<double, kWindow> weights = window();
    const uint32_t columns = width - kWindow + 1, rows = height - kWindow + 1;
    const auto value = [](float l) { return std::isfinite(l) ? pu21(double(l)) : 0; };
    std::vector<Moments> across(size_t{columns} * height);
    in_parallel(height, 8, [&](size_t begin, size_t end) {
        std::vector<Moments> line(width);
        for (size_t y = begin; y < end; ++y) {
            for (size_t x = 0; x < width; ++x) {
                const double p = value(a[y * width + x]), q = value(b[y * width + x]);
                line[x] = {p, q, p * p, q * q, p * q};
            }
            for (size_t x = 0; x < columns; ++x)
                for (size_t i = 0; i < kWindow; ++i)
                    for (size_t k = 0; k < 5; ++k) across[y * columns + x][k] += weights[i] * line[x + i][k];
        }
    });
    std::vector<double> sums(rows);
    in_parallel(rows, 8, [&](size_t begin, size_t end) {
        for (size_t y = begin; y < end; ++y)
            for (size_t x = 0; x < columns; ++x) {
                Moments down{};
                for (size_t i = 0; i < kWindow; ++i)
                    for (size_t k = 0; k < 5; ++k) down[k] += weights[i] * across[(y + i) * columns + x][k];
                sums[y] += similarity(down);
            }
    });
    double sum = 0;
    for (const double row : sums) sum += row;
    return sum / (double(columns) * rows);
}

}  // namespace vesper::analysis
