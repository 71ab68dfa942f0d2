#include "fuzz/targets.h"

#include <fstream>

#include "io/exif.h"
#include "io/hdr_image.h"
#include "io/image_file.h"
#include "photometry/distribution.h"
#include "photometry/eulumdat.h"
#include "photometry/grid.h"
#include "photometry/ies.h"
#include "photometry/reflection_table.h"
#include "photometry/response.h"
#include "roads/esmini_run.h"
#include "roads/layout_file.h"
#include "roads/opendrive.h"
#include "scene/display_file.h"
#include "scene/gltf.h"
#include "scene/photometry.h"
#include "traffic/world_file.h"
#include "vision/display_fit.h"

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

// A run of one car along 100 m, for scenarios to play on.
constexpr const char* kRun =
    "time,id,name,x,y,z,h,p,r,speed,wheel_angle,wheel_rot\n0,0,Ego,0,-2,0,0,0,0,10,0,0\n1,0,Ego,10,-2,0,0,0,0,10,0,"
    "0\n2,0,Ego,20,-2,0,0,0,0,10,0,0\n";
constexpr const char* kRoads =
    R"(<OpenDRIVE><header revMajor="1" revMinor="6"/><road id="1" length="100" junction="-1"><planView><geometry s="0" x="0" y="0" hdg="0" length="100"><line/></geometry>
</planView><lanes><laneSection s="0"><center><lane id="0" type="none"/></center><right><lane id="-1" type="driving"><width sOffset="0" a="4" b="0" c="0" d="0"/></lane></right></laneSection></lanes></road></OpenDRIVE>)";

void read_scenario(const fs::path& scenario) {
    static const roads::RoadNetwork roads = roads::parse_opendrive(kRoads, "x.xodr");
    const fs::path table = scenario.parent_path() / "run.csv";
    if (!fs::exists(table)) std::ofstream(table) << kRun;
    roads::read_esmini_run(table, scenario, &roads);
}

std::map<std::string, FuzzTarget> make_targets() {
    return {
        {"gltf", of_file("x.gltf", [](const fs::path& file) { scene::read_gltf(file, kFew); })},
        {"glb", of_file("x.glb", [](const fs::path& file) { scene::read_gltf(file, kFew); })},
        {"photometry", of_file("x.photometry.json", [](const fs::path& file) { scene::read_photometry(file); })},
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
         of_file("x.csv", [](const fs::path& file) { vision::read_display_measurements(file, 8); })},
        {"opendrive",
         [](Bytes bytes) {
             roads::parse_opendrive({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "x.xodr");
         }},
        {"esmini_run", of_file("x.csv", [](const fs::path& file) { roads::read_esmini_run(file); })},
        {"world", of_file("x.world.json", [](const fs::path& file) { traffic::read_world(file); })},
        {"response", of_file("x.csv", [](const fs::path& file) { photometry::read_response(file); })},
        {"road", of_file("x.json", [](const fs::path& file) { roads::read_layout(file); })},
        {"scenario", of_file("x.xosc", read_scenario)},
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
