#include "vision/scatter_balance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vision/scatter_cascade.h"

namespace vesper::vision {
namespace {

using glm::dvec2, glm::ivec2;

// Texels of a level, `margin` of them beyond the picture on every side.
struct Texels {
    ivec2 size{0};
    int margin = 0;
    std::vector<double> values;

    Texels(ivec2 inner, int beyond, double value)
        : size(inner + 2 * beyond), margin(beyond), values(size_t(size.x) * size_t(size.y), value) {}
    bool has(ivec2 at) const {
        return at.x >= -margin && at.y >= -margin && at.x < size.x - margin && at.y < size.y - margin;
    }
    double& operator[](ivec2 at) { return values[size_t(at.y + margin) * size_t(size.x) + size_t(at.x + margin)]; }
    double operator[](ivec2 at) const { return const_cast<Texels&>(*this)[at]; }
};

// What 1 cd/m^2 in a texel makes of the picture, in sr: one level up from what it does below, 6 x 6 texels at a time.
Texels spread(const Texels& fine, ivec2 inner) {
    Texels rows({inner.x + 2 * kScatterReach, fine.size.y}, 0, 0), all(inner, kScatterReach, 0);
    for (int y = 0; y < fine.size.y; ++y)
        for (int x = 0; x < rows.size.x; ++x) {
            double sum = 0;
            for (int k = 0; k < 6; ++k) {
                const int from = 2 * (x - kScatterReach) - 2 + k + fine.margin;
                if (from >= 0 && from < fine.size.x)
                    sum += kScatterFilter[size_t(k)] / 16 * fine.values[size_t(y) * size_t(fine.size.x) + size_t(from)];
            }
            rows[{x, y}] = sum;
        }
    for (int y = 0; y < all.size.y; ++y)
        for (int k = 0; k < 6; ++k) {
            const int from = 2 * (y - kScatterReach) - 2 + k + fine.margin;
            if (from < 0 || from >= fine.size.y) continue;
            for (int x = 0; x < all.size.x; ++x)
                all.values[size_t(y) * size_t(all.size.x) + size_t(x)] +=
                    kScatterFilter[size_t(k)] / 16 * rows[{x, from}];
        }
    return all;
}

// How much of the light of any pixel the picture has after a fit: the operator, transposed.
class Conserved {
public:
    explicit Conserved(const ScatterFit& fit)
        : fit_(fit),
          taps_(scatter_taps(fit.reach)),
          columns_(fit.top_columns() - 2 * kScatterMargin, kScatterMargin, 0) {
        const ImageAngles& image = fit.image;
        made_.emplace_back(ivec2(image.width, image.height), 0, 0);
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) made_[0][{x, y}] = steradians(ivec2(x, y));
        for (int l = 1; l <= fit.levels; ++l) made_.push_back(spread(made_.back(), scatter_size(image, l)));
        for (int l = 0; l < fit.levels; ++l)
            gives_.emplace_back(scatter_size(image, l), l == 0 ? 0 : kScatterMargin,
                                std::numeric_limits<double>::quiet_NaN());
        const size_t columns = columns_.values.size();
        for (size_t r = 0; r < made_.back().values.size(); ++r)
            for (size_t c = 0; c < columns; ++c)
                columns_.values[c] += double(fit.top[r * columns + c]) * made_.back().values[r];
    }

    /// To be called when the kernels of the fit have changed.
    void forget() {
        for (Texels& known : gives_) std::ranges::fill(known.values, std::numeric_limits<double>::quiet_NaN());
    }
    double steradians(ivec2 pixel) const {
        const dvec2 size = fit_.image.pixel();
        return size.x * size.y * steradians_per_area(fit_.image.at(dvec2(pixel) + 0.5));
    }
    // Part of the light of a pixel that is in the picture.
    double of(ivec2 pixel) {
        const std::vector<CascadeTaps> x = given(pixel.x, fit_.levels), y = given(pixel.y, fit_.levels);
        double all = sum(columns_, x.back(), y.back());
        for (size_t l = 0; l < gives_.size(); ++l)
            for (size_t j = 0; j < y[l].weights.size(); ++j)
                for (size_t i = 0; i < x[l].weights.size(); ++i) {
                    const ivec2 texel(x[l].first + int(i), y[l].first + int(j));
                    if (x[l].weights[i] * y[l].weights[j] > 0)
                        all += x[l].weights[i] * y[l].weights[j] * gives(int(l), texel);
                }
        return all / steradians(pixel);
    }

private:
    static double sum(const Texels& texels, const CascadeTaps& x, const CascadeTaps& y) {
        double all = 0;
        for (size_t j = 0; j < y.weights.size(); ++j)
            for (size_t i = 0; i < x.weights.size(); ++i) {
                const ivec2 texel(x.first + int(i), y.first + int(j));
                if (texels.has(texel)) all += x.weights[i] * y.weights[j] * texels[texel];
            }
        return all;
    }
    // What a texel of a level gives to the picture by the kernels of its neighbours, sr.
    double gives(int level, ivec2 texel) {
        Texels& known = gives_[size_t(level)];
        if (!known.has(texel)) return 0;
        double& all = known[texel];
        if (!std::isnan(all)) return all;
        const Texels& made = made_[size_t(level)];
        all = 0;
        for (int t = 0; t < fit_.taps(); ++t)
            for (const int side : {1, -1}) {
                const ivec2 to = texel - side * taps_[size_t(t)];
                if ((t > 0 || side > 0) && made.has(to)) all += weight(level, to, texel.y, t) * made[to];
            }
        return all;
    }
    // Of a tap, as the passes have it: in the middle of a strip's columns, linear from its top to its bottom, for the
    // pair of rows that gives.
    double weight(int level, ivec2 to, int from_row, int tap) const {
        const int margin = made_[size_t(level)].margin;
        const ivec2 strip(fit_.strip.x, scatter_strip(fit_.image, fit_.nodes, level, fit_.strip.y)),
            first = (to + margin) / strip * strip - margin;
        const double part = (2 * ((from_row - first.y + 2 * strip.y) / 2 - strip.y) + 1.0) / strip.y;
        const dvec2 upper = dvec2(first) + dvec2(0.5 * strip.x, 0);
        return glm::mix(at_place(level, upper, tap), at_place(level, upper + dvec2(0, strip.y), tap), part);
    }
    double at_place(int level, dvec2 texels, int tap) const {
        const dvec2 part = std::exp2(level) * texels / dvec2(fit_.image.width, fit_.image.height);
        const BetweenNodes x = between_nodes(part.x, fit_.nodes.x), y = between_nodes(part.y, fit_.nodes.y);
        const auto at = [&](int dx, int dy) {
            return double(fit_.kernels[size_t(
                (((y.first + dy) * fit_.nodes.x + x.first + dx) * fit_.levels + level) * fit_.taps() + tap)]);
        };
        return glm::mix(glm::mix(at(0, 0), at(1, 0), x.part), glm::mix(at(0, 1), at(1, 1), x.part), y.part);
    }

    const ScatterFit& fit_;
    std::vector<ivec2> taps_;
    std::vector<Texels> made_;   // what 1 cd/m^2 in a texel of what is scattered makes of the picture, sr
    std::vector<Texels> gives_;  // gives() as far as it has been asked for
    Texels columns_;
};

double wanted(const EyeScatter& psf, const ImageAngles& image, ivec2 pixel) {
    const dvec2 at = image.at(dvec2(pixel) + 0.5);
    return light_within(psf, at, image.low - at, image.high - at);
}

// What is missing away from the border, each node's part of it, is what pixels keep there beyond what the fit says.
void balance_nodes(const EyeScatter& psf, Conserved& conserved, ScatterFit& fit) {
    constexpr int kSamples = 3;  // from node to node, along either axis
    const ivec2 size(fit.image.width, fit.image.height), low = glm::min(ivec2(EdgeLight::kDeep), (size - 1) / 2);
    struct Sample {
        BetweenNodes x, y;
        double missing;
    };
    std::vector<Sample> samples;
    const ivec2 last = kSamples * (fit.nodes - 1);
    for (int v = 0; v <= last.y; ++v)
        for (int u = 0; u <= last.x; ++u) {
            const ivec2 pixel = glm::clamp(ivec2(dvec2(size) * dvec2(u, v) / dvec2(last)), low, size - 1 - low);
            const dvec2 part = (dvec2(pixel) + 0.5) / dvec2(size);
            samples.push_back({between_nodes(part.x, fit.nodes.x), between_nodes(part.y, fit.nodes.y),
                               wanted(psf, fit.image, pixel) - conserved.of(pixel)});
        }
    for (int round = 0; round < 3; ++round) {
        std::vector<double> sums(size_t(fit.nodes.x * fit.nodes.y), 0), weights = sums;
        const auto each_node = [&](const Sample& s, auto&& use) {
            for (int i = 0; i < 4; ++i)
                use(size_t((s.y.first + (i >> 1)) * fit.nodes.x + s.x.first + (i & 1)),
                    ((i & 1) ? s.x.part : 1 - s.x.part) * ((i >> 1) ? s.y.part : 1 - s.y.part));
        };
        for (const Sample& s : samples)
            each_node(s, [&](size_t node, double w) { sums[node] += w * s.missing, weights[node] += w; });
        for (size_t node = 0; node < sums.size(); ++node) {
            sums[node] /= std::max(weights[node], 1e-9);  // a node of a tiny picture may have no pixel near it
            fit.kernels[node * size_t(fit.levels * fit.taps())] += float(sums[node]);
        }
        for (Sample& s : samples) each_node(s, [&](size_t node, double w) { s.missing -= w * sums[node]; });
    }
}

}  // namespace

double EdgeLight::Axis::place(double pixel) const {
    const double middle = pixels - 2 * deep + 1;  // from the last one of the first to the first one of the last
    return std::min(pixel, deep - 1.0) + std::clamp(pixel - (deep - 1), 0.0, middle) * (between + 1) / middle +
           std::max(pixel - (pixels - deep), 0.0);
}

int EdgeLight::Axis::pixel(int place) const {
    if (place < deep) return place;
    if (place >= deep + between) return pixels - places() + place;
    return deep - 1 + int(std::lround(double(place - deep + 1) * (pixels - 2 * deep + 1) / (between + 1)));
}

void conserve_light(const EyeScatter& psf, ScatterFit& fit) {
    Conserved conserved(fit);
    balance_nodes(psf, conserved, fit);
    conserved.forget();
    const auto axis = [](int pixels, int nodes) {
        const int deep = std::min(EdgeLight::kDeep, pixels / 2);
        return EdgeLight::Axis{pixels, deep, std::min(nodes, pixels - 2 * deep)};
    };
    EdgeLight& edge = fit.edge;
    edge.x = axis(fit.image.width, fit.nodes.x), edge.y = axis(fit.image.height, fit.nodes.y);
    for (int y = 0; y < edge.y.places(); ++y)
        for (int x = 0; x < edge.x.places(); ++x) {
            const bool inner_x = x >= edge.x.deep && x < edge.x.deep + edge.x.between,
                       inner_y = y >= edge.y.deep && y < edge.y.deep + edge.y.between;
            const ivec2 pixel(edge.x.pixel(x), edge.y.pixel(y));
            edge.kept.push_back(inner_x && inner_y ? 0.0f : float(wanted(psf, fit.image, pixel) - conserved.of(pixel)));
        }
}

}  // namespace vesper::vision
