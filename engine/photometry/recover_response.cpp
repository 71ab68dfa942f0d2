// The response out of exposures. P. Debevec and J. Malik, "Recovering High Dynamic Range Radiance Maps from
// Photographs", SIGGRAPH 97, section 2. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "base/error.h"
#include "photometry/response.h"

namespace vesper::photometry {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// A pixel of one channel in those exposures that neither clip nor miss it.
struct Sample {
    std::vector<std::pair<uint8_t, double>> seen;  // code, ln of exposure
};

/// Chooses the pixels of one channel: along a sequence that fills the picture evenly (R2 of M. Roberts, 2018), those
/// that show a code not yet seen often enough. Where the codes of neighbours jump, a pixel says more about sharpness
/// and alignment than about the response: such places are only used if there is little else.
class Sampler {
public:
    Sampler(std::span<const Exposure> exposures, size_t channel) : exposures_(exposures), channel_(channel) {
        visit(kSmooth);
        if (samples.size() < 1000) visit(256);
    }
    std::vector<Sample> samples;

private:
    static constexpr int kSmooth = 10, kPerCode = 400;
    static constexpr uint64_t kTries = 200000;

    void visit(int largest_jump) {
        const Image& first = exposures_.front().image;
        const uint64_t tries = std::min(kTries, uint64_t{first.width} * first.height);
        for (uint32_t i = 1; i <= tries; ++i) {
            const double u = 0.5 + i * 0.7548776662466927, v = 0.5 + i * 0.5698402909980532;
            consider(static_cast<int64_t>((u - std::floor(u)) * first.width),
                     static_cast<int64_t>((v - std::floor(v)) * first.height), largest_jump);
        }
    }

    void consider(int64_t x, int64_t y, int largest_jump) {
        Sample sample;
        bool wanted = false;
        for (const Exposure& exposure : exposures_) {
            const int64_t at_x = x + exposure.shift.x, at_y = y + exposure.shift.y;
            const int code = code_at(exposure.image, at_x, at_y);
            if (code < 1 || code > 254) continue;
            for (const auto& [dx, dy] : {std::pair(-1, 0), std::pair(1, 0), std::pair(0, -1), std::pair(0, 1)}) {
                const int beside = code_at(exposure.image, at_x + dx, at_y + dy);
                if (beside >= 0 && std::abs(beside - code) > largest_jump) return;
            }
            sample.seen.emplace_back(static_cast<uint8_t>(code), std::log(exposure.exposure));
            wanted |= seen_[static_cast<size_t>(code)] < kPerCode;
        }
        if (!wanted || sample.seen.size() < 2) return;
        for (const auto& [code, ignored] : sample.seen) ++seen_[code];
        samples.push_back(std::move(sample));
    }

    int code_at(const Image& image, int64_t x, int64_t y) const {
        if (x < 0 || y < 0 || x >= image.width || y >= image.height) return -1;
        return image.rgba[static_cast<size_t>((y * image.width + x) * 4) + channel_];
    }

    std::span<const Exposure> exposures_;
    size_t channel_;
    std::array<int, 256> seen_{};
};

/// Normal equations of eq. 3. Each irradiance appears in the rows of its own pixel only: for given g it is a weighted
/// mean, so it is eliminated pixel by pixel and 256 unknowns remain, however many pixels there are.
struct Equations {
    Matrix a = Matrix::Zero(256, 256);
    Vector b = Vector::Zero(256);
    double weight = 0;

    void add(const Sample& sample) {
        double sum = 0, mean = 0;
        for (const auto& [code, ln_exposure] : sample.seen) {
            const double w = squared(code);
            sum += w;
            mean += w * ln_exposure;
        }
        mean /= sum;
        for (const auto& [code, ln_exposure] : sample.seen) {
            const double w = squared(code);
            a(code, code) += w;
            b(code) += w * (ln_exposure - mean);
            for (const auto& [other, ignored] : sample.seen) a(code, other) -= w * squared(other) / sum;
        }
        weight += sum;
    }

    /// Penalizes curvature, in relation to the mean weight of data per code, but not that of three shapes that cameras'
    /// responses are near, nor of any sum of them. Exposures in equal steps leave open what repeats itself from step to
    /// step; only this decides that.
    void smooth(double lambda) {
        Matrix curvature = Matrix::Zero(254, 256), shapes(256, 3);
        const double scale = lambda * std::sqrt(weight / 256);
        for (int z = 1; z < 255; ++z)
            for (int i = -1; i <= 1; ++i) curvature(z - 1, z + i) = scale * code_weight(z) * (i == 0 ? -2 : 1);
        for (int z = 0; z < 256; ++z) {
            const double v = (z + 0.5) / 256;
            shapes.row(z) << std::log(v), std::log(v + 0.055),
                std::log(1.1 - v);  // a power; the toe of sRGB; a shoulder
        }
        const Eigen::HouseholderQR<Matrix> factors(curvature * shapes);
        const Matrix free = (factors.householderQ() * Matrix::Identity(254, 3)).transpose() * curvature;
        a += curvature.transpose() * curvature - free.transpose() * free;
    }

    /// Solves with g(128) = 0.
    Vector solve() {
        a.row(128).setZero();
        a.col(128).setZero();
        a(128, 128) = 1;
        b(128) = 0;
        const Eigen::LDLT<Matrix> factors(a);
        Vector g = factors.solve(b);
        if (factors.info() != Eigen::Success || !g.allFinite()) throw Error("the pictures do not determine a response");
        return g;
    }

    static double squared(int code) { return code_weight(code) * code_weight(code); }
};

/// Weighted rms of what the solution leaves.
double residual(const std::vector<Sample>& samples, const std::array<double, 256>& g) {
    double squares = 0, weight = 0;
    for (const Sample& sample : samples) {
        double sum = 0, mean = 0;
        for (const auto& [code, ln_exposure] : sample.seen) {
            sum += Equations::squared(code);
            mean += Equations::squared(code) * (g[code] - ln_exposure);
        }
        mean /= sum;
        for (const auto& [code, ln_exposure] : sample.seen)
            squares += Equations::squared(code) * std::pow(g[code] - ln_exposure - mean, 2);
        weight += sum;
    }
    return std::sqrt(squares / weight);
}

}  // namespace

RecoveredResponse recover_response(std::span<const Exposure> exposures, double smoothness) {
    if (exposures.size() < 2) throw Error("a response needs at least two pictures");
    const auto [least, most] =
        std::minmax_element(exposures.begin(), exposures.end(),
                            [](const Exposure& a, const Exposure& b) { return a.exposure < b.exposure; });
    if (most->exposure < least->exposure * 1.05) throw Error("a response needs pictures of different exposure");
    RecoveredResponse made;
    for (size_t c = 0; c < 3; ++c) {
        const Sampler sampler(exposures, c);
        if (sampler.samples.size() < 50)
            throw Error("only " + std::to_string(sampler.samples.size()) +
                        " pixels are neither black nor white in two pictures: the exposures are too far apart");
        Equations equations;
        for (const Sample& sample : sampler.samples) equations.add(sample);
        equations.smooth(smoothness);
        const Vector g = equations.solve();
        std::copy(g.begin(), g.end(), made.response.ln_exposure[c].begin());
        made.error[c] = residual(sampler.samples, made.response.ln_exposure[c]);
        made.pixels[c] = sampler.samples.size();
    }
    made.falls = count_falls(made.response);
    return made;
}

}  // namespace vesper::photometry
