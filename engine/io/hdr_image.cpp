// HDR pictures: which reader, sizes, primaries. SPDX-License-Identifier: MIT
#include "io/hdr_image.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <new>

#include "base/budget.h"
#include "base/error.h"
#include "base/one_line.h"
#include "io/hdr_parts.h"
#include "io/read_file.h"

namespace vesper::io {
namespace hdr {

void transform(HdrImage& image, const glm::dmat3& matrix) {
    double off = 0;
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) off = std::max(off, std::abs(matrix[c][r] - (c == r)));
    if (off < 1e-5) return;  // attributes are 32-bit floats
    for (size_t i = 0; i + 2 < image.rgb.size(); i += 3) {
        float* p = image.rgb.data() + i;
        const glm::dvec3 colour = matrix * glm::dvec3(p[0], p[1], p[2]);
        for (int c = 0; c < 3; ++c) p[c] = static_cast<float>(colour[c]);
    }
}

void check_size(const char* what, int64_t width, int64_t height, const HdrLimits& limits) {
    const char* why = nullptr;
    if (width < 1 || height < 1)
        why = " has no pixels";
    else if (width > limits.max_side || height > limits.max_side)
        why = " is larger than the limit for one side";
    else if (static_cast<uint64_t>(width) * static_cast<uint64_t>(height) > limits.max_pixels)
        why = " has more pixels than the limit";
    if (why) throw Error(what + (" of " + std::to_string(width)) + " x " + std::to_string(height) + " px" + why);
}

}  // namespace hdr

namespace {

enum class Kind { Any, Exr, Radiance };

HdrImage decode(std::span<const uint8_t> bytes, const std::string& name, Kind wanted, const HdrLimits& limits,
                const std::string& layer) {
    const std::string type = media_type(bytes);
    try {
        if (type == "image/x-exr" && wanted != Kind::Radiance) return hdr::decode_exr(bytes, name, limits, layer);
        if (type == "image/vnd.radiance" && wanted != Kind::Exr) {
            if (!layer.empty()) throw Error("Radiance pictures have no layers");
            return hdr::decode_radiance(bytes, limits);
        }
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        throw Error(one_line(name) + ": " + one_line(error.what()));
    }
    const char* expected = wanted == Kind::Any   ? "OpenEXR nor Radiance (.hdr)"
                           : wanted == Kind::Exr ? "OpenEXR"
                                                 : "Radiance (.hdr)";
    const char* is = wanted == Kind::Any ? "is neither " : "is not ";
    throw Error(one_line(name) + ": " + is + expected + (type.empty() ? "" : ", but " + type));
}

HdrImage read(const std::filesystem::path& file, Kind wanted, const HdrLimits& limits, const std::string& layer) {
    const Budget budget("reading " + one_line(file.string()));
    return decode(read_file(file, scaled_limit(hdr::kMaxFileBytes)), file.string(), wanted, limits, layer);
}

}  // namespace

HdrImage read_exr(const std::filesystem::path& file, const HdrLimits& limits, const std::string& layer) {
    return read(file, Kind::Exr, limits, layer);
}
HdrImage read_radiance(const std::filesystem::path& file, const HdrLimits& limits) {
    return read(file, Kind::Radiance, limits, {});
}
HdrImage read_hdr_image(const std::filesystem::path& file, const HdrLimits& limits, const std::string& layer) {
    return read(file, Kind::Any, limits, layer);
}
HdrImage decode_hdr_image(std::span<const uint8_t> bytes, const std::string& name, const HdrLimits& limits) {
    return decode(bytes, name, Kind::Any, limits, {});
}

}  // namespace vesper::io
