// Scene files of other programs. SPDX-License-Identifier: MIT
#include "scene/other_formats.h"

#include <algorithm>

namespace vesper::scene {
namespace {

/// A text with the zeros in it.
template <size_t N>
constexpr std::string_view raw(const char (&text)[N]) {
    return {text, N - 1};
}

/// The start of a file, and what is known beside it.
struct Start {
    std::string_view bytes;
    uint64_t size;
    std::string_view ending;

    bool is(std::string_view magic, size_t at = 0) const {
        return bytes.size() >= at && bytes.substr(at).starts_with(magic);
    }
    bool has(std::string_view text) const { return bytes.find(text) != bytes.npos; }
    uint32_t byte(size_t at) const { return at < bytes.size() ? static_cast<uint8_t>(bytes[at]) : 0; }
    uint32_t little(size_t at) const { return byte(at) | byte(at + 1) << 8 | byte(at + 2) << 16 | byte(at + 3) << 24; }
};

/// The first line that is neither empty nor a comment that begins with `mark`, without blanks before it.
std::string_view first_statement(std::string_view text, char mark) {
    while (!text.empty()) {
        const size_t end = std::min(text.find_first_of("\r\n"), text.size());
        std::string_view line = text.substr(0, end);
        line.remove_prefix(std::min(line.find_first_not_of(" \t\xef\xbb\xbf"), line.size()));
        if (!line.empty() && line[0] != mark) return line;
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return {};
}

bool is_obj(const Start& s) {
    if (s.has(raw("\0"))) return false;
    const std::string_view line = first_statement(s.bytes, '#');
    if (line.empty()) return s.ending == ".obj" && !s.bytes.empty();
    const std::string_view word = line.substr(0, line.find_first_of(" \t"));
    if (word.size() == line.size()) return false;
    constexpr std::string_view kWords[]{"v", "vt", "vn", "vp", "f", "l", "p", "o", "g", "s", "mtllib", "usemtl"};
    return std::ranges::find(kWords, word) != std::end(kWords);
}

bool is_fbx(const Start& s) {
    return s.is("Kaydara FBX Binary") || s.is("; FBX ") ||
           first_statement(s.bytes, ';').starts_with("FBXHeaderExtension");
}

bool is_compressed(const Start& s) { return s.is(raw("\x28\xb5\x2f\xfd")) || s.is(raw("\x1f\x8b")); }
bool is_blend(const Start& s) { return s.is("BLENDER") || (is_compressed(s) && s.ending == ".blend"); }

bool is_zip(const Start& s) { return s.is(raw("PK\x03\x04")); }
bool is_usd(const Start& s) {
    if (s.is("#usda") || s.is("PXR-USDC")) return true;
    const size_t name = s.byte(26) | s.byte(27) << 8;  // its length: the first file in it must be the layer
    return is_zip(s) && s.bytes.substr(0, std::min(s.bytes.size(), 30 + name)).find(".usd") != s.bytes.npos;
}

/// OpenFlight: a header record (operation 1, its length at most some hundred bytes) with the format's revision.
bool is_flt(const Start& s) {
    constexpr uint32_t kShortest = 128, kLongest = 1024, kOldest = 1100, kNewest = 9999;
    const uint32_t length = s.byte(2) << 8 | s.byte(3);
    const uint32_t revision = s.byte(12) << 24 | s.byte(13) << 16 | s.byte(14) << 8 | s.byte(15);
    return s.is(raw("\0\1")) && length >= kShortest && length <= kLongest && revision <= kNewest &&
           (revision >= kOldest || s.ending == ".flt");
}

bool is_osg(const Start& s) {
    return s.is(raw("\xa1\x0e\x91\x6c\x45\x45\xfb\x1a")) || s.is(raw("\x6c\x91\x0e\xa1\x1a\xfb\x45\x45")) ||
           s.is("#Ascii Scene") || s.is(raw("\x04\x03\x02\x01")) || s.is(raw("\x01\x02\x03\x04"));
}

bool is_3ds(const Start& s) {
    constexpr uint32_t kChunkHead = 6;
    const uint32_t first = s.byte(kChunkHead) | s.byte(kChunkHead + 1) << 8;
    return s.is("MM") && s.little(2) >= kChunkHead && s.little(2) <= s.size && (first == 0x0002 || first == 0x3d3d);
}

bool is_ply(const Start& s) { return s.is("ply\n") || s.is("ply\r"); }

bool is_stl(const Start& s) {
    constexpr uint64_t kHead = 84, kTriangle = 50;  // bytes
    if (s.size >= kHead && s.bytes.size() >= kHead && s.size == kHead + kTriangle * s.little(80)) return true;
    return (s.is("solid ") || s.is("solid\n") || s.is("solid\r")) && (s.has("facet") || s.has("endsolid"));
}

constexpr std::string_view kBlender = "import it into Blender and export it: File > Export > glTF 2.0";
constexpr std::string_view kOwn = "open it in Blender and export it: File > Export > glTF 2.0";
constexpr std::string_view kOsg =
    "convert it with OpenSceneGraph (osgconv IN OUT.obj), import that into Blender and export it: "
    "File > Export > glTF 2.0";

struct Format {
    std::string_view name;
    bool (*begins)(const Start&);
    std::string_view way;
};

// The one list of formats that are told and not read. Formats without a sure first word stand last.
constexpr Format kFormats[]{
    {"an FBX file", is_fbx, kBlender},
    {"a Blender file", is_blend, kOwn},
    {"a USD file", is_usd, kBlender},
    {"an OpenSceneGraph file", is_osg, kOsg},
    {"a PLY file", is_ply, kBlender},
    {"a Collada file", [](const Start& s) { return s.has("<COLLADA"); },
     "import it into Blender (before 5.0) and export it: File > Export > glTF 2.0; or assimp export IN OUT.glb"},
    {"a VRML or X3D file", [](const Start& s) { return s.is("#VRML") || s.is("#X3D") || s.has("<X3D"); }, kBlender},
    {"an OpenDRIVE file", [](const Start& s) { return s.has("<OpenDRIVE"); },
     "make a scene of it: vesper convert IN -o OUT.gltf"},
    {"a 3DS file", is_3ds, "convert it (assimp export IN OUT.glb)"},
    {"an OpenFlight file", is_flt, kOsg},
    {"a ZIP archive", is_zip, "unpack it and name the .gltf or .glb in it"},
    {"a compressed file (Zstandard or gzip, as Blender's may be)", is_compressed, "unpack it, or see what wrote it"},
    {"an STL file", is_stl, kBlender},
    {"a Wavefront OBJ file", is_obj, kBlender},
};

}  // namespace

std::string other_format(std::span<const uint8_t> start, uint64_t size, std::string_view ending) {
    const Start s{{reinterpret_cast<const char*>(start.data()), start.size()}, size, ending};
    for (const Format& format : kFormats)
        if (format.begins(s))
            return "is " + std::string(format.name) + ", which is not read: " + std::string(format.way);
    return {};
}

}  // namespace vesper::scene
