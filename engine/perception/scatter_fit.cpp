#include "perception/scatter_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>

namespace vesper {
namespace {

using glm::dvec2, glm::dvec3, glm::ivec2;

constexpr int kTopTexels = 1100;   // at most so many texels of the top make the picture
constexpr double kNodeStep = 0.14;  // tangents between two nodes, at most
constexpr int kPhases = 8;        // places of the eye's axis within a texel of the top
constexpr int kAzimuths = 12;
constexpr int kNear = 3;          // texels of the top whose weights are fitted
constexpr int kFar = 16;          // texels of the top beyond which light is counted, not added up
constexpr double kBalance = 1e4;  // of the light, against the rows of the fit

// Weights per axis from the texels of the level `from` downwards to what they make of pixel p: first texel, and weights.
struct Taps {
    int first = 0;
    std::vector<double> weights;
    double at(int i) const { return i < first || i >= first + int(weights.size()) ? 0 : weights[size_t(i - first)]; }
};

int half_down(int i) { return i >= 0 ? i / 2 : -((1 - i) / 2); }

// One level up from what pixels make of a level; `gain` 1/32 on the way up (means), 1/16 on the way down (sums to one).
Taps coarser(const Taps& fine, double gain) {
    const int last = fine.first + int(fine.weights.size()) - 1;
    Taps taps{half_down(fine.first - 2), {}};
    for (int j = taps.first; 2 * j - 2 <= last; ++j) {
        double sum = 0;
        for (int k = 0; k < 6; ++k) sum += kScatterFilter[size_t(k)] * fine.at(2 * j - 2 + k);
        taps.weights.push_back(gain * sum);
    }
    return taps;
}

// For levels 0 .. levels: of a pixel, what it gives to each texel (down), and what it takes of each (up).
std::vector<Taps> cascade(int pixel, int levels, double gain) {
    std::vector<Taps> all{{pixel, {1.0}}};
    for (int l = 0; l < levels; ++l) all.push_back(coarser(all.back(), gain));
    return all;
}

// Response at a pixel to another through one level, for a shift of `t` texels between them, on one axis.
double response(const Taps& takes, const Taps& gives, int t) {
    double sum = 0;
    for (size_t i = 0; i < takes.weights.size(); ++i) sum += takes.weights[i] * gives.at(takes.first + int(i) + t);
    return sum;
}

dvec3 ray(dvec2 tangents) { return glm::normalize(dvec3(tangents, 1)); }

// Weights of texels of the top for one place, from the one whose middle lies at `first` onwards, right and down. Sharpened by
// what the filters on the way there and back blur (variance: 2 * 5/12 texels^2): G - variance/2 * Laplacian.
std::vector<double> far_weights(const EyeScatter& psf, const ImageAngles& image, int levels, dvec2 to, dvec2 first, ivec2 count) {
    const dvec2 texel = std::exp2(levels) * image.pixel() * dvec2(1, -1);
    const int stride = count.x + 2;
    std::vector<double> seen;
    for (int y = -1; y <= count.y; ++y)
        for (int x = -1; x <= count.x; ++x) {
            const dvec2 p = first + texel * dvec2(x, y);
            seen.push_back(psf(degrees_between(to, p)) * -texel.x * texel.y * steradians_per_area(p));
        }
    const double sharpening = 5.0 / 12 * (1 - std::exp2(-2 * levels));
    std::vector<double> weights;
    for (int y = 0; y < count.y; ++y)
        for (int x = 0; x < count.x; ++x) {
            const double* at = &seen[size_t((y + 1) * stride + x + 1)];
            weights.push_back(at[0] - sharpening * (at[1] + at[-1] + at[stride] + at[-stride] - 4 * at[0]));
        }
    return weights;
}

// What every weight makes of every sample, the same wherever the eye looks: rows of the fit.
struct Samples {
    struct Row {
        size_t offset;                                // which of `offsets`
        std::array<double, 2 * kFar + 1> top_x, top_y;  // response of the top to shifts of -kFar .. kFar texels
    };
    std::vector<ivec2> offsets;  // px from the eye's axis to the source
    std::vector<ivec2> top;      // taps of the top, without opposite ones
    std::vector<Row> rows;
    Eigen::MatrixXd responses;   // a row for each of `rows`; a column for each tap of the levels, then of the top

    explicit Samples(int levels);
};

// Pixels about the eye's axis, those near it all, then along rings of growing radius.
std::vector<ivec2> sample_offsets(int levels) {
    std::vector<ivec2> all;
    for (int y = -3; y <= 3; ++y)
        for (int x = -3; x <= 3; ++x) all.push_back({x, y});
    const double last = (kNear + 2) * std::exp2(levels);
    for (double r = 4.2, turn = 0; r < last; r *= 1.17, turn += 0.618)
        for (int i = 0; i < kAzimuths; ++i) {
            const double azimuth = 2 * std::numbers::pi * (i + turn) / kAzimuths;
            all.push_back(ivec2(glm::round(r * dvec2(std::cos(azimuth), std::sin(azimuth)))));
        }
    return all;
}

Samples::Samples(int levels) : offsets(sample_offsets(levels)) {
    for (int y = 0; y <= kNear; ++y)
        for (int x = y == 0 ? 0 : -kNear; x <= kNear; ++x) top.push_back({x, y});
    const int first_top = first_scatter_tap(levels);
    responses = Eigen::MatrixXd::Zero(Eigen::Index(kPhases * offsets.size()), first_top + Eigen::Index(top.size()));
    for (int phase = 0; phase < kPhases; ++phase) {
        // The R2 sequence (Roberts 2018) fills the texel of the top evenly.
        const double size = std::exp2(levels);
        const ivec2 q(int(size * std::fmod(0.5 + 0.7548776662 * phase, 1)), int(size * std::fmod(0.5 + 0.5698402910 * phase, 1)));
        const std::vector<Taps> takes_x = cascade(q.x, levels, 1.0 / 16), takes_y = cascade(q.y, levels, 1.0 / 16);
        for (size_t s = 0; s < offsets.size(); ++s) {
            const ivec2 p = q + offsets[s];
            const std::vector<Taps> gives_x = cascade(p.x, levels, 1.0 / 32), gives_y = cascade(p.y, levels, 1.0 / 32);
            const auto r = Eigen::Index(rows.size());
            const auto add = [&](int column, ivec2 d, const auto& x, const auto& y) {
                responses(r, column) = x(d.x) * y(d.y) + (d == ivec2(0) ? 0 : x(-d.x) * y(-d.y));
            };
            for (int l = 0; l < levels; ++l) {
                const auto x = [&](int t) { return response(takes_x[size_t(l)], gives_x[size_t(l)], t); };
                const auto y = [&](int t) { return response(takes_y[size_t(l)], gives_y[size_t(l)], t); };
                for (int i = 0; i < scatter_taps(l); ++i) add(first_scatter_tap(l) + i, kScatterTaps[size_t(i)], x, y);
            }
            Row row{s, {}, {}};
            for (int d = -kFar; d <= kFar; ++d) {
                row.top_x[size_t(d + kFar)] = response(takes_x.back(), gives_x.back(), d);
                row.top_y[size_t(d + kFar)] = response(takes_y.back(), gives_y.back(), d);
            }
            const auto x = [&](int t) { return row.top_x[size_t(t + kFar)]; };
            const auto y = [&](int t) { return row.top_y[size_t(t + kFar)]; };
            for (size_t i = 0; i < top.size(); ++i) add(first_top + int(i), top[i], x, y);
            rows.push_back(row);
        }
    }
}

// Weights of the texels of the top about the one that a place lies in the middle of; none for those that are fitted.
std::vector<double> weights_beyond_near(const EyeScatter& psf, const ImageAngles& image, int levels, dvec2 place) {
    const dvec2 texel = std::exp2(levels) * image.pixel() * dvec2(1, -1);
    std::vector<double> weights = far_weights(psf, image, levels, place, place - double(kFar) * texel, ivec2(2 * kFar + 1));
    for (int y = -kNear; y <= kNear; ++y)
        for (int x = -kNear; x <= kNear; ++x) weights[size_t((y + kFar) * (2 * kFar + 1) + x + kFar)] = 0;
    return weights;
}

// The fit at one place, tangents: the taps of all levels, then those of the top within kNear, opposite ones together.
std::vector<double> fit_node(const EyeScatter& psf, const ImageAngles& image, int levels, const Samples& samples, dvec2 place) {
    const std::vector<double> far = weights_beyond_near(psf, image, levels, place);
    const dvec2 half = 0.5 * image.pixel();
    std::vector<double> wanted;
    for (const ivec2 d : samples.offsets)
        wanted.push_back(d == ivec2(0) ? light_within(psf, place, half) : light_from(psf, place, place + 2.0 * half * dvec2(d.x, -d.y), half));

    Eigen::MatrixXd a = samples.responses;
    Eigen::VectorXd b(a.rows());
    for (Eigen::Index r = 0; r < a.rows(); ++r) {
        const Samples::Row& row = samples.rows[size_t(r)];
        double known = 0;
        for (size_t j = 0; j < row.top_y.size(); ++j)
            for (size_t i = 0; row.top_y[j] != 0 && i < row.top_x.size(); ++i) known += row.top_x[i] * row.top_y[j] * far[j * row.top_x.size() + i];
        a.row(r) /= wanted[row.offset];
        b[r] = 1 - known / wanted[row.offset];
    }
    // What is far, near and in the middle is all the light there is.
    Eigen::VectorXd balance = Eigen::VectorXd::Constant(a.cols(), 2);
    for (int l = 0; l <= levels; ++l) balance[first_scatter_tap(l)] = 1;  // in the middle
    double beyond = 1 - light_within(psf, place, (kFar + 0.5) * std::exp2(levels) * image.pixel());
    for (double w : far) beyond += w;

    Eigen::MatrixXd squares = a.transpose() * a + kBalance * kBalance * balance * balance.transpose();
    const Eigen::VectorXd right = a.transpose() * b + kBalance * kBalance * (1 - beyond) * balance;
    squares.diagonal() *= 1 + 1e-9;
    const Eigen::VectorXd x = squares.ldlt().solve(right);
    return {x.data(), x.data() + x.size()};
}

// Weights of a place whose picture is mirrored, on one axis: which tap becomes which.
std::vector<size_t> mirrored(const std::vector<ivec2>& taps) {
    std::vector<size_t> from;
    for (const ivec2 t : taps) {
        const auto same = [&](ivec2 other) { return other == ivec2(t.x, -t.y) || other == ivec2(-t.x, t.y); };
        from.push_back(size_t(std::find_if(taps.begin(), taps.end(), same) - taps.begin()));
    }
    return from;
}

struct Fits {
    std::vector<std::vector<double>> at;  // node by node: taps of all levels, then of the top
    std::vector<ivec2> top;               // taps of the top
};

// Taps of all levels and of the top of a place that is mirrored: which become which.
std::vector<size_t> mirrored_taps(int levels, const std::vector<ivec2>& top) {
    std::vector<size_t> all;
    const auto add = [&](int level, const std::vector<ivec2>& taps) {
        for (size_t i : mirrored(taps)) all.push_back(size_t(first_scatter_tap(level)) + i);
    };
    for (int l = 0; l < levels; ++l) add(l, {kScatterTaps.begin(), kScatterTaps.begin() + scatter_taps(l)});
    add(levels, top);
    return all;
}

// The fit at every node; where the picture is symmetric, those of one side are mirrored.
Fits fit_nodes(const EyeScatter& psf, const ImageAngles& image, int levels, ivec2 nodes) {
    const Samples samples(levels);
    const std::vector<size_t> mirror = mirrored_taps(levels, samples.top);
    const bool symmetric_x = image.low.x == -image.high.x, symmetric_y = image.low.y == -image.high.y;
    Fits fits{{}, samples.top};
    for (int y = 0; y < nodes.y; ++y)
        for (int x = 0; x < nodes.x; ++x) {
            const ivec2 twin(symmetric_x ? std::min(x, nodes.x - 1 - x) : x, symmetric_y ? std::min(y, nodes.y - 1 - y) : y);
            if (twin == ivec2(x, y)) {
                const dvec2 place = image.at(dvec2(image.width, image.height) * dvec2(x, y) / dvec2(nodes - 1));
                fits.at.push_back(fit_node(psf, image, levels, samples, place));
                continue;
            }
            const std::vector<double> of_twin = fits.at[size_t(twin.y * nodes.x + twin.x)];
            fits.at.push_back(of_twin);
            if ((twin.x != x) != (twin.y != y))
                for (size_t i = 0; i < mirror.size(); ++i) fits.at.back()[i] = of_twin[mirror[i]];
        }
    return fits;
}

// Between nodes: which ones, and how far beyond the first. `part` of the picture.
struct Between {
    int first;
    double part;
};
Between between(double part, int nodes) {
    const double at = std::clamp(part, 0.0, 1.0) * (nodes - 1);
    const int first = std::min(int(at), nodes - 2);
    return {first, at - first};
}

// The matrix of the top: fitted near its diagonal, exact beyond.
std::vector<float> top_matrix(const EyeScatter& psf, const ScatterFit& fit, const Fits& fits) {
    const ImageAngles& image = fit.image;
    const ivec2 rows = fit.top_rows(), columns = fit.top_columns();
    const double size = std::exp2(fit.levels);
    const auto middle = [&](ivec2 texel, int margin) { return size * (dvec2(texel - margin) + 0.5); };
    std::vector<float> matrix;
    matrix.reserve(size_t(rows.x * rows.y) * size_t(columns.x * columns.y));
    for (int y = 0; y < rows.y; ++y)
        for (int x = 0; x < rows.x; ++x) {
            const dvec2 to = middle({x, y}, kScatterReach);
            const Between bx = between(to.x / image.width, fit.nodes.x), by = between(to.y / image.height, fit.nodes.y);
            const std::vector<double> far = far_weights(psf, image, fit.levels, image.at(to), image.at(middle({0, 0}, kScatterMargin)), columns);
            for (int v = 0; v < columns.y; ++v)
                for (int u = 0; u < columns.x; ++u) {
                    ivec2 d = ivec2(u, v) - kScatterMargin - (ivec2(x, y) - kScatterReach);
                    if (std::max(std::abs(d.x), std::abs(d.y)) > kNear) {
                        matrix.push_back(float(far[size_t(v * columns.x + u)]));
                        continue;
                    }
                    if (d.y < 0 || (d.y == 0 && d.x < 0)) d = -d;
                    const size_t tap = size_t(fit.taps() + (std::find(fits.top.begin(), fits.top.end(), d) - fits.top.begin()));
                    const auto at = [&](int dx, int dy) { return fits.at[size_t((by.first + dy) * fit.nodes.x + bx.first + dx)][tap]; };
                    matrix.push_back(float(glm::mix(glm::mix(at(0, 0), at(1, 0), bx.part), glm::mix(at(0, 1), at(1, 1), bx.part), by.part)));
                }
        }
    return matrix;
}

}  // namespace

dvec2 ImageAngles::at(dvec2 p) const { return {low.x + p.x * pixel().x, high.y - p.y * pixel().y}; }
dvec2 ImageAngles::pixels_at(dvec2 t) const { return {(t.x - low.x) / pixel().x, (high.y - t.y) / pixel().y}; }

double steradians_per_area(dvec2 t) {
    const double square = 1 + glm::dot(t, t);
    return 1 / (square * std::sqrt(square));
}

double degrees_between(dvec2 a, dvec2 b) {
    const dvec2 d = b - a;
    const double cross = a.x * b.y - a.y * b.x;
    return std::atan2(std::sqrt(glm::dot(d, d) + cross * cross), 1 + glm::dot(a, b)) * 180 / std::numbers::pi;
}

double light_within(const EyeScatter& psf, dvec2 point, dvec2 half) {
    // Along great circles through the point, which are straight lines of the plane.
    constexpr int kCircles = 96;
    const dvec3 middle = ray(point);
    const dvec3 side = glm::normalize(glm::cross(std::abs(middle.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0), middle)), other = glm::cross(middle, side);
    double sum = 0;
    for (int i = 0; i < kCircles; ++i) {
        const double azimuth = 2 * std::numbers::pi * (i + 0.5) / kCircles;
        const dvec3 e = std::cos(azimuth) * side + std::sin(azimuth) * other;
        const dvec2 along(e.x * middle.z - middle.x * e.z, e.y * middle.z - middle.y * e.z);
        const double reach = std::min(half.x / std::max(std::abs(along.x), 1e-300), half.y / std::max(std::abs(along.y), 1e-300));
        sum += psf.within(degrees_between(point, point + reach * along));
    }
    return sum / kCircles;
}

double light_from(const EyeScatter& psf, dvec2 to, dvec2 from, dvec2 half) {
    // Gauss-Legendre: exact for polynomials of degree 5 within each part.
    constexpr std::array<double, 3> nodes{-0.7745966692414834, 0, 0.7745966692414834}, weights{5.0 / 18, 8.0 / 18, 5.0 / 18};
    const dvec2 away = glm::abs(to - from) / half;
    const double distance = std::max(away.x, away.y);  // 1 at the edge
    const auto seen = [&](dvec2 p) { return psf(degrees_between(to, p)) * steradians_per_area(p); };
    if (distance > 12) return seen(from) * 4 * half.x * half.y;
    const int parts = distance < 3 ? 6 : distance < 6 ? 2 : 1;
    double sum = 0;
    for (int y = 0; y < 3 * parts; ++y)
        for (int x = 0; x < 3 * parts; ++x) {
            const dvec2 within(nodes[size_t(x % 3)], nodes[size_t(y % 3)]);
            const dvec2 p = from + half * ((2.0 * dvec2(x / 3, y / 3) + 1.0 + within) / double(parts) - 1.0);
            sum += weights[size_t(x % 3)] * weights[size_t(y % 3)] * seen(p);
        }
    return sum * 4 * half.x * half.y / (parts * parts);
}

ivec2 scatter_size(const ImageAngles& image, int level) {
    ivec2 size(image.width, image.height);
    for (int i = 0; i < level; ++i) size = (size + 1) / 2;
    return size;
}

ScatterFit fit_scatter(const EyeScatter& psf, const ImageAngles& image) {
    ScatterFit fit{.image = image, .levels = 1, .nodes = {}, .kernels = {}, .top = {}};
    const auto texels = [&](int level) { const ivec2 n = scatter_size(image, level); return n.x * n.y; };
    while (texels(fit.levels) > kTopTexels) ++fit.levels;
    // Odd, so that a symmetric picture has a node in its middle and needs only a quarter of them.
    const dvec2 span = image.high - image.low;
    fit.nodes = 2 * ivec2(glm::ceil(span / (2 * kNodeStep))) + 1;
    const Fits fits = fit_nodes(psf, image, fit.levels, fit.nodes);
    for (const std::vector<double>& at : fits.at) fit.kernels.insert(fit.kernels.end(), at.begin(), at.begin() + fit.taps());
    fit.top = top_matrix(psf, fit, fits);
    return fit;
}

}  // namespace vesper
