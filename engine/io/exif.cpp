// Exif through libexif. SPDX-License-Identifier: MIT
#include "io/exif.h"

#include <cmath>
#include <limits>
#include <memory>

#include <libexif/exif-data.h>

#include "io/image_file.h"

namespace vesper::io {
namespace {

/// A finite number, of any sign.
std::optional<double> any_number(ExifData& data, ExifTag tag) {
    const ExifEntry* entry = exif_content_get_entry(data.ifd[EXIF_IFD_EXIF], tag);
    if (!entry || !entry->data || entry->components < 1) return std::nullopt;
    const ExifByteOrder order = exif_data_get_byte_order(&data);
    double value = NAN;
    if (entry->format == EXIF_FORMAT_RATIONAL && entry->size >= 8) {
        const ExifRational ratio = exif_get_rational(entry->data, order);
        value = static_cast<double>(ratio.numerator) / static_cast<double>(ratio.denominator);
    } else if (entry->format == EXIF_FORMAT_SRATIONAL && entry->size >= 8) {
        const ExifSRational ratio = exif_get_srational(entry->data, order);
        value = static_cast<double>(ratio.numerator) / static_cast<double>(ratio.denominator);
    } else if (entry->format == EXIF_FORMAT_SHORT && entry->size >= 2) {
        value = exif_get_short(entry->data, order);
    } else if (entry->format == EXIF_FORMAT_LONG && entry->size >= 4) {
        value = static_cast<double>(exif_get_long(entry->data, order));
    }
    if (!std::isfinite(value)) return std::nullopt;
    return value;
}

std::optional<double> number(ExifData& data, ExifTag tag) {
    const std::optional<double> value = any_number(data, tag);
    return value && *value > 0 ? value : std::nullopt;
}

/// 2^(factor * value) of a value in APEX units (Exif 2.32, annex C); nothing where no camera has such a value.
std::optional<double> of_apex(ExifData& data, ExifTag tag, double factor) {
    constexpr double kMost = 40;  // 2^40 s are 35,000 years
    const std::optional<double> value = any_number(data, tag);
    if (!value || std::abs(*value) > kMost) return std::nullopt;
    return std::exp2(factor * *value);
}

}  // namespace

CameraExposure read_exif(std::span<const uint8_t> bytes) {
    if (media_type(bytes) != "image/jpeg" || bytes.size() > std::numeric_limits<unsigned>::max()) return {};
    const std::unique_ptr<ExifData, void (*)(ExifData*)> data(
        exif_data_new_from_data(bytes.data(), static_cast<unsigned>(bytes.size())), exif_data_unref);
    if (!data) return {};
    CameraExposure camera{number(*data, EXIF_TAG_EXPOSURE_TIME), number(*data, EXIF_TAG_FNUMBER),
                          number(*data, EXIF_TAG_ISO_SPEED_RATINGS)};
    if (!camera.seconds) camera.seconds = of_apex(*data, EXIF_TAG_SHUTTER_SPEED_VALUE, -1);
    if (!camera.f_number) camera.f_number = of_apex(*data, EXIF_TAG_APERTURE_VALUE, 0.5);
    return camera;
}

}  // namespace vesper::io
