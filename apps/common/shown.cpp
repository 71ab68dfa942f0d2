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
        const double x = double(curve.block[0].x) * luminance;
        relative = x * (1 + x * double(curve.block[0].y)) / (1 + x);
    } else if (form == shared::kToneLinear || form == shared::kToneRods) {
        // Of a grey pixel: its luminance as the eye adapted to colours sees it, and what rods add.
        const auto sum = [](glm::vec4 row) { return row.x + row.y + row.z; };
        const glm::vec4 rods = curve.block[1];
        const double seen = kRed * (sum(curve.block[2]) + rods.x) + kGreen * (sum(curve.block[3]) + rods.y) +
                            kBlue * (sum(curve.block[4]) + rods.z);
        const double grey = form == shared::kToneRods ? luminance * seen : luminance;
        relative = (grey - double(curve.block[0].x)) * double(curve.block[0].y);
    } else if (form != shared::kToneLdr) {
        const double ln = std::log(std::max(luminance, double(shared::kLuminanceFloor)));
        const double at = std::clamp((ln - curve.ln_low) * double(curve.bins_per_ln), 0.0, double(curve.bins));
        const size_t below = std::min(size_t(at), size_t(curve.bins) - 1);
        const glm::dvec4 node =
            glm::mix(glm::dvec4(curve.node[below]), glm::dvec4(curve.node[below + 1]), at - double(below));
        if (form != shared::kToneColour) return std::min(high, std::exp(node.x));
        const double seen = std::clamp(node.x + node.z + double(curve.block[0].x), 0.0, 0.9999999);
        relative = double(curve.block[0].y) * std::pow(seen / (1 - seen), 1 / double(shared::kResponsePower));
    }
    return low + (high - low) * std::clamp(relative, 0.0, 1.0);
}

}  // namespace vesper
