// What repeated measurements say. SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

namespace vesper::bench {

/// Between order statistics linearly (Hyndman and Fan 1996, definition 7; R's default), of values in ascending order.
/// `percent` in [0, 100]. 0 of nothing.
double percentile(std::span<const double> ascending, double percent);

/// The median of all values, and the least and greatest of the medians of the laps: the same path, driven again.
struct Spread {
    double median = 0, low = 0, high = 0;
};

/// One quantity, frame by frame and lap by lap.
class Samples {
public:
    void next_lap() { laps_.emplace_back(); }
    void add(double value) { laps_.back().push_back(value); }
    std::vector<double> ascending() const;  ///< of all laps
    Spread spread() const;                  ///< laps without a value do not count

private:
    std::vector<std::vector<double>> laps_ = std::vector<std::vector<double>>(1);
};

/// Frames per second over the slowest hundredth of the frames, at least one of them: frames by the time they took
/// together.
double one_percent_low(std::span<const double> ascending_ms);

/// How B relates to A, and between what it lies as laps differ: the least lap of one by the greatest of the other.
struct Ratio {
    double median, low, high;
};
/// Of quantities above 0; all zeros otherwise.
Ratio ratio(const Spread& a, const Spread& b);

}  // namespace vesper::bench
