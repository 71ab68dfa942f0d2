#include "passes/shown.h"

#include <algorithm>
#include <cmath>

#include "shared/photometry.h"

namespace vesper {

double shown_luminance(const shared::ToneCurve& curve, uint32_t form, double luminance, const Display& display) {
    const double low = display.low(), high = display.high();
    double relative = luminance;
    if (form == shared::kToneReinhard) {
        const double x = curve.reinhard_scale * luminance;
        relative = x * (1 + x * curve.reinhard_white) / (1 + x);
    } else if (form == shared::kToneLinear) {
        relative = (luminance - curve.linear_low) * curve.linear_gain;
    } else if (form == shared::kToneCurve) {
        const double ln = std::log(std::max(luminance, double(shared::kLuminanceFloor)));
        const double at = std::clamp((ln - curve.ln_low) * double(curve.bins_per_ln), 0.0, double(curve.bins));
        const size_t below = std::min(size_t(at), size_t(curve.bins) - 1);
        return std::exp(std::lerp(double(curve.node[below].x), double(curve.node[below + 1].x), at - double(below)));
    }
    return low + (high - low) * std::clamp(relative, 0.0, 1.0);
}

}  // namespace vesper
