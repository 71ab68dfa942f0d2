// A street and a photometry file, converted in a folder of their own. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "io/image_file.h"
#include "scene/convert.h"
#include "scene/scene_files.h"
#include "support/same_scene.h"

namespace vesper::test {

class ConversionTest : public testing::Test {
protected:
    /// wall.png, two pixels, and a texture of it.
    void add_wall_picture() {
        const std::vector<uint8_t> pixels = {255, 128, 0, 255, 10, 10, 10, 255};
        io::write_png(folder_ / "wall.png", 2, 1, pixels);
        street_.root["images"] = {{{"uri", "wall.png"}}};
        street_.root["textures"] = {{{"source", 0}}};
    }
    /// `photometry` needs no version. What is read back is the scene that the rules make in memory.
    scene::PhotometryReport convert_with(nlohmann::json photometry, const std::string& output = "out.gltf",
                                         const std::optional<scene::Transfer>& transfer = std::nullopt) {
        photometry["version"] = 1;
        const auto in = folder_.write("in.gltf", street_.text()), rules = folder_.write("p.json", photometry.dump());
        scene::PhotometryReport report = scene::convert(in, rules, folder_ / output, transfer);
        if (!transfer) {
            SCOPED_TRACE(photometry.dump());
            scene::PhotometryReport in_memory;
            expect_same(scene::read_lit_scene(in, rules, &in_memory).scene, converted(output));
            for (const std::string& warning : in_memory.warnings) EXPECT_TRUE(mentions(report.warnings, warning));
        }
        return report;
    }
    scene::Scene converted(const std::string& output = "out.gltf") const {
        return scene::read_scene(folder_ / output).scene;
    }

    TempFolder folder_;
    GltfFile street_;
};

}  // namespace vesper::test
