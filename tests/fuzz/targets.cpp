#include "fuzz/targets.h"

#include <fstream>

#include "analysis/display_fit.h"
#include "eye/projection.h"
#include "fuzz/compressed.h"
#include "io/exif.h"
#include "io/hdr_image.h"
#include "io/image_file.h"
#include "osi/datagrams.h"
#include "osi/timeline.h"
#include "osi/trace.h"
#include "photometry/distribution.h"
#include "photometry/eulumdat.h"
#include "photometry/grid.h"
#include "photometry/ies.h"
#include "photometry/reflection_table.h"
#include "photometry/response.h"
#include "roads/esmini_run.h"
#include "roads/layout_file.h"
#include "roads/opendrive.h"
#include "scene/apply_photometry.h"
#include "scene/display_file.h"
#include "scene/read_scene.h"
#include "traffic/world_file.h"
#include "vision/warp_mesh.h"

namespace vesper::test {
namespace {

namespace fs = std::filesystem;
using Bytes = std::span<const uint8_t>;

// Small limits: a fuzzer looks for mistakes, not for memory.
constexpr uint64_t kSmall = 1 << 16;
const scene::SceneLimits kFew{.file_bytes = 1 << 22,
                              .vertices = kSmall,
                              .indices = kSmall,
                              .texels = kSmall,
                              .image_side = 512,
                              .nodes = 1000,
                              .lamps = 100,
                              .candela = kSmall};

// Datagrams, each after its length as two bytes; what they make is shown at some moments.
void hear_datagrams(Bytes bytes) {
    osi::DatagramReader reader;
    osi::Timeline timeline(false);
    while (bytes.size() >= 2) {
        const size_t length = std::min<size_t>(bytes[0] + 256 * bytes[1], bytes.size() - 2);
        const auto whole = reader.take(bytes.subspan(2, length));
        bytes = bytes.subspan(2 + length);
        if (!whole) continue;
        try {
            timeline.add(osi::parse_message(*whole));
        } catch (const Error&) {
            continue;
        }
        timeline.at(timeline.latest() - 0.1);
        timeline.at(timeline.latest());
    }
}

void draw_mesh(Bytes bytes) {
    const vision::WarpMesh mesh = vision::parse_warp_mesh(bytes, "x.data");
    eye::projection_of({64, 36}, {48, 27}, &mesh);
}

// The rules of a file, applied to a scene that has something for most of them.
void apply(const fs::path& file) {
    const scene::Photometry rules = scene::read_photometry(file);
    scene::Scene scene;
    scene.images.push_back({"texture", 1, 1, {255, 128, 0, 255}});
    for (const char* name : {"road", "lamp_glass"}) {
        scene.materials.push_back({.name = name});
        scene.materials.back().base_colour_texture.image = 0;
    }
    scene::Primitive triangle{.material = 1, .vertices = {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}}, .indices = {0, 1, 2}};
    for (const scene::Vertex& vertex : triangle.vertices) triangle.bounds.add(vertex.position);
    scene.meshes.push_back({"triangle", {triangle}});
    scene.nodes.push_back({.name = "street_lamp_0", .mesh = 0});
    scene.nodes.push_back({.name = "light", .parent = 0});
    scene.nodes.push_back({.name = "car"});
    scene::apply_photometry(scene, rules, "x.gltf");
}

std::map<std::string, FuzzTarget> make_targets() {
    return {
        {"gltf", of_file("x.gltf", [](const fs::path& file) { scene::read_scene(file, kFew); })},
        {"glb", of_file("x.glb", [](const fs::path& file) { scene::read_scene(file, kFew); })},
        {"compressed", of_file("x.bin", [](const fs::path& file) { scene::read_scene(scene_around(file), kFew); })},
        {"photometry", of_file("x.photometry.json", apply)},
        {"ies", [](Bytes bytes) { photometry::parse_ies(bytes, "x.ies"); }},
        {"ldt", [](Bytes bytes) { photometry::parse_eulumdat(bytes, "x.ldt"); }},
        {"grid_csv", [](Bytes bytes) { photometry::parse_grid_csv(bytes, "x.csv"); }},
        {"grid_exr", [](Bytes bytes) { photometry::parse_grid_exr(bytes, "x.exr"); }},
        {"reflection_table", [](Bytes bytes) { photometry::parse_reflection_table(bytes, "x.csv"); }},
        {"exr",
         of_file("x.exr", [](const fs::path& file) { io::read_exr(file, {.max_side = 512, .max_pixels = kSmall}); })},
        {"radiance",
         of_file("x.hdr",
                 [](const fs::path& file) { io::read_radiance(file, {.max_side = 512, .max_pixels = kSmall}); })},
        {"display", of_file("x.json", [](const fs::path& file) { scene::read_display(file); })},
        {"display_measurements",
         of_file("x.csv", [](const fs::path& file) { analysis::read_display_measurements(file, 8); })},
        {"opendrive",
         [](Bytes bytes) {
             roads::parse_opendrive({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "x.xodr");
         }},
        {"esmini_run", of_file("x.csv", [](const fs::path& file) { roads::read_esmini_run(file); })},
        {"world", of_file("x.world.json", [](const fs::path& file) { traffic::read_world(file); })},
        {"response", of_file("x.csv", [](const fs::path& file) { photometry::read_response(file); })},
        {"road", of_file("x.json", [](const fs::path& file) { roads::read_layout(file); })},
        {"osi_trace", [](Bytes bytes) { osi::parse_trace(bytes, "x.osi"); }},
        {"osi_datagrams", [](Bytes bytes) { hear_datagrams(bytes); }},
        {"warp_mesh", draw_mesh},
        {"wide_png", [](Bytes bytes) { io::decode_wide_png(bytes, 512, kSmall); }},
        {"image", [](Bytes bytes) { io::decode_image(bytes, 512, kSmall); }},
        {"exif", [](Bytes bytes) { io::read_exif(bytes); }},
    };
}

}  // namespace

const std::map<std::string, FuzzTarget>& fuzz_targets() {
    static const std::map<std::string, FuzzTarget> targets = answering(make_targets());
    return targets;
}

}  // namespace vesper::test
