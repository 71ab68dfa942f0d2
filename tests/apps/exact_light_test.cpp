// Light traced for each pixel: in pictures against cells and closed forms, and the options for it.
// SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>

#include "base/luminance.h"
#include "io/hdr_image.h"
#include "render/renderer.h"
#include "render/seen_surfaces.h"
#include "scene/scene_files.h"
#include "support/gathered.h"
#include "support/program.h"
#include "support/rooms.h"
#include "traced_light.h"

namespace vesper::test::exact_light_test {
namespace {

constexpr VkExtent2D kExtent{48, 30};
constexpr double kPi = std::numbers::pi;

/// From the middle of a wall of a room of 8 x 6 x 8 m about the origin, along -z.
gpu_scene::View view_of_room() {
    return gpu_scene::View::symmetric(kExtent, 1, glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -3.9)));
}

double mean_luminance(const std::vector<float>& rgba) {
    double sum = 0;
    for (size_t i = 0; i < rgba.size(); i += 4) sum += luminance({rgba[i], rgba[i + 1], rgba[i + 2]});
    return sum / double(rgba.size() / 4);
}

struct Room {
    scene::Scene scene;
    gpu_scene::SceneFrame poses;
    gpu_scene::View view = view_of_room();

    explicit Room(const std::function<void(scene::Scene&)>& fill) {
        fill(scene);
        poses.world = scene::world_transforms(scene, 0);
    }
    commands::TracedPicture traced(gpu::Device& device, const render::Renderer& renderer, uint32_t paths) const {
        return commands::traced_light(device, scene, renderer.scene(), poses, view, {.paths = paths}, [](double) {});
    }
    double mean(render::Renderer& renderer) const {
        return mean_luminance(renderer.render({}, view, poses, 0, {.display = false, .scene = true}).scene);
    }
};

TEST(ExactLight, SeesSurfacesWhereTheyAre) {
    gpu::Device device({.select = ""});
    const Room room([](scene::Scene& s) { add_room(s, add_material(s, 0.5f), {4, 3, 4}); });
    const gpu_scene::GpuScene resident(device, room.scene);
    const auto points = render::seen_surfaces(device, resident, room.poses, room.view);
    ASSERT_EQ(points.size(), kExtent.width * kExtent.height);
    for (size_t i = 0; i < points.size(); ++i) {
        const glm::dvec3 p = points[i].point, inside(4 - std::abs(p.x), 3 - std::abs(p.y), 4 - std::abs(p.z));
        const double nearest = std::min({inside.x, inside.y, inside.z});
        EXPECT_GT(nearest, 0) << "before the wall, " << i;
        // 1e-5 of 8 m, and what the depth changes in 1/256 px of 0.036 m a metre, and in as much that a device snaps.
        EXPECT_LT(nearest, 2e-4 + 2 * 8 * 0.036 / 256) << i;
        const glm::dvec3 wall = inside.x == nearest   ? glm::dvec3(p.x < 0 ? 1 : -1, 0, 0)
                                : inside.y == nearest ? glm::dvec3(0, p.y < 0 ? 1 : -1, 0)
                                                      : glm::dvec3(0, 0, 1);
        EXPECT_GT(glm::dot(points[i].normal, wall), 1 - 1e-6) << i;
    }
}

TEST(ExactLight, NothingIsSeenOfTheSkyAndOfWhatIsNotFinite) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
    const std::vector<glm::vec4> texels{{0, 0, 0, 0}, {0, 0, kNan, 0}, {0, 0, kInf, 0}, {kNan, 0, 4, 0}, {0, 0, 4, 0}};
    const auto points = render::points_of(texels, gpu_scene::View::symmetric({5, 1}, 1, glm::dmat4(1)));
    for (size_t i = 0; i < 4; ++i) EXPECT_EQ(points[i].normal, glm::dvec3(0)) << i;
    EXPECT_EQ(points[4].normal, glm::dvec3(0, 0, 1));
}

// A closed room that glows on all sides: luminance L / (1 - rho) everywhere.
TEST(ExactLight, InARoomThatGlowsIsKnown) {
    gpu::Device device({.select = ""});
    const Room room([](scene::Scene& s) { add_room(s, add_material(s, 0.6f, 5), {4, 3, 4}); });
    render::Renderer renderer(device, room.scene);
    renderer.set_illuminance(commands::other_light(room.traced(device, renderer, 64)));
    EXPECT_NEAR(room.mean(renderer), 5 / (1 - 0.6), 0.01 * 5 / (1 - 0.6));
}

// A lamp, a bright panel and a box that hides and reflects. 3 %: what cells of 1 m blur.
TEST(ExactLight, AgreesWithCellsOnAverage) {
    gpu::Device device({.select = ""});
    const Room room([](scene::Scene& s) {
        const uint32_t grey = add_material(s, 0.5f);
        add_room(s, grey, {4, 3, 4});
        add_rectangle(s, add_material(s, 0, 500), {-1, 2.9f, -1}, {2, 0, 0}, {0, 0, 2});  // down
        add_box(s, grey, {0.8f, 0.8f, 0.8f}, {1.5f, -2.1f, -1});
        add_lamp(s, 100, {-2, 1, -2});
    });
    render::Renderer renderer(device, room.scene);
    renderer.set_illuminance(commands::other_light(room.traced(device, renderer, 64)));
    const double exact = room.mean(renderer);
    renderer.set_illuminance({});
    const double none = room.mean(renderer);
    renderer.set_radiosity(std::make_shared<const transport::Radiosity>(gathered(room.scene)));
    render::RenderSettings all;
    all.reflections = 32;
    const double cached =
        mean_luminance(renderer.render(all, room.view, room.poses, 0, {.display = false, .scene = true}).scene);
    EXPECT_GT(exact, 2 * none) << "most light here is not that of the lamp directly";
    EXPECT_NEAR(cached - none, exact - none, 0.03 * (exact - none));
}

TEST(ExactLight, IsRefusedForOtherSizes) {
    gpu::Device device({.select = ""});
    const Room room([](scene::Scene& s) { add_room(s, add_material(s, 0.5f), {4, 3, 4}); });
    render::Renderer renderer(device, room.scene);
    renderer.set_illuminance(std::vector<glm::vec4>(47));
    EXPECT_THROW(room.mean(renderer), Error);
    renderer.set_illuminance({});
    EXPECT_NO_THROW(room.mean(renderer));
}

/// A floor under a panel of 300 cd/m^2, which hangs 1 m over it and moves 10 m aside within 1 s.
std::string moving_panel() {
    GltfFile file;
    const auto square = [&](float half, bool down) {
        return nlohmann::json{
            {"attributes", {{"POSITION", file.vec3({-half, 0, -half, half, 0, -half, half, 0, half, -half, 0, half})}}},
            {"indices",
             file.indices(down ? std::vector<uint16_t>{0, 1, 2, 0, 2, 3} : std::vector<uint16_t>{0, 2, 1, 0, 3, 2})},
            {"material", down ? 1 : 0}};
    };
    file.root["materials"] = {
        {{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.5, 0.5, 1}}, {"metallicFactor", 0}}}},
        {{"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 0, 1}}, {"metallicFactor", 0}}},
         {"emissiveFactor", {1, 1, 1}},
         {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 300}}}}}}};
    file.show(square(3, false), {{"name", "floor"}});
    file.show(square(1, true), {{"name", "panel"}, {"translation", {0, 1, 0}}});
    file.root["animations"] = {{{"samplers",
                                 {{{"input", file.accessor(std::vector<float>{0, 1}, 5126, "SCALAR", 1)},
                                   {"output", file.vec3({0, 1, 0, 10, 1, 0})}}}},
                                {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}}}};
    file.root["accessors"][file.root["animations"][0]["samplers"][0]["input"].get<size_t>()]["min"] = {0};
    file.root["accessors"][file.root["animations"][0]["samplers"][0]["input"].get<size_t>()]["max"] = {1};
    file.root["nodes"].push_back({{"name", "eye"}, {"camera", 0}, {"translation", {0, 0.5, 5}}});
    file.root["cameras"] = {
        {{"type", "perspective"}, {"name", "eye"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}}};
    file.root["extensionsUsed"] = {"KHR_materials_emissive_strength"};
    return file.text();
}

class ExactProgram : public ProgramTest {
protected:
    void SetUp() override { folder.write("a.gltf", moving_panel()); }
    /// Of the lower third, where the floor is, cd/m^2.
    double on_floor(const std::string& name) const {
        const io::HdrImage image = io::read_exr(folder / name);
        double sum = 0;
        const size_t first = size_t(image.height) * 2 / 3 * image.width;
        for (size_t i = first; i < size_t(image.width) * image.height; ++i) sum += double(image.rgb[3 * i + 1]);
        return sum / double(size_t(image.width) * image.height - first);
    }
};

// What moves is traced where it is: light of the panel, without cells none of what moves.
TEST_F(ExactProgram, TracesEveryFrame) {
    ASSERT_EQ(run("render a.gltf --size 48x30 --paths 16 --frames 2 --dt 1 -o a%d.exr"), 0) << said;
    ASSERT_EQ(run("render a.gltf --size 48x30 --paths 16 --frames 2 --dt 1 -o b%d.exr"), 0) << said;
    EXPECT_GT(on_floor("a0.exr"), 5);
    EXPECT_LT(on_floor("a1.exr"), 0.2 * on_floor("a0.exr")) << "the panel has gone";
    EXPECT_EQ(io::read_exr(folder / "a0.exr").rgb, io::read_exr(folder / "b0.exr").rgb);
    ASSERT_EQ(run("render a.gltf --size 48x30 --paths 256 -o c.exr"), 0) << said;
    EXPECT_NEAR(on_floor("c.exr"), on_floor("a0.exr"), 0.03 * on_floor("c.exr"));
    ASSERT_EQ(run("render a.gltf --size 48x30 --paths 16 --reflections 0 -o d.exr"), 0) << said;
    EXPECT_LE(on_floor("d.exr"), 1.03 * on_floor("a0.exr"));
    ASSERT_EQ(run("render a.gltf --size 48x30 --indirect on -o e.exr"), 0) << said;
    EXPECT_LT(on_floor("e.exr"), 0.01 * on_floor("c.exr"));
}

TEST_F(ExactProgram, RefusesWhatHasNoMeaning) {
    expect_refused("render a.gltf -o a.png --indirect off --paths 4", {"--paths", "--indirect off"});
    expect_refused("render a.gltf -o a.png --paths 0", {"--paths"});
    expect_refused("render a.gltf -o a.png --paths 16 --operator ldr", {"--paths", "ldr"});
    EXPECT_FALSE(exists("a.png"));
}

TEST_F(ExactProgram, InspectWritesAPictureOfEachOrigin) {
    ASSERT_EQ(run("inspect a.gltf --light l --camera eye --size 48x30 --paths 64 --json a.json"), 0) << said;
    EXPECT_NE(printed.find("camera 'eye', 48 x 30 px, 64 paths a pixel"), printed.npos) << printed;
    for (const char* origin : {"lamps", "emitters", "sky", "once", "more"})
        EXPECT_TRUE(exists(std::string("l-") + origin + ".png")) << origin;
    const io::HdrImage emitters = io::read_exr(folder / "l.exr", {}, "emitters"), sum = io::read_exr(folder / "l.exr");
    ASSERT_EQ(emitters.width, 48u);
    ASSERT_EQ(emitters.height, 30u);
    EXPECT_EQ(sum.white_luminance, 0) << "lx are no luminance";
    double most = 0;
    for (size_t i = 0; i < sum.rgb.size(); ++i) {
        EXPECT_GE(sum.rgb[i], emitters.rgb[i]);
        most = std::max(most, double(emitters.rgb[i]));
    }
    EXPECT_GT(most, 100) << "near the panel; no more than below it";
    EXPECT_LT(most, 300 * kPi);
    for (const float none : io::read_exr(folder / "l.exr", {}, "lamps").rgb) ASSERT_EQ(none, 0);
    const auto json = nlohmann::json::parse(read_text(folder / "a.json"));
    EXPECT_EQ(json["paths"], 64);
    EXPECT_GT(json["mean_illuminance_lx"]["emitters"], 1);
    EXPECT_GT(json["median_relative_standard_error"], 0);
}

TEST_F(ExactProgram, InspectRefusesWhatHasNoMeaning) {
    expect_refused("inspect a.gltf --camera eye", {"only beside --light"});
    expect_refused("inspect a.gltf --size 4x4", {"only beside --light"});
    expect_refused("inspect a.gltf --light l --at 0,0,0", {"ask for one of them"});
    expect_refused("inspect a.gltf --light l --normal 0,1,0", {"only beside --at"});
    expect_refused("inspect a.gltf --light l --camera none", {"none"});
    expect_refused("inspect a.gltf --light l --size 4", {"4"});
    expect_refused("inspect a.gltf --light none/l --size 4x4", {"none/l"});
    expect_refused("inspect " VESPER_SOURCE_DIR "/data/road/luminaire.ldt --light l", {"--light is for scenes"});
    EXPECT_FALSE(exists("l.exr"));
}

}  // namespace
}  // namespace vesper::test::exact_light_test
