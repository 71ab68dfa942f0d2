#include "transport/light_picture.h"

#include "base/parallel.h"
#include "transport/sampling.h"

namespace vesper::transport {
namespace {

constexpr size_t kPointsAtATime = 64;

}  // namespace

glm::vec3 PointLight::other() const {
    glm::vec3 sum(0);
    for (size_t i = 0; i < kOrigins; ++i)
        if (Origin(i) != Origin::Lamps) sum += lux[i];
    return sum;
}

std::vector<PointLight> light_of(const LightTracer& tracer, std::span<const LitPoint> points,
                                 const TraceSettings& settings, const std::function<bool(double)>& progress) {
    std::vector<PointLight> light(points.size());
    const auto trace = [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            if (points[i].normal == glm::dvec3(0)) continue;
            TraceSettings own = settings;
            own.seed = Random(Random(settings.seed).next_bits() + i).next_bits();
            const Illuminance found = tracer.at(points[i].point, points[i].normal, own);
            for (size_t k = 0; k < kOrigins; ++k) light[i].lux[k] = glm::vec3(found.rgb[k]);
            light[i].standard_error = float(found.standard_error_of_sum);
        }
    };
    const auto report = [&](size_t done) { return !progress || progress(double(done) / double(points.size())); };
    if (!in_parallel(points.size(), kPointsAtATime, trace, report)) light.clear();
    return light;
}

}  // namespace vesper::transport
