// Scene files of other programs are named, whatever their names end in. SPDX-License-Identifier: MIT
#include <string>

#include "scene/scene_files.h"

namespace vesper::test {
namespace {

using namespace std::string_literals;

std::string refused(const std::string& name, const std::string& bytes) {
    const TempFolder folder;
    const auto file = folder.write(name, bytes);
    const std::string said = complaint_of([&] { scene::read_scene(file); });
    EXPECT_TRUE(contains(said, name)) << said;
    EXPECT_FALSE(contains(said, "JSON")) << said;
    EXPECT_EQ(said.find('\n'), std::string::npos);
    return said;
}

TEST(OtherFormats, AreNamedByTheirBytes) {
    std::string stl(84 + 2 * 50, 'x');
    stl.replace(80, 4, "\2\0\0\0"s);
    const std::string head3ds = "MM\x10\0\0\0\2\0\x0a\0\0\0\3\0\0\0"s;
    const std::string zip = "PK\3\4\x0a\0\0\0\0\0\0\0\0\0"s + std::string(12, '\0');
    const std::string flt = "\0\1\1\x44"s + "db\0\0\0\0\0\0"s + "\0\0\6\x0e"s + std::string(300, '\0');
    const struct {
        const char* name;
        std::string bytes;
    } kFiles[] = {
        {"is an FBX file", "Kaydara FBX Binary  \0\x1a\0\xe8\x1c\0\0"s},
        {"is an FBX file", "; FBX 7.3.0 project file\n; ----\nFBXHeaderExtension:  {\n"},
        {"is an FBX file", ";comment\r\n\r\nFBXHeaderExtension:  {\r\n"},
        {"is a Blender file", "BLENDER-v300REND"},
        {"is a USD file", "#usda 1.0\ndef Xform \"a\" {}\n"},
        {"is a USD file", "PXR-USDC\0\x08\0\0"s},
        {"is a USD file", zip + "\x0a\0\0\0"s + "scene.usdc"},
        {"is an OpenFlight file", flt},
        {"is an OpenSceneGraph file", "\xa1\x0e\x91\x6c\x45\x45\xfb\x1a\1\0\0\0"s},
        {"is an OpenSceneGraph file", "#Ascii Scene\n#Version 161\n"},
        {"is an OpenSceneGraph file", "\4\3\2\1\x1d\0\0\0"s},
        {"is a 3DS file", head3ds},
        {"is a Collada file", "<?xml version=\"1.0\"?>\n<COLLADA xmlns=\"x\">"},
        {"is a PLY file", "ply\nformat ascii 1.0\n"},
        {"is a PLY file", "ply\r\nformat binary_little_endian 1.0\r\n"},
        {"is an STL file", "solid cube\n facet normal 0 0 1\n"},
        {"is an STL file", stl},
        {"is a Wavefront OBJ file", "# made by hand\n\nmtllib a.mtl\nv 0 0 0\n"},
        {"is a Wavefront OBJ file", "\xef\xbb\xbfv 0 0 0\r\nv 1 0 0\r\n"},
        {"is a Wavefront OBJ file", "o thing\nv 0 0 0\n"},
        {"is an OpenDRIVE file", "<?xml version=\"1.0\"?><OpenDRIVE></OpenDRIVE>"},
        {"is a compressed file", "\x28\xb5\x2f\xfd\x04\x58\1"s},
        {"is a compressed file", "\x1f\x8b\x08\0\0\0"s},
        {"is a ZIP archive", zip + "\x05\0\0\0"s + "a.txt"},
        {"picture of type image/png", "\x89PNG\r\n\x1a\n"},
    };
    for (const auto& file : kFiles)
        for (const char* name : {"scene.gltf", "scene.glb", "scene.xyz", "scene"}) {
            const std::string said = refused(name, file.bytes);
            EXPECT_TRUE(contains(said, file.name)) << said;
            if (contains(file.name, "FBX") || contains(file.name, "OBJ")) {
                EXPECT_TRUE(contains(said, "export it: File > Export > glTF 2.0")) << said;
            }
        }
    for (const std::string& packed : {"\x28\xb5\x2f\xfd\x04\x58\1"s, "\x1f\x8b\x08\0\0\0"s})
        EXPECT_TRUE(contains(refused("a.BLEND", packed), "is a Blender file"));
    EXPECT_TRUE(contains(refused("a.obj", "# nothing but words\n"), "is a Wavefront OBJ file"));
}

// A scene is one whatever its name ends in, and text of no format is not taken for one.
TEST(OtherFormats, ScenesAndOtherTextsAreNone) {
    const TempFolder folder;
    EXPECT_EQ(complaint_of([&] { scene::read_scene(folder.write("a.obj", GltfFile().text())); }), "");
    for (const char* text : {"words that say nothing\n", "v", "#", "valid: yes\n", "plywood\n", "solidarity\n", "MM"})
        EXPECT_TRUE(contains(complaint_of([&] { scene::read_scene(folder.write("a.txt", text)); }), "is no scene"))
            << text;
}

}  // namespace
}  // namespace vesper::test
