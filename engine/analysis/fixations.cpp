#include "analysis/fixations.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"

namespace vesper::analysis {
namespace {

glm::dvec3 direction(const vision::ImageAngles& picture, glm::dvec2 pixels) {
    return glm::normalize(glm::dvec3(picture.at(pixels), -1));
}

/// From 1; means where values are equal.
std::vector<double> ranks(std::span<const float> values) {
    std::vector<size_t> order(values.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::sort(order.begin(), order.end(), [&](size_t i, size_t j) { return values[i] < values[j]; });
    std::vector<double> made(values.size());
    for (size_t first = 0, end = 0; first < order.size(); first = end) {
        while (end < order.size() && !(values[order[first]] < values[order[end]])) ++end;
        for (size_t i = first; i < end; ++i) made[order[i]] = static_cast<double>(first + 1 + end) / 2;
    }
    return made;
}

}  // namespace

double angle_between(const vision::ImageAngles& picture, glm::dvec2 a, glm::dvec2 b) {
    const glm::dvec3 from = direction(picture, a), to = direction(picture, b);
    return std::atan2(glm::length(glm::cross(from, to)), glm::dot(from, to));
}

std::vector<Fixation> fixations(const PictureMap& map, const vision::ImageAngles& picture, double radius, size_t most) {
    if (map.values.size() != map.width * map.height) throw Error("a map does not have as many values as texels");
    std::vector<float> left(map.values.begin(), map.values.end());
    for (float& value : left)
        if (!std::isfinite(value)) value = 0;
    const auto middle = [&](size_t i) {
        const glm::dvec2 texel(i % map.width, i / map.width);
        return 0.5 * map.texel * texel +
               0.5 * glm::min(map.texel * (texel + 1.0), glm::dvec2(picture.width, picture.height));
    };
    std::vector<Fixation> found;
    while (found.size() < most && !left.empty()) {
        const auto winner = std::max_element(left.begin(), left.end());
        if (!(*winner > 0)) break;
        found.push_back({middle(static_cast<size_t>(winner - left.begin())), static_cast<double>(*winner)});
        *winner = 0;
        for (size_t i = 0; i < left.size(); ++i)
            if (left[i] > 0 && angle_between(picture, found.back().pixels, middle(i)) <= radius) left[i] = 0;
    }
    return found;
}

std::optional<double> rank_correlation(std::span<const float> a, std::span<const float> b) {
    if (a.size() != b.size()) throw Error("lists of different lengths have no rank correlation");
    const auto finite = [](float value) { return std::isfinite(value); };
    if (!std::all_of(a.begin(), a.end(), finite) || !std::all_of(b.begin(), b.end(), finite))
        throw Error("values that are not finite have no ranks");
    const std::vector<double> first = ranks(a), second = ranks(b);
    const double mean = (static_cast<double>(a.size()) + 1) / 2;
    double product = 0, square_a = 0, square_b = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        product += (first[i] - mean) * (second[i] - mean);
        square_a += (first[i] - mean) * (first[i] - mean);
        square_b += (second[i] - mean) * (second[i] - mean);
    }
    if (!(square_a > 0) || !(square_b > 0)) return {};
    return product / std::sqrt(square_a * square_b);
}

}  // namespace vesper::analysis
