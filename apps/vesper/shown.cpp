#include "shown.h"

#include <algorithm>
#include <cmath>

#include "shared/photometry.h"

namespace vesper {

using shared::kRed, shared::kGreen, shared::kBlue;

double shown_luminance(const shared::ToneCurve& curve, uint32_t form, double luminance, const Display& display) {
    const double low = display.low(), high = display.high();
    double relative = luminance;
    form &= shared::kToneForm;
    if (form == shared::kToneReinhard) {
        const double x = curve.reinhard_scale * luminance;
        relative = x * (1 + x * curve.reinhard_white) / (1 + x);
    } else if (form == shared::kToneLinear || form == shared::kToneRods) {
        const double grey = form == shared::kToneRods ? luminance * (1 + double(kRed * curve.rods.x + kGreen * curve.rods.y + kBlue * curve.rods.z)) : luminance;
        relative = (grey - curve.linear_low) * curve.linear_gain;
    } else if (form == shared::kToneCurve || form == shared::kToneColour) {
        const double ln = std::log(std::max(luminance, double(shared::kLuminanceFloor)));
        const double at = std::clamp((ln - curve.ln_low) * double(curve.bins_per_ln), 0.0, double(curve.bins));
        const size_t below = std::min(size_t(at), size_t(curve.bins) - 1);
        return std::min(high, std::exp(std::lerp(double(curve.node[below].x), double(curve.node[below + 1].x), at - double(below))));
    }
    return low + (high - low) * std::clamp(relative, 0.0, 1.0);
}

}  // namespace vesper
