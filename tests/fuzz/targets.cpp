#include "fuzz/targets.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "io/hdr_image.h"
#include "perception/display_fit.h"
#include "photometry/distribution.h"
#include "photometry/eulumdat.h"
#include "photometry/grid.h"
#include "photometry/ies.h"
#include "photometry/reflection_table.h"
#include "photometry/response.h"
#include "roads/esmini_run.h"
#include "roads/opendrive.h"
#include "scene/display_file.h"
#include "scene/gltf.h"
#include "scene/photometry.h"
#include "simulation/world_file.h"

namespace vesper::test {
namespace {

namespace fs = std::filesystem;
using Bytes = std::span<const uint8_t>;

// A folder in memory where there is one, gone with the program.
class Scratch {
public:
    Scratch() {
        const fs::path shm = "/dev/shm";
        folder_ = (fs::is_directory(shm) ? shm : fs::temp_directory_path()) / ("vesper-fuzz-" + std::to_string(::getpid()));
        fs::create_directories(folder_);
    }
    ~Scratch() {
        std::error_code ignored;
        fs::remove_all(folder_, ignored);
    }
    fs::path write(const std::string& name, Bytes bytes) const {
        const fs::path file = folder_ / name;
        std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
        return file;
    }

private:
    fs::path folder_;
};

// Small limits: a fuzzer looks for mistakes, not for memory.
constexpr uint64_t kSmall = 1 << 16;
const SceneLimits kFew{.file_bytes = 1 << 22, .vertices = kSmall, .indices = kSmall, .texels = kSmall, .image_side = 512, .nodes = 1000, .lights = 100, .candela = kSmall};

FuzzTarget of_file(const std::string& name, const std::function<void(const fs::path&)>& read) {
    return [=](Bytes bytes) {
        static const Scratch scratch;
        read(scratch.write(name, bytes));
    };
}

FuzzTarget answers(const FuzzTarget& target) {
    return [=](Bytes bytes) {
        try {
            target(bytes);
        } catch (const Error&) {
        }
    };
}

std::map<std::string, FuzzTarget> make_targets() {
    std::map<std::string, FuzzTarget> made{
        {"gltf", of_file("x.gltf", [](const fs::path& file) { read_gltf(file, kFew); })},
        {"glb", of_file("x.glb", [](const fs::path& file) { read_gltf(file, kFew); })},
        {"photometry", of_file("x.photometry.json", [](const fs::path& file) { read_photometry(file); })},
        {"ies", [](Bytes bytes) { parse_ies(bytes, "x.ies"); }},
        {"ldt", [](Bytes bytes) { parse_eulumdat(bytes, "x.ldt"); }},
        {"grid_csv", [](Bytes bytes) { parse_grid_csv(bytes, "x.csv"); }},
        {"grid_exr", [](Bytes bytes) { parse_grid_exr(bytes, "x.exr"); }},
        {"reflection_table", [](Bytes bytes) { parse_reflection_table(bytes, "x.csv"); }},
        {"exr", of_file("x.exr", [](const fs::path& file) { read_exr(file, {.max_side = 512, .max_pixels = kSmall}); })},
        {"radiance", of_file("x.hdr", [](const fs::path& file) { read_radiance(file, {.max_side = 512, .max_pixels = kSmall}); })},
        {"display", of_file("x.json", [](const fs::path& file) { read_display(file); })},
        {"display_measurements", of_file("x.csv", [](const fs::path& file) { read_display_measurements(file, 8); })},
        {"opendrive", [](Bytes bytes) { parse_opendrive({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "x.xodr"); }},
        {"esmini_run", of_file("x.csv", [](const fs::path& file) { read_esmini_run(file); })},
        {"world", of_file("x.world.json", [](const fs::path& file) { read_world(file); })},
        {"response", of_file("x.csv", [](const fs::path& file) { read_response(file); })},
    };
    for (auto& [name, target] : made) target = answers(target);
    return made;
}

}  // namespace

const std::map<std::string, FuzzTarget>& fuzz_targets() {
    static const std::map<std::string, FuzzTarget> targets = make_targets();
    return targets;
}

}  // namespace vesper::test
