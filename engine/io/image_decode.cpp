// PNG and JPEG, from memory; WebP is in image_webp.cpp. Both libraries report errors with longjmp, so what must be
// destroyed lives outside the functions that call setjmp. SPDX-License-Identifier: MIT
#include "io/image_file.h"

#include <algorithm>
#include <bit>
#include <csetjmp>
#include <cstdio>
#include <cstring>

#include <jerror.h>
#include <jpeglib.h>
#include <png.h>

#include "base/budget.h"
#include "base/error.h"
#include "base/one_line.h"
#include "io/image_webp.h"

namespace vesper::io {
namespace {

/// What a decoder works on: its input, where it stops, what it makes and why it gave up.
struct Job {
    std::span<const uint8_t> bytes;
    uint32_t max_side;
    uint64_t max_texels;
    bool wide = false;  // 16 bits a channel, of PNG alone
    bool over_limit = false;
    size_t read = 0;
    Image image;
    WideImage wide_image;
    std::vector<uint8_t> row;
    char reason[JMSG_LENGTH_MAX + 100] = "";
    std::jmp_buf escape;
};

/// Whether such a picture may be made. A file too short for the pixels it declares is refused before memory is taken
/// for them: neither format packs more than `max_texels_per_byte`.
bool acceptable(Job& job, uint64_t width, uint64_t height, uint64_t max_texels_per_byte) {
    const char* why = over_limit(width, height, job.max_side, job.max_texels);
    job.over_limit = why != nullptr;
    if (width == 0 || height == 0) why = "has no pixels";
    if (!why && width * height / max_texels_per_byte > job.bytes.size()) why = "is cut off";
    if (!why) return true;
    std::snprintf(job.reason, sizeof job.reason, "picture of %llu x %llu px %s", static_cast<unsigned long long>(width),
                  static_cast<unsigned long long>(height), why);
    return false;
}

void make_image(Job& job, uint32_t width, uint32_t height) {
    spend(uint64_t{width} * height * (job.wide ? 8 : 4));
    const size_t values = static_cast<size_t>(width) * height * 4;
    if (job.wide)
        job.wide_image.width = width, job.wide_image.height = height, job.wide_image.rgba.resize(values);
    else
        job.image.width = width, job.image.height = height, job.image.rgba.resize(values);
}

[[noreturn]] void png_fail(png_structp png, png_const_charp message) {
    Job& job = *static_cast<Job*>(png_get_error_ptr(png));
    std::snprintf(job.reason, sizeof job.reason, "%s", message);
    std::longjmp(job.escape, 1);
}

void png_ignore(png_structp, png_const_charp) {}

void png_feed(png_structp png, png_bytep target, size_t count) {
    Job& job = *static_cast<Job*>(png_get_io_ptr(png));
    if (count > job.bytes.size() - job.read) png_error(png, "is cut off");
    std::memcpy(target, job.bytes.data() + job.read, count);
    job.read += count;
}

/// What libpng has made goes however its work ends.
struct PngReading {
    png_structp png;
    png_infop header;
    explicit PngReading(Job& job)
        : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, &job, png_fail, png_ignore)),
          header(png ? png_create_info_struct(png) : nullptr) {}
    ~PngReading() { png_destroy_read_struct(&png, &header, nullptr); }
    PngReading(const PngReading&) = delete;
    PngReading& operator=(const PngReading&) = delete;
};

/// False, with a reason, when it did not work.
bool decode_png(Job& job, const PngReading& reading) {
    const png_structp png = reading.png;
    const png_infop header = reading.header;
    if (!header || setjmp(job.escape)) return false;
    png_set_read_fn(png, &job, png_feed);
    png_set_user_limits(png, job.max_side, job.max_side);
    png_set_chunk_malloc_max(png, 64u << 20);
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr,
                                -1);  // texts, profiles and the like: some kilobytes hold megabytes
    png_read_info(png, header);
    const png_uint_32 width = png_get_image_width(png, header), height = png_get_image_height(png, header);
    // Deflate packs at most 1032 : 1, and a texel may be a single bit.
    if (!acceptable(job, width, height, 1040 * 8)) return false;
    if (job.wide) {
        png_set_expand_16(png);
        if (std::endian::native == std::endian::little) png_set_swap(png);
    } else {
        png_set_expand(png);
        png_set_scale_16(png);
    }
    png_set_gray_to_rgb(png);
    png_set_add_alpha(png, job.wide ? 0xffff : 0xff, PNG_FILLER_AFTER);
    const int passes = png_set_interlace_handling(png);
    png_read_update_info(png, header);
    make_image(job, width, height);
    const size_t stride = static_cast<size_t>(width) * (job.wide ? 8 : 4);
    if (png_get_rowbytes(png, header) != stride) png_error(png, "unexpected row size");
    uint8_t* const rows = job.wide ? reinterpret_cast<uint8_t*>(job.wide_image.rgba.data()) : job.image.rgba.data();
    for (int pass = 0; pass < passes; ++pass)
        for (png_uint_32 y = 0; y < height; ++y) {
            check_time();
            png_read_row(png, rows + y * stride, nullptr);
        }
    png_read_end(png, nullptr);
    return true;
}

[[noreturn]] void jpeg_fail(j_common_ptr jpeg) {
    Job& job = *static_cast<Job*>(jpeg->client_data);
    (*jpeg->err->format_message)(jpeg, job.reason);
    std::longjmp(job.escape, 1);
}

/// libjpeg fills what is missing with grey and only warns: for us the file is damaged. Other warnings are harmless.
void jpeg_message(j_common_ptr jpeg, int level) {
    if (level < 0 && (jpeg->err->msg_code == JWRN_JPEG_EOF || jpeg->err->msg_code == JWRN_HIT_MARKER)) jpeg_fail(jpeg);
}

void jpeg_progress(j_common_ptr jpeg) {
    // Some kilobytes can ask for thousands of passes over a large picture; encoders make some ten.
    constexpr uint64_t kMostScans = 500, kMostOfTheLargest = 16, kLargest = uint64_t{1} << 28;
    if (!jpeg->is_decompressor) return;
    Job& job = *static_cast<Job*>(jpeg->client_data);
    const auto& reading = *reinterpret_cast<j_decompress_ptr>(jpeg);
    const auto scans = static_cast<uint64_t>(std::max(reading.input_scan_number, 0));
    if (scans <= kMostScans &&
        scans * reading.image_width * reading.image_height <= kMostOfTheLargest * std::min(job.max_texels, kLargest))
        return;
    std::snprintf(job.reason, JMSG_LENGTH_MAX, "%llu scans are too many for its size",
                  static_cast<unsigned long long>(scans));
    std::longjmp(job.escape, 1);
}

void expand_row(const uint8_t* row, int components, bool inverted, std::span<uint8_t> rgba) {
    for (size_t x = 0; x < rgba.size() / 4; ++x) {
        uint8_t* out = rgba.data() + 4 * x;
        for (int c = 0; c < 3; ++c) {
            if (components == 4) {
                const int ink = inverted ? row[4 * x + c] : 255 - row[4 * x + c];
                const int key = inverted ? row[4 * x + 3] : 255 - row[4 * x + 3];
                out[c] = static_cast<uint8_t>((ink * key + 127) / 255);
            } else {
                out[c] = row[3 * x + c];
            }
        }
        out[3] = 255;
    }
}

struct JpegReading {
    jpeg_error_mgr errors{};
    jpeg_progress_mgr progress{};
    jpeg_decompress_struct jpeg{};
    JpegReading() = default;
    ~JpegReading() { jpeg_destroy_decompress(&jpeg); }
    JpegReading(const JpegReading&) = delete;
    JpegReading& operator=(const JpegReading&) = delete;
};

bool decode_jpeg(Job& job, JpegReading& reading) {
    auto& [errors, progress, jpeg] = reading;
    jpeg.err = jpeg_std_error(&errors);
    jpeg.client_data = &job;
    errors.error_exit = jpeg_fail;
    errors.emit_message = jpeg_message;
    if (setjmp(job.escape)) return false;
    jpeg_create_decompress(&jpeg);
    progress.progress_monitor = jpeg_progress;
    jpeg.progress = &progress;
    jpeg_mem_src(&jpeg, job.bytes.data(), static_cast<unsigned long>(job.bytes.size()));
    jpeg_read_header(&jpeg, TRUE);
    // At least one bit for each block of 64 texels, of which subsampling may make sixteen.
    if (!acceptable(job, jpeg.image_width, jpeg.image_height, 64 * 16 * 8)) return false;
    // Four inks come as CMYK (libjpeg undoes YCCK); Adobe's files hold them inverted.
    jpeg.out_color_space = jpeg.num_components == 4 ? JCS_CMYK : JCS_RGB;
    jpeg_start_decompress(&jpeg);
    make_image(job, jpeg.output_width, jpeg.output_height);
    job.row.resize(static_cast<size_t>(jpeg.output_width) * static_cast<size_t>(jpeg.output_components));
    const size_t stride = static_cast<size_t>(jpeg.output_width) * 4;
    while (jpeg.output_scanline < jpeg.output_height) {
        check_time();
        const size_t y = jpeg.output_scanline;
        JSAMPROW row = job.row.data();
        jpeg_read_scanlines(&jpeg, &row, 1);
        expand_row(row, jpeg.output_components, jpeg.saw_Adobe_marker,
                   std::span(job.image.rgba).subspan(y * stride, stride));
    }
    jpeg_finish_decompress(&jpeg);
    return true;
}

}  // namespace

std::string media_type(std::span<const uint8_t> bytes) {
    const auto starts = [&](size_t at, std::string_view magic) {
        return bytes.size() >= at + magic.size() && std::memcmp(bytes.data() + at, magic.data(), magic.size()) == 0;
    };
    using namespace std::string_view_literals;
    if (starts(0, "\x89PNG\r\n\x1a\n"sv)) return "image/png";
    if (starts(0, "\xff\xd8\xff"sv)) return "image/jpeg";
    if (starts(0, "RIFF"sv) && starts(8, "WEBP"sv)) return "image/webp";
    if (starts(0, "\xabKTX 20"sv)) return "image/ktx2";
    if (starts(0, "\xabKTX 11"sv)) return "image/ktx";
    if (starts(0, "DDS "sv)) return "image/vnd-ms.dds";
    if (starts(4, "ftypavif"sv)) return "image/avif";
    if (starts(0, "GIF8"sv)) return "image/gif";
    if (starts(0, "BM"sv)) return "image/bmp";
    if (starts(0, "II*\0"sv) || starts(0, "MM\0*"sv)) return "image/tiff";
    if (starts(0, "#?RADIANCE"sv) || starts(0, "#?RGBE"sv)) return "image/vnd.radiance";
    if (starts(0, "\x76\x2f\x31\x01"sv)) return "image/x-exr";
    return "";
}

bool is_16_bit_png(std::span<const uint8_t> bytes) {
    return bytes.size() > 24 && bytes[24] == 16 && media_type(bytes) == "image/png";
}

std::optional<PngColour> stated_colour(std::span<const uint8_t> png) {
    constexpr size_t kSignature = 8, kFrame = 12;  // length and name before what a chunk holds, sum behind it
    if (media_type(png) != "image/png") return {};
    for (size_t at = kSignature; at + kFrame <= png.size();) {
        const size_t length =
            size_t{png[at]} << 24 | size_t{png[at + 1]} << 16 | size_t{png[at + 2]} << 8 | png[at + 3];
        if (length > png.size() - at - kFrame) return {};
        const auto named = [&](const char* name) { return std::memcmp(&png[at + 4], name, 4) == 0; };
        if (named("cICP") && length == 4) return PngColour{png[at + 8], png[at + 9]};
        if (named("IDAT")) return {};
        at += length + kFrame;
    }
    return {};
}

namespace {

/// Does the job. Throws Error.
void run(Job& job) {
    const std::string type = media_type(job.bytes);
    bool done = false;
    if (type == "image/png") {
        done = decode_png(job, PngReading(job));
    } else if (type == "image/jpeg") {
        JpegReading reading;
        done = decode_jpeg(job, reading);
    } else {
        throw Error(type.empty() ? "is neither PNG nor JPEG" : "is " + type + ", neither PNG nor JPEG");
    }
    const std::string reason = one_line(std::string(type == "image/png" ? "PNG: " : "JPEG: ") +
                                        (job.reason[0] ? job.reason : "out of memory"));
    if (job.over_limit) throw OverLimit(reason);
    if (!done) throw Error(reason);
}

}  // namespace

Image decode_image(std::span<const uint8_t> bytes, uint32_t max_side, uint64_t max_texels) {
    if (reads_webp() && media_type(bytes) == "image/webp") return decode_webp(bytes, max_side, max_texels);
    Job job{.bytes = bytes, .max_side = max_side, .max_texels = max_texels};
    run(job);
    return std::move(job.image);
}

WideImage decode_wide_png(std::span<const uint8_t> bytes, uint32_t max_side, uint64_t max_texels) {
    if (media_type(bytes) != "image/png") throw Error("is no PNG");
    Job job{.bytes = bytes, .max_side = max_side, .max_texels = max_texels, .wide = true};
    run(job);
    return std::move(job.wide_image);
}

}  // namespace vesper::io
