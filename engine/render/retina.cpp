#include "render/retina.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/error.h"
#include "base/luminance.h"

namespace vesper::render {

std::vector<float> retinal_luminance(ToneMapper& mapper, const HostPicture& picture,
                                     const std::optional<eye::ScatterSettings>& eye) {
    ToneMapped seen;
    std::vector<float> lit;
    std::span<const float> values = picture.values;
    size_t channels = picture.channels;
    double scale = double(picture.scale);
    const auto is_negative = [&](size_t i) { return luminance({values[i], values[i + 1], values[i + 2]}) < 0; };
    if (eye) {
        HostPicture looked_at = picture;
        for (size_t i = 0; i + channels <= values.size(); i += channels)
            if (is_negative(i)) {
                if (lit.empty()) lit.assign(values.begin(), values.end());
                std::fill_n(lit.begin() + ptrdiff_t(i), 3, 0.0f);
            }
        if (!lit.empty()) looked_at.values = lit;
        ToneChainSettings settings;
        settings.glare = Glare::Scatter, settings.scatter = *eye;
        seen = mapper.map(settings, looked_at, 0, {.display = false, .retina = true});
        values = seen.retina, channels = 4, scale = 1;
    }
    std::vector<float> luminances;
    luminances.reserve(values.size() / channels);
    for (size_t i = 0; i + channels <= values.size(); i += channels) {
        const double l = scale * luminance({values[i], values[i + 1], values[i + 2]});
        luminances.push_back(std::isfinite(l) && l > 0 ? float(l) : 0);
    }
    return luminances;
}

double pixels_per_degree(const HostPicture& picture) {
    if (!picture.angles) return kRadiansPerDegree * picture.extent.height / (2 * std::tan(picture.vertical_fov / 2));
    const glm::dvec2 pixel = picture.angles->pixel();
    if (!(std::abs(pixel.x - pixel.y) <= 0.01 * pixel.y)) throw Error("pixels of a picture are not square");
    return kRadiansPerDegree / pixel.y;
}

}  // namespace vesper::render
