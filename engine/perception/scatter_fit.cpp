#include "perception/scatter_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>

namespace vesper {
namespace {

using glm::dvec2, glm::dvec3, glm::ivec2;

constexpr int kTopTexels = 1100;   // at most so many texels of the top make the picture
constexpr double kNodeStep = 0.14;  // tangents between two nodes, at most,
constexpr int kMostNodes = 17;     // of a row or column: beyond 2.4 tangents across (100 degrees) steps grow, so that a fit takes seconds at most
constexpr int kPhases = 8;        // places of the eye's axis within a texel of the top
constexpr int kAzimuths = 12;
constexpr int kNear = 3;          // texels of the top whose weights are fitted
constexpr int kFar = 16;          // texels of the top beyond which light is counted, not added up
constexpr double kBalance = 1e4;  // of the light, against the rows of the fit
constexpr double kKept = 1e2;     // of what a pixel at the border leaves in the picture

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

// For levels 0 .. levels: of `pixels` from the one given on, what they give to each texel, and what they take of each, added up.
std::vector<Taps> cascade(int pixel, int pixels, int levels, double gain) {
    std::vector<Taps> all{{pixel, std::vector<double>(size_t(pixels), 1.0)}};
    for (int l = 0; l < levels; ++l) all.push_back(coarser(all.back(), gain));
    return all;
}
std::vector<Taps> given(int pixel, int levels) { return cascade(pixel, 1, levels, 1.0 / 32); }
std::vector<Taps> taken(int pixel, int pixels, int levels) { return cascade(pixel, pixels, levels, 1.0 / 16); }

// What pixels take of a pixel, on one axis, through each level, for a shift of -kFar .. kFar texels between them.
struct Responses {
    std::vector<std::array<double, 2 * kFar + 1>> levels;

    // `mirrored`: as if the picture were.
    Responses(const std::vector<Taps>& takes, const std::vector<Taps>& gives, bool mirrored = false) : levels(takes.size()) {
        for (size_t l = 0; l < levels.size(); ++l) {
            const int most = l + 1 < levels.size() ? 2 : kFar;  // taps of levels reach no further
            levels[l].fill(0);
            for (int t = -most; t <= most; ++t)
                for (size_t i = 0; i < gives[l].weights.size(); ++i)
                    levels[l][size_t((mirrored ? -t : t) + kFar)] += gives[l].weights[i] * takes[l].at(gives[l].first + int(i) - t);
        }
    }
    double at(size_t level, int shift) const { return levels[level][size_t(shift + kFar)]; }
};

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

// What every weight makes of a sample: a row of the fit.
struct Row {
    Responses x, y;

    // Of a tap of a level, with its opposite.
    double at(size_t level, ivec2 tap) const {
        return x.at(level, tap.x) * y.at(level, tap.y) + (tap == ivec2(0) ? 0 : x.at(level, -tap.x) * y.at(level, -tap.y));
    }
    // Of the weights of the top that are not fitted.
    double known(const std::vector<double>& far) const {
        const auto &along = x.levels.back(), &down = y.levels.back();
        double sum = 0;
        for (size_t j = 0; j < down.size(); ++j)
            for (size_t i = 0; down[j] != 0 && i < along.size(); ++i) sum += along[i] * down[j] * far[j * along.size() + i];
        return sum;
    }
};

// Taps of the top without opposite ones, and those of all levels and of the top, one after the other.
std::vector<ivec2> top_taps() {
    std::vector<ivec2> taps;
    for (int y = 0; y <= kNear; ++y)
        for (int x = y == 0 ? 0 : -kNear; x <= kNear; ++x) taps.push_back({x, y});
    return taps;
}
Eigen::RowVectorXd responses_of(const Row& row, const std::vector<ivec2>& top) {
    const size_t levels = row.x.levels.size() - 1;
    Eigen::RowVectorXd all(Eigen::Index(kTaps * levels + top.size()));
    for (size_t l = 0; l < levels; ++l)
        for (size_t i = 0; i < kTaps; ++i) all[Eigen::Index(kTaps * l + i)] = row.at(l, kScatterTaps[i]);
    for (size_t i = 0; i < top.size(); ++i) all[Eigen::Index(kTaps * levels + i)] = row.at(levels, top[i]);
    return all;
}

// Samples of the function, the same wherever the eye looks.
struct Samples {
    std::vector<ivec2> offsets;  // px from the eye's axis to the source
    std::vector<ivec2> top = top_taps();
    std::vector<Row> rows;       // for each phase all offsets
    Eigen::MatrixXd responses;

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
    responses.resize(Eigen::Index(kPhases * offsets.size()), Eigen::Index(kTaps * size_t(levels) + top.size()));
    for (int phase = 0; phase < kPhases; ++phase) {
        // The R2 sequence (Roberts 2018) fills the texel of the top evenly.
        const double size = std::exp2(levels);
        const ivec2 q(int(size * std::fmod(0.5 + 0.7548776662 * phase, 1)), int(size * std::fmod(0.5 + 0.5698402910 * phase, 1)));
        const std::vector<Taps> takes_x = taken(q.x, 1, levels), takes_y = taken(q.y, 1, levels);
        for (const ivec2 offset : offsets) {
            rows.push_back({{takes_x, given(q.x + offset.x, levels)}, {takes_y, given(q.y + offset.y, levels)}});
            responses.row(Eigen::Index(rows.size()) - 1) = responses_of(rows.back(), top);
        }
    }
}

// Light that pixels near the border leave in the picture. Half of what they scatter goes beside it, so that errors on either
// side do not make up for each other.
struct Kept {
    Row row;
    dvec2 low, high;  // of the picture, px from the pixel to the right and down, seen from the pixel's opposite side
};

// Pixels about a node on the border, near and further from it. In a symmetric picture the node stands for others as well.
std::vector<Kept> kept_near(const ImageAngles& image, int levels, ivec2 nodes, ivec2 node) {
    const ivec2 size(image.width, image.height);
    const std::vector<Taps> all[2]{taken(0, size.x, levels), taken(0, size.y, levels)};
    struct Pixel {
        Responses responses;
        double low, high;
    };
    const auto pixels = [&](int axis, bool mirrored) {
        const int at = mirrored ? nodes[axis] - 1 - node[axis] : node[axis], last = size[axis] - 1;
        std::vector<int> places;
        const bool first_edge = at == 0, last_edge = at == nodes[axis] - 1;
        if (!first_edge && !last_edge) places.push_back(last * at / (nodes[axis] - 1));
        for (int away : {0, 1, 2, 4, 8, 16, 32})
            if ((first_edge || last_edge) && away <= last) places.push_back(first_edge ? away : last - away);
        std::vector<Pixel> found;
        for (int p : places) {
            const double low = p - last - 0.5, high = p + 0.5;
            found.push_back({Responses(all[axis], given(p, levels), mirrored), mirrored ? -high : low, mirrored ? -low : high});
        }
        return found;
    };
    std::vector<Kept> kept;
    for (int mirror = 0; mirror < 4; ++mirror) {
        const bool mirror_x = mirror & 1, mirror_y = mirror & 2;
        if ((mirror_x && !image.symmetric_x()) || (mirror_y && !image.symmetric_y())) continue;
        const bool inside = node.x > 0 && node.x < nodes.x - 1 && node.y > 0 && node.y < nodes.y - 1;
        if (inside) continue;
        for (const Pixel& x : pixels(0, mirror_x))
            for (const Pixel& y : pixels(1, mirror_y)) kept.push_back({{x.responses, y.responses}, {x.low, y.low}, {x.high, y.high}});
    }
    return kept;
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
std::vector<double> fit_node(const EyeScatter& psf, const ImageAngles& image, int levels, const Samples& samples, const std::vector<Kept>& kept, dvec2 place) {
    const std::vector<double> far = weights_beyond_near(psf, image, levels, place);
    const dvec2 pixel = image.pixel(), half = 0.5 * pixel, most = (kFar + 0.5) * std::exp2(levels) * pixel;
    std::vector<double> wanted;
    for (const ivec2 d : samples.offsets)
        wanted.push_back(d == ivec2(0) ? light_within(psf, place, -half, half) : light_from(psf, place, place + pixel * dvec2(d.x, -d.y), half));

    const Eigen::Index all = samples.responses.rows();
    Eigen::MatrixXd a(all + Eigen::Index(kept.size()), samples.responses.cols());
    Eigen::VectorXd b(a.rows());
    for (Eigen::Index r = 0; r < all; ++r) {
        const double want = wanted[size_t(r) % wanted.size()];
        a.row(r) = samples.responses.row(r) / want;
        b[r] = 1 - samples.rows[size_t(r)].known(far) / want;
    }
    for (size_t i = 0; i < kept.size(); ++i) {
        const Kept& k = kept[i];
        const dvec2 low(pixel.x * k.low.x, -pixel.y * k.high.y), high(pixel.x * k.high.x, -pixel.y * k.low.y);
        const double want = light_within(psf, place, glm::max(low, -most), glm::min(high, most));
        a.row(all + Eigen::Index(i)) = kKept / want * responses_of(k.row, samples.top);
        b[all + Eigen::Index(i)] = kKept * (1 - k.row.known(far) / want);
    }
    // What is far, near and in the middle is all the light there is.
    Eigen::VectorXd balance = Eigen::VectorXd::Constant(a.cols(), 2);
    for (int l = 0; l <= levels; ++l) balance[kTaps * l] = 1;  // in the middle
    double beyond = 1 - light_within(psf, place, -most, most);
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
        for (size_t i : mirrored(taps)) all.push_back(size_t(kTaps * level) + i);
    };
    for (int l = 0; l < levels; ++l) add(l, {kScatterTaps.begin(), kScatterTaps.end()});
    add(levels, top);
    return all;
}

// The fit at every node; where the picture is symmetric, those of one side are mirrored.
Fits fit_nodes(const EyeScatter& psf, const ImageAngles& image, int levels, ivec2 nodes) {
    const Samples samples(levels);
    const std::vector<size_t> mirror = mirrored_taps(levels, samples.top);
    Fits fits{{}, samples.top};
    for (int y = 0; y < nodes.y; ++y)
        for (int x = 0; x < nodes.x; ++x) {
            const ivec2 twin(image.symmetric_x() ? std::min(x, nodes.x - 1 - x) : x, image.symmetric_y() ? std::min(y, nodes.y - 1 - y) : y);
            if (twin == ivec2(x, y)) {
                const dvec2 place = image.at(dvec2(image.width, image.height) * dvec2(x, y) / dvec2(nodes - 1));
                fits.at.push_back(fit_node(psf, image, levels, samples, kept_near(image, levels, nodes, twin), place));
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
                    const size_t tap = size_t(kTaps * fit.levels + (std::find(fits.top.begin(), fits.top.end(), d) - fits.top.begin()));
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

double light_within(const EyeScatter& psf, dvec2 point, dvec2 low, dvec2 high) {
    // Along great circles through the point, which are straight lines of the plane.
    constexpr int kCircles = 192;
    const dvec3 middle = ray(point);
    const dvec3 side = glm::normalize(glm::cross(std::abs(middle.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0), middle)), other = glm::cross(middle, side);
    double sum = 0;
    for (int i = 0; i < kCircles; ++i) {
        const double azimuth = 2 * std::numbers::pi * (i + 0.5) / kCircles;
        const dvec3 e = std::cos(azimuth) * side + std::sin(azimuth) * other;
        const dvec2 along(e.x * middle.z - middle.x * e.z, e.y * middle.z - middle.y * e.z);
        const dvec2 side_met = glm::max(dvec2(along.x < 0 ? -low.x : high.x, along.y < 0 ? -low.y : high.y), 0.0) / glm::max(glm::abs(along), 1e-300);
        const double reach = std::min(side_met.x, side_met.y);
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

int scatter_strip(const ImageAngles& image, ivec2 nodes, int level, int most) {
    const int rows = scatter_size(image, level).y / (nodes.y - 1);
    return std::clamp(rows / 2 * 2, 2, most);
}

ScatterFit fit_scatter(const EyeScatter& psf, const ImageAngles& image) {
    ScatterFit fit{.image = image, .levels = 1, .nodes = {}, .kernels = {}, .top = {}};
    const auto texels = [&](int level) { const ivec2 n = scatter_size(image, level); return n.x * n.y; };
    while (texels(fit.levels) > kTopTexels) ++fit.levels;
    // Odd, so that a symmetric picture has a node in its middle and needs only a quarter of them.
    const dvec2 span = image.high - image.low;
    fit.nodes = ivec2(glm::min(2.0 * glm::ceil(span / (2 * kNodeStep)) + 1.0, dvec2(kMostNodes)));
    const Fits fits = fit_nodes(psf, image, fit.levels, fit.nodes);
    for (const std::vector<double>& at : fits.at) fit.kernels.insert(fit.kernels.end(), at.begin(), at.begin() + kTaps * fit.levels);
    fit.top = top_matrix(psf, fit, fits);
    return fit;
}

}  // namespace vesper
