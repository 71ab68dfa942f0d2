#include "analysis/summed_energy.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/budget.h"
#include "base/parallel.h"

namespace vesper::analysis {
namespace {

constexpr double kWindow = 1.75;  // square roots of the area: weights beyond are below 1e-4 of the first one

// Weights by the distance in samples, whose sum over a whole row is 1.
std::vector<double> weights_of(double area, double degrees, size_t length) {
    const auto reach = size_t(std::min(std::ceil(kWindow * std::sqrt(area) / degrees), double(length - 1)));
    std::vector<double> weights(reach + 1);
    for (size_t i = 0; i <= reach; ++i)
        weights[i] = degrees / std::sqrt(area) * std::exp(-kPi * degrees * degrees * double(i * i) / area);
    return weights;
}

// Weighted sums along rows of `width`, as columns.
std::vector<double> summed_in_rows(std::span<const double> rows, size_t width, const std::vector<double>& weights) {
    const size_t height = rows.size() / width, reach = weights.size() - 1;
    std::vector<double> columns(rows.size());
    in_parallel(height, 8, [&](size_t begin, size_t end) {
        std::vector<double> row(width + 2 * reach), sums(width);
        for (size_t y = begin; y < end; ++y) {
            check_time();
            std::copy_n(rows.data() + y * width, width, row.data() + reach);
            for (size_t x = 0; x < width; ++x) sums[x] = weights[0] * row[x + reach];
            for (size_t i = 1; i <= reach; ++i)
                for (size_t x = 0; x < width; ++x) sums[x] += weights[i] * (row[x + reach - i] + row[x + reach + i]);
            for (size_t x = 0; x < width; ++x) columns[x * height + y] = sums[x];
        }
    });
    return columns;
}

}  // namespace

std::vector<double> summed_energies(std::span<const double> energies, const ChannelGrid& grid, double pixels_per_degree,
                                    double area) {
    const double degrees = grid.step / pixels_per_degree;
    return summed_in_rows(summed_in_rows(energies, grid.width, weights_of(area, degrees, grid.width)), grid.height,
                          weights_of(area, degrees, grid.height));
}

}  // namespace vesper::analysis
