#include "render/retina.h"

#include <cmath>

#include "base/angle.h"
#include "base/luminance.h"

namespace vesper::render {

std::vector<float> retinal_luminance(ToneMapper& mapper, const HostPicture& picture,
                                     const std::optional<gpu_scene::ScatterSettings>& eye) {
    ToneMapped seen;
    std::span<const float> values = picture.values;
    size_t channels = picture.channels;
    double scale = double(picture.scale);
    if (eye) {
        ToneChainSettings settings;
        settings.glare = Glare::Scatter, settings.scatter = *eye;
        seen = mapper.map(settings, picture, 0, {.display = false, .retina = true});
        values = seen.retina, channels = 4, scale = 1;
    }
    std::vector<float> luminances;
    luminances.reserve(values.size() / channels);
    for (size_t i = 0; i + channels <= values.size(); i += channels) {
        const double l = scale * luminance({values[i], values[i + 1], values[i + 2]});
        luminances.push_back(std::isfinite(l) ? float(l) : 0);
    }
    return luminances;
}

double pixels_per_degree(uint32_t height, double vertical_fov) {
    return kRadiansPerDegree * height / (2 * std::tan(vertical_fov / 2));
}

}  // namespace vesper::render
