#include "vision/scatter_fit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "base/angle.h"
#include "base/parallel.h"
#include "vision/scatter_balance.h"
#include "vision/scatter_cascade.h"

namespace vesper::vision {
namespace {

using glm::bvec2, glm::dvec2, glm::dvec3, glm::ivec2;

constexpr int kTopTexels = 1100;  // at most so many texels of the top make the picture
constexpr double kTopWeights =
    8e6;  // and so many weights its matrix: of pictures of more than 20 : 1 most would be of margins
constexpr double kNodeStep = 0.14;  // tangents between two nodes, at most,
constexpr int kMostNodes =
    17;  // of a row or column: beyond 2.4 tangents across (100 degrees) steps grow, so that a fit takes seconds at most
constexpr int kPhases = 8;  // places of the eye's axis within a texel of the top
constexpr int kAzimuths = 12;
constexpr double kNarrow =
    36 * kRadiansPerDegree;  // from the axis to a corner: kernels of 5 x 5 follow pixels of that shape
constexpr int kNearTaps = kScatterNear;
constexpr int kFarTaps = 16;  // texels of the top beyond which light is counted, not added up
// Texels outside the picture that light may be to go wholly into the margin of a level. One level lower it has then no
// say in the picture.
constexpr double kOutside = 6;
constexpr double kBalance = 1e4;  // of the light, against the rows of the fit

// What a pixel takes of another, on one axis, through each level, for a shift of -kFarTaps .. kFarTaps texels between
// them.
struct CascadeResponses {
    std::vector<std::array<double, 2 * kFarTaps + 1>> levels;

    CascadeResponses(const std::vector<CascadeTaps>& takes, const std::vector<CascadeTaps>& gives)
        : levels(takes.size()) {
        for (size_t l = 0; l < levels.size(); ++l) {
            const int most = l + 1 < levels.size() ? kWideTapReach : kFarTaps;  // taps of levels reach no further
            levels[l].fill(0);
            for (int t = -most; t <= most; ++t)
                for (size_t i = 0; i < gives[l].weights.size(); ++i)
                    levels[l][size_t(t + kFarTaps)] += gives[l].weights[i] * takes[l].at(gives[l].first + int(i) - t);
        }
    }
    double at(size_t level, int shift) const { return levels[level][size_t(shift + kFarTaps)]; }
};

dvec3 ray(dvec2 tangents) { return glm::normalize(dvec3(tangents, 1)); }

// Weights of texels of the top for one place, from the one whose middle lies at `first` onwards, right and down.
// Sharpened by what the filters on the way there and back blur (variance: 2 * 5/12 texels^2): G - variance/2 *
// Laplacian.
std::vector<double> far_weights(const EyeScatter& psf, const ImageAngles& image, int levels, dvec2 to, dvec2 first,
                                ivec2 count) {
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

// What every weight makes of a sample: a row of the fit.
struct Row {
    CascadeResponses x, y;

    double at(size_t level, ivec2 tap) const { return x.at(level, tap.x) * y.at(level, tap.y); }
    // Of a tap of a level, with its opposite.
    double both(size_t level, ivec2 tap) const { return at(level, tap) + (tap == ivec2(0) ? 0 : at(level, -tap)); }
    // Of the weights of the top that are not fitted.
    double known(const std::vector<double>& far) const {
        const auto &along = x.levels.back(), &down = y.levels.back();
        double sum = 0;
        for (size_t j = 0; j < down.size(); ++j)
            for (size_t i = 0; down[j] != 0 && i < along.size(); ++i)
                sum += along[i] * down[j] * far[j * along.size() + i];
        return sum;
    }
};

// Texels of the top whose weights are fitted, row by row; and the taps of all levels and of the top, one after the
// other.
std::vector<ivec2> top_taps() {
    std::vector<ivec2> taps;
    for (int y = -kNearTaps; y <= kNearTaps; ++y)
        for (int x = -kNearTaps; x <= kNearTaps; ++x) taps.push_back({x, y});
    return taps;
}
size_t top_tap(ivec2 tap) { return size_t((tap.y + kNearTaps) * (2 * kNearTaps + 1) + tap.x + kNearTaps); }
Eigen::RowVectorXd responses_of(const Row& row, const std::vector<ivec2>& level, const std::vector<ivec2>& top) {
    const size_t levels = row.x.levels.size() - 1, taps = level.size();
    Eigen::RowVectorXd all(Eigen::Index(taps * levels + top.size()));
    for (size_t l = 0; l < levels; ++l)
        for (size_t i = 0; i < taps; ++i) all[Eigen::Index(taps * l + i)] = row.both(l, level[i]);
    for (size_t i = 0; i < top.size(); ++i) all[Eigen::Index(taps * levels + i)] = row.at(levels, top[i]);
    return all;
}

// Samples of the function, the same wherever the eye looks.
struct Samples {
    std::vector<ivec2> offsets;                  // px from the eye's axis to the source
    std::vector<ivec2> level, top = top_taps();  // taps of each level, and of the top
    std::vector<Row> rows;                       // for each phase all offsets
    Eigen::MatrixXd responses;

    Samples(int levels, int reach);
};

// Pixels about the eye's axis, those near it all, then along rings of growing radius.
std::vector<ivec2> sample_offsets(int levels) {
    std::vector<ivec2> all;
    for (int y = -3; y <= 3; ++y)
        for (int x = -3; x <= 3; ++x) all.push_back({x, y});
    const double last = (kNearTaps + 2) * std::exp2(levels);
    for (double r = 4.2, turn = 0; r < last; r *= 1.17, turn += 0.618)
        for (int i = 0; i < kAzimuths; ++i) {
            const double azimuth = kTwoPi * (i + turn) / kAzimuths;
            all.push_back(ivec2(glm::round(r * dvec2(std::cos(azimuth), std::sin(azimuth)))));
        }
    return all;
}

Samples::Samples(int levels, int reach) : offsets(sample_offsets(levels)), level(scatter_taps(reach)) {
    responses.resize(Eigen::Index(kPhases * offsets.size()), Eigen::Index(level.size() * size_t(levels) + top.size()));
    for (int phase = 0; phase < kPhases; ++phase) {
        // The R2 sequence (Roberts 2018) fills the texel of the top evenly.
        const double size = std::exp2(levels);
        const ivec2 q(int(size * std::fmod(0.5 + 0.7548776662 * phase, 1)),
                      int(size * std::fmod(0.5 + 0.5698402910 * phase, 1)));
        const std::vector<CascadeTaps> takes_x = taken(q.x, levels), takes_y = taken(q.y, levels);
        for (const ivec2 offset : offsets) {
            rows.push_back({{takes_x, given(q.x + offset.x, levels)}, {takes_y, given(q.y + offset.y, levels)}});
            responses.row(Eigen::Index(rows.size()) - 1) = responses_of(rows.back(), level, top);
        }
    }
}

// Weights of the texels of the top about the one that a place lies in the middle of; none for those that are fitted.
std::vector<double> weights_beyond_near(const EyeScatter& psf, const ImageAngles& image, int levels, dvec2 place) {
    const dvec2 texel = std::exp2(levels) * image.pixel() * dvec2(1, -1);
    std::vector<double> weights =
        far_weights(psf, image, levels, place, place - double(kFarTaps) * texel, ivec2(2 * kFarTaps + 1));
    for (int y = -kNearTaps; y <= kNearTaps; ++y)
        for (int x = -kNearTaps; x <= kNearTaps; ++x)
            weights[size_t((y + kFarTaps) * (2 * kFarTaps + 1) + x + kFarTaps)] = 0;
    return weights;
}

// The fit at one place, tangents: the taps of all levels, opposite ones together, then those of the top within
// kNearTaps.
std::vector<double> fit_node(const EyeScatter& psf, const ImageAngles& image, int levels, const Samples& samples,
                             dvec2 place) {
    const std::vector<double> far = weights_beyond_near(psf, image, levels, place);
    const dvec2 pixel = image.pixel(), half = 0.5 * pixel, most = (kFarTaps + 0.5) * std::exp2(levels) * pixel;
    std::vector<double> wanted;
    for (const ivec2 d : samples.offsets)
        wanted.push_back(d == ivec2(0) ? light_within(psf, place, -half, half)
                                       : light_from(psf, place, place + pixel * dvec2(d.x, -d.y), half));

    Eigen::MatrixXd a(samples.responses.rows(), samples.responses.cols());
    Eigen::VectorXd b(a.rows());
    for (Eigen::Index r = 0; r < a.rows(); ++r) {
        const double want = wanted[size_t(r) % wanted.size()];
        a.row(r) = samples.responses.row(r) / want;
        b[r] = 1 - samples.rows[size_t(r)].known(far) / want;
    }
    // What is far, near and in the middle is all the light there is.
    Eigen::VectorXd balance = Eigen::VectorXd::Ones(a.cols());
    const auto taps = Eigen::Index(samples.level.size());
    for (int l = 0; l < levels; ++l) balance.segment(taps * l + 1, taps - 1).setConstant(2);
    double beyond = 1 - light_within(psf, place, -most, most);
    for (double w : far) beyond += w;

    Eigen::MatrixXd squares = a.transpose() * a + kBalance * kBalance * balance * balance.transpose();
    const Eigen::VectorXd right = a.transpose() * b + kBalance * kBalance * (1 - beyond) * balance;
    squares.diagonal() *= 1 + 1e-9;
    const Eigen::VectorXd x = squares.ldlt().solve(right);
    return {x.data(), x.data() + x.size()};
}

// Node by node: taps of all levels, then of the top.
using Fits = std::vector<std::vector<double>>;

// Taps of all levels and of the top of a place that is mirrored: which become which.
std::vector<size_t> mirrored_taps(int levels, const Samples& samples, bvec2 mirror) {
    const ivec2 signs = glm::mix(ivec2(1), ivec2(-1), mirror);
    std::vector<size_t> all;
    for (int l = 0; l < levels; ++l)
        for (const ivec2 t : samples.level) {
            const auto same = [&](ivec2 other) { return other == signs * t || other == -signs * t; };
            all.push_back(
                samples.level.size() * size_t(l) +
                size_t(std::find_if(samples.level.begin(), samples.level.end(), same) - samples.level.begin()));
        }
    for (const ivec2 t : samples.top) all.push_back(samples.level.size() * size_t(levels) + top_tap(signs * t));
    return all;
}

// The fit at every node; where the picture is symmetric, those of one side are mirrored.
Fits fit_nodes(const EyeScatter& psf, const ImageAngles& image, int levels, int reach, ivec2 nodes) {
    const Samples samples(levels, reach);
    const auto twin_of = [&](ivec2 node) {
        return ivec2(image.symmetric_x() ? std::min(node.x, nodes.x - 1 - node.x) : node.x,
                     image.symmetric_y() ? std::min(node.y, nodes.y - 1 - node.y) : node.y);
    };
    std::vector<ivec2> fitted, others;
    for (int y = 0; y < nodes.y; ++y)
        for (int x = 0; x < nodes.x; ++x) (twin_of({x, y}) == ivec2(x, y) ? fitted : others).push_back({x, y});
    Fits fits(size_t(nodes.x) * size_t(nodes.y));
    const auto fit_at = [&](ivec2 node) -> std::vector<double>& { return fits[size_t(node.y * nodes.x + node.x)]; };
    in_parallel(fitted.size(), 1, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i)
            fit_at(fitted[i]) =
                fit_node(psf, image, levels, samples,
                         image.at(dvec2(image.width, image.height) * dvec2(fitted[i]) / dvec2(nodes - 1)));
    });
    for (const ivec2 node : others) {
        const ivec2 twin = twin_of(node);
        for (size_t i : mirrored_taps(levels, samples, {twin.x != node.x, twin.y != node.y}))
            fit_at(node).push_back(fit_at(twin)[i]);
    }
    return fits;
}

// The matrix of the top: fitted near its diagonal, exact beyond.
std::vector<float> top_matrix(const EyeScatter& psf, const ScatterFit& fit, const Fits& fits) {
    const ImageAngles& image = fit.image;
    const ivec2 rows = fit.top_rows(), columns = fit.top_columns();
    const double size = std::exp2(fit.levels);
    const auto middle = [&](ivec2 texel, int margin) { return size * (dvec2(texel - margin) + 0.5); };
    const size_t row_size = size_t(columns.x * columns.y);
    std::vector<float> matrix(size_t(rows.x * rows.y) * row_size);
    in_parallel(size_t(rows.x * rows.y), size_t(rows.x), [&](size_t begin, size_t end) {
        for (size_t row = begin; row < end; ++row) {
            const int x = int(row) % rows.x, y = int(row) / rows.x;
            float* weight = &matrix[row * row_size];
            const dvec2 to = middle({x, y}, kScatterReach);
            const BetweenNodes bx = between_nodes(to.x / image.width, fit.nodes.x),
                               by = between_nodes(to.y / image.height, fit.nodes.y);
            const std::vector<double> far =
                far_weights(psf, image, fit.levels, image.at(to), image.at(middle({0, 0}, kScatterMargin)), columns);
            for (int v = 0; v < columns.y; ++v)
                for (int u = 0; u < columns.x; ++u) {
                    const ivec2 d = ivec2(u, v) - kScatterMargin - (ivec2(x, y) - kScatterReach);
                    if (std::max(std::abs(d.x), std::abs(d.y)) > kNearTaps) {
                        *weight++ = float(far[size_t(v * columns.x + u)]);
                        continue;
                    }
                    const size_t tap = size_t(fit.taps() * fit.levels) + top_tap(d);
                    const auto at = [&](int dx, int dy) {
                        return fits[size_t((by.first + dy) * fit.nodes.x + bx.first + dx)][tap];
                    };
                    *weight++ = float(glm::mix(glm::mix(at(0, 0), at(1, 0), bx.part),
                                               glm::mix(at(0, 1), at(1, 1), bx.part), by.part));
                }
        }
    });
    return matrix;
}

}  // namespace

BetweenNodes between_nodes(double part, int nodes) {
    const double at = std::clamp(part, 0.0, 1.0) * (nodes - 1);
    const int first = std::min(int(at), nodes - 2);
    return {first, at - first};
}

double steradians_per_area(dvec2 t) {
    const double square = 1 + glm::dot(t, t);
    return 1 / (square * std::sqrt(square));
}

double degrees_between(dvec2 a, dvec2 b) {
    const dvec2 d = b - a;
    const double cross = a.x * b.y - a.y * b.x;
    return std::atan2(std::sqrt(glm::dot(d, d) + cross * cross), 1 + glm::dot(a, b)) * 180 / kPi;
}

double light_within(const EyeScatter& psf, dvec2 point, dvec2 low, dvec2 high) {
    // Along great circles through the point, which are straight lines of the plane.
    constexpr int kCircles = 192;
    const dvec3 middle = ray(point);
    const dvec3 side = glm::normalize(glm::cross(std::abs(middle.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0), middle)),
                other = glm::cross(middle, side);
    double sum = 0;
    for (int i = 0; i < kCircles; ++i) {
        const double azimuth = kTwoPi * (i + 0.5) / kCircles;
        const dvec3 e = std::cos(azimuth) * side + std::sin(azimuth) * other;
        const dvec2 along(e.x * middle.z - middle.x * e.z, e.y * middle.z - middle.y * e.z);
        const dvec2 side_met = glm::max(dvec2(along.x < 0 ? -low.x : high.x, along.y < 0 ? -low.y : high.y), 0.0) /
                               glm::max(glm::abs(along), 1e-300);
        const double reach = std::min(side_met.x, side_met.y);
        sum += psf.within(degrees_between(point, point + reach * along));
    }
    return sum / kCircles;
}

double light_from(const EyeScatter& psf, dvec2 to, dvec2 from, dvec2 half) {
    // Gauss-Legendre: exact for polynomials of degree 5 within each part.
    constexpr std::array<double, 3> nodes{-0.7745966692414834, 0, 0.7745966692414834},
        weights{5.0 / 18, 8.0 / 18, 5.0 / 18};
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

int scatter_levels(const ImageAngles& image) {
    const auto fits = [&](int top) {
        const ivec2 n = scatter_size(image, top);
        const dvec2 rows = n + 2 * kScatterReach, columns = n + 2 * kScatterMargin;
        return n.x * n.y <= kTopTexels && rows.x * rows.y * columns.x * columns.y <= kTopWeights;
    };
    int levels = 1;
    while (!fits(levels)) ++levels;
    return levels;
}

std::optional<ScatterEntry> scatter_entry(const ImageAngles& image, dvec3 direction, int finest) {
    if (!(direction.z < 0)) return {};
    const dvec2 tangents = dvec2(direction) / -direction.z, pixels = image.pixels_at(tangents);
    const dvec2 beyond = glm::max(-pixels, pixels - dvec2(image.width, image.height));
    for (int level = finest, levels = scatter_levels(image); level <= levels; ++level)
        if (std::max(beyond.x, beyond.y) <= kOutside * std::exp2(level)) return ScatterEntry{level, pixels, tangents};
    return {};
}

std::vector<ivec2> scatter_taps(int reach) {
    std::vector<ivec2> taps;
    for (int y = 0; y <= reach; ++y)
        for (int x = y == 0 ? 0 : -reach; x <= reach; ++x) taps.push_back({x, y});
    return taps;
}

int scatter_strip(const ImageAngles& image, ivec2 nodes, int level, int most) {
    const int rows = scatter_size(image, level).y / (nodes.y - 1);
    return std::clamp(rows / 2 * 2, 2, most);
}

ScatterFit fit_scatter(const EyeScatter& psf, const ImageAngles& image, ivec2 strip) {
    ScatterFit fit{.image = image,
                   .levels = scatter_levels(image),
                   .reach = kTapReach,
                   .strip = strip,
                   .nodes = {},
                   .kernels = {},
                   .top = {},
                   .edge = {}};
    // Odd, so that a symmetric picture has a node in its middle and needs only a quarter of them.
    const dvec2 span = image.high - image.low;
    fit.nodes = ivec2(glm::min(2.0 * glm::ceil(span / (2 * kNodeStep)) + 1.0, dvec2(kMostNodes)));
    const dvec2 corner = glm::max(glm::abs(image.low), glm::abs(image.high));
    fit.reach = std::atan(glm::length(corner)) < kNarrow ? kTapReach : kWideTapReach;
    const Fits fits = fit_nodes(psf, image, fit.levels, fit.reach, fit.nodes);
    for (const std::vector<double>& at : fits)
        fit.kernels.insert(fit.kernels.end(), at.begin(), at.begin() + fit.taps() * fit.levels);
    fit.top = top_matrix(psf, fit, fits);
    conserve_light(psf, fit);
    return fit;
}

}  // namespace vesper::vision
