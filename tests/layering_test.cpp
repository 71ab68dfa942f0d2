// The shape of the source tree: who may include whom, and that every pass has its reference and its test.
// SPDX-License-Identifier: MIT
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "places.h"

namespace {

namespace fs = std::filesystem;
const fs::path kSource = VESPER_SOURCE_DIR;
const std::regex kInclude(R"re((?:^|\n)[ \t]*#[ \t]*include[ \t]*"([^"]+)")re");

// What the files of each folder of engine/ may include, besides their own; "glsl" the headers
// of glsl/shared/ and the embedded shaders. Folders that do not appear here are refused, so a new one has to find its
// place.
const std::map<std::string, std::set<std::string>> kMayInclude{
    {"include", {}},  // the public interface
    {"base", {}},
    {"io", {"base"}},
    {"photometry", {"base", "io"}},
    {"vision", {"base", "io", "photometry"}},
    {"scene", {"base", "io", "photometry", "vision"}},
    {"rays", {"base", "photometry", "scene"}},
    {"transport", {"base", "photometry", "scene", "rays"}},
    {"roads", {"base", "io", "photometry", "vision", "scene", "rays"}},
    {"osi", {"base", "io", "roads"}},
    {"traffic", {"base", "io", "photometry", "vision", "scene"}},
    {"gpu", {"base"}},
    {"window", {"base", "gpu", "graph", "glsl"}},
    {"graph", {"base", "gpu"}},
    {"eye", {"base", "vision", "gpu", "glsl"}},
    {"gpu_scene", {"base", "photometry", "vision", "scene", "rays", "transport", "gpu", "glsl"}},
    {"render", {"base", "photometry", "vision", "scene", "transport", "gpu", "graph", "eye", "gpu_scene", "glsl"}},
    {"analysis", {"base", "io", "photometry", "vision", "gpu", "graph", "eye", "gpu_scene", "render"}},
    {"api",
     {"base", "io", "photometry", "vision", "scene", "transport", "gpu", "graph", "eye", "gpu_scene", "render",
      "analysis", "glsl"}},
};

std::string text_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::string> quoted_includes(const fs::path& file) {
    const std::string text = text_of(file);
    std::vector<std::string> found;
    for (std::sregex_iterator it(text.begin(), text.end(), kInclude), end; it != end; ++it) found.push_back((*it)[1]);
    return found;
}

std::string first_folder(const fs::path& relative) {
    return relative.has_parent_path() ? relative.begin()->string() : std::string();
}

/// Why `from` (relative to engine/) may not include `what`; empty if it may.
std::string objection(const fs::path& from, const std::string& what) {
    const std::string folder = first_folder(from);
    if (!kMayInclude.contains(folder)) return "has no layer";
    if (what.find("..") != what.npos) return "climbs";
    const std::string top = first_folder(what);
    const bool glsl = top == "shaders" || (top == "shared" && fs::exists(kSource / "glsl" / what));
    if (!glsl && !fs::exists(kSource / "engine" / what))
        return "names a file neither in engine/ nor in glsl/ (others belong in <>)";
    const std::string layer = glsl ? "glsl" : top;
    // No header of scene knows io.
    if ((folder == "scene" || folder == "traffic") && layer == "io" && from.extension() != ".cpp")
        return "is a header of " + folder + "/";
    if (layer != folder && !kMayInclude.at(folder).contains(layer)) return "is a step up";
    return {};
}

std::vector<fs::path> files_under(const fs::path& folder, const std::set<std::string>& extensions) {
    std::vector<fs::path> files;
    if (!fs::exists(folder)) return files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file() && extensions.contains(entry.path().extension().string()))
            files.push_back(entry.path());
    return files;
}

TEST(Layering, EveryIncludeGoesDown) {
    const auto files = files_under(kSource / "engine", {".h", ".cpp"});
    ASSERT_FALSE(files.empty());
    for (const fs::path& file : files)
        for (const std::string& what : quoted_includes(file)) {
            const fs::path from = fs::relative(file, kSource / "engine");
            EXPECT_EQ(objection(from, what), "") << from << " includes " << what;
        }
}

// Of the folders of vesper-drive, which others each may include; what these do not have is of the engine, of
// apps/common or of libraries.
const std::map<std::string, std::set<std::string>> kDriveMayInclude{
    {"external", {}},
    {"channels", {}},
    {"session", {"external", "channels"}},
    {"record", {"external", "channels", "session"}},
    {"run", {"external", "channels", "session", "record"}},
    {"window", {"external", "channels", "session", "record", "run"}},
};

TEST(Layering, EveryIncludeOfTheSimulatorGoesDown) {
    const fs::path drive = kSource / "apps" / "vesper-drive";
    const auto files = files_under(drive, {".h", ".cpp"});
    EXPECT_GT(files.size(), 70u);
    for (const fs::path& file : files) {
        const std::string folder = first_folder(fs::relative(file, drive));
        if (file == drive / "main.cpp") continue;
        ASSERT_TRUE(kDriveMayInclude.contains(folder)) << file;
        for (const std::string& what : quoted_includes(file)) {
            const bool goes_down = !fs::exists(drive / what) || first_folder(what) == folder ||
                                   kDriveMayInclude.at(folder).contains(first_folder(what));
            EXPECT_TRUE(goes_down) << file << " includes " << what;
        }
    }
}

TEST(Layering, TheRulesRefuse) {
    EXPECT_NE(objection("base/error.h", "graph/plan.h"), "");
    EXPECT_NE(objection("gpu/kernel.h", "scene/scene.h"), "");
    EXPECT_NE(objection("gpu/kernel.h", "graph/plan.h"), "");
    EXPECT_NE(objection("scene/scene.h", "io/image_file.h"), "");
    EXPECT_NE(objection("io/image_file.h", "scene/convert.h"), "");
    EXPECT_NE(objection("gpu_scene/view.cpp", "roads/road_layout.h"), "") << "is no part of the renderer";
    EXPECT_NE(objection("render/passes/a.cpp", "io/image_file.h"), "");
    EXPECT_NE(objection("graph/plan.h", "../gpu/kernel.h"), "");
    EXPECT_NE(objection("elsewhere/a.cpp", "base/error.h"), "");
    EXPECT_EQ(objection("scene/gltf.cpp", "io/image_file.h"), "");
    EXPECT_NE(objection("io/image_file.h", "scene/scene.h"), "");
    EXPECT_EQ(objection("render/passes/a.cpp", "graph/plan.h"), "");
    EXPECT_EQ(objection("api/a.cpp", "io/image_file.h"), "");
    EXPECT_NE(objection("render/passes/a.cpp", "analysis/visual_channels.h"), "") << "no frame needs it";
    EXPECT_NE(objection("renderer.cpp", "io/image_file.h"), "") << "has no layer";
}

/// The files that a pass of this name lacks; those of shadows are together in folders of this name.
std::vector<std::string> missing_of(const std::string& pass, bool of_shadows = false) {
    const std::string code = of_shadows ? "engine/render/shadows/" : "engine/render/passes/",
                      test = of_shadows ? "tests/passes/shadows/" : "tests/passes/";
    const fs::path files[]{code + pass + ".h",
                           code + pass + ".cpp",
                           of_shadows ? "glsl/shadows" : "glsl/" + pass,
                           test + pass + "_reference.h",
                           test + pass + "_reference_test.cpp",
                           test + pass + "_test.cpp"};
    std::vector<std::string> missing;
    for (const fs::path& file : files)
        if (!fs::exists(kSource / file)) missing.push_back(file.string());
    return missing;
}

// A pass has a header, a source, a shader folder, a reference and tests under one name, and declares itself there.
TEST(Layering, EveryPassHasItsFilesUnderOneName) {
    EXPECT_EQ(missing_of("no_such_pass").size(), 6u);
    size_t passes = 0;
    for (const fs::path& file : files_under(kSource / "engine" / "render" / "passes", {".h", ".cpp"})) {
        const std::string pass = file.stem().string();
        if (pass == "operators") continue;  // the table of the tone operators
        EXPECT_EQ(missing_of(pass), std::vector<std::string>()) << pass;
        if (file.extension() != ".cpp") continue;
        const std::string text = text_of(file);
        EXPECT_TRUE(text.find(".dispatch(") != text.npos || text.find(".raster(") != text.npos)
            << pass << " declares no pass";
        ++passes;
    }
    EXPECT_GT(passes, 15u);
}

TEST(Layering, EveryPassOfShadowsHasItsReference) {
    EXPECT_EQ(missing_of("no_such_pass", true).size(), 5u);
    const std::set<std::string> parts{"caster_triangles"};  // of draw_shadow_maps
    size_t passes = 0;
    for (const fs::path& file : files_under(kSource / "engine" / "render" / "shadows", {".cpp"})) {
        const std::string pass = file.stem().string(), text = text_of(file);
        if (parts.contains(pass) || (text.find(".dispatch(") == text.npos && text.find(".raster(") == text.npos))
            continue;
        EXPECT_EQ(missing_of(pass, true), std::vector<std::string>()) << pass;
        ++passes;
    }
    EXPECT_EQ(passes, 5u);
}

// A folder of shaders belongs to the pass of its name; the other folders are listed here.
TEST(Layering, EveryShaderIsInTheFolderOfItsPass) {
    const std::set<std::string> others{"shadows", "window"};
    for (const fs::path& file : files_under(kSource / "glsl", {".comp", ".vert", ".frag"})) {
        const std::string folder = first_folder(fs::relative(file, kSource / "glsl"));
        EXPECT_TRUE(others.contains(folder) || missing_of(folder).empty()) << file;
    }
}

TEST(Layering, EveryTestOfAPassHasAReference) {
    const std::string test = "_test", reference = "_reference";
    for (const fs::path& file : files_under(kSource / "tests" / "passes", {".cpp"})) {
        std::string stem = file.stem().string();
        if (!stem.ends_with(test)) continue;
        stem.resize(stem.size() - test.size());
        if (file.parent_path().filename() == "operators") continue;  // an operator's test holds its reference
        if (file.parent_path().filename() == "chain") continue;      // those of several passes, one after the other
        // A reference is itself tested against the literature.
        if (stem.ends_with(reference)) stem.resize(stem.size() - reference.size());
        EXPECT_TRUE(fs::exists(file.parent_path() / (stem + "_reference.h"))) << file;
    }
}

// A shader that includes texels.glsl is embedded twice (cmake/Functions.cmake): code uses NAME_storage of these
// shaders.
TEST(Layering, VariantsForShortTexelBuffersAreUsed) {
    const std::string ending = "_storage";
    std::set<std::string> used;
    for (const fs::path& file : files_under(kSource / "engine", {".cpp"})) {
        const std::string text = text_of(file);
        for (size_t at = text.find(ending); at != text.npos; at = text.find(ending, at + 1)) {
            size_t first = at;
            while (first > 0 && (std::isalnum(static_cast<unsigned char>(text[first - 1])) || text[first - 1] == '_'))
                --first;
            used.insert(text.substr(first, at - first));
        }
    }
    size_t twice = 0;
    for (const fs::path& file : files_under(kSource / "glsl", {".comp", ".vert", ".frag"})) {
        const std::string array = file.stem().string() + "_" + file.extension().string().substr(1);
        const bool has_texels = text_of(file).find("#include \"texels.glsl\"") != std::string::npos;
        EXPECT_EQ(used.contains(array), has_texels) << file;
        twice += has_texels;
    }
    EXPECT_GT(twice, 15u);
}

// The calls of an operator's functions are compiled where its shader defines the name of the function in capitals.
TEST(Layering, OperatorsDefineTheNamesOfTheirFunctions) {
    size_t defined = 0;
    for (const fs::path& file : files_under(kSource / "glsl" / "operators", {".glsl"}))
        for (const std::string kind : {"seen", "mapped", "rgb"}) {
            const std::string text = text_of(file), name = file.stem().string() + "_" + kind;
            std::string capitals = name;
            for (char& letter : capitals) letter = char(std::toupper(letter));
            const bool defines = text.find("#define " + capitals + "\n") != std::string::npos;
            EXPECT_EQ(text.find(" " + name + "(") != std::string::npos, defines) << file << ": " << capitals;
            defined += defines;
        }
    EXPECT_GT(defined, 5u);
}

/// Why a file with this text is not in the namespace of its module; empty if it is.
std::string objection_to_namespace(const std::string& text, const std::string& module) {
    const auto has = [&](const std::string& line) { return std::regex_search(text, std::regex("(?:^|\\n)" + line)); };
    if (has("namespace vesper \\{")) return "opens vesper itself";
    if (has("using namespace ")) return "has a using-directive";
    if (!has("namespace vesper::" + module + "(?:::\\w+)* \\{")) return "does not open vesper::" + module;
    return {};
}

// Names in vesper itself are those of base/; functions and types of other modules are found by their namespace.
TEST(Layering, EveryFileIsInTheNamespaceOfItsModule) {
    EXPECT_EQ(objection_to_namespace("// A\nnamespace vesper::io {", "io"), "");
    EXPECT_EQ(objection_to_namespace("namespace vesper::gpu {\nclass D;\n}\nnamespace vesper::io::hdr {", "io"), "");
    EXPECT_NE(objection_to_namespace("namespace vesper::io {\n}\nnamespace vesper {", "io"), "");
    EXPECT_NE(objection_to_namespace("using namespace vesper::gpu;\nnamespace vesper::io {", "io"), "");
    EXPECT_NE(objection_to_namespace("namespace vesper::ion {", "io"), "");
    std::map<fs::path, std::string> modules{{"apps/common", "apps"},
                                            {"apps/vesper", "commands"},
                                            {"apps/vesper-drive", "drive"},
                                            {"apps/vesper-bench", "bench"}};
    for (const auto& [folder, layers] : kMayInclude)
        if (folder != "include" && folder != "base") modules.emplace("engine/" + folder, folder);
    const std::set<std::string> without{"main.cpp", "tinygltf.h", "tinygltf.cpp"};  // they declare nothing of ours
    size_t files = 0;
    for (const auto& [folder, module] : modules)
        for (const fs::path& file : files_under(kSource / folder, {".h", ".cpp"})) {
            if (without.contains(file.filename().string())) continue;
            EXPECT_EQ(objection_to_namespace(text_of(file), module), "") << file;
            ++files;
        }
    EXPECT_GT(files, 300u);
}

// Hosts set locales (Qt does), and then these take and write a comma for the decimal point, or know no i of other
// letters: base/decimal.h, base/lower.h and std::from_chars instead.
TEST(Layering, NothingFollowsTheLocaleOfTheHost) {
    const std::regex follows(
        R"re(\b(strtof|strtol?d|atof|stof|stol?d|toupper|tolower|[a-z]*stringstream)\s*[({ ]|scanf\([^;]*%[0-9]*l?[efg]|printf\([^;]*%[-+#0-9.]*[efgEFG])re");
    for (const auto& entry : fs::recursive_directory_iterator(kSource / "engine")) {
        const std::string text = entry.is_regular_file() ? text_of(entry.path()) : std::string();
        std::smatch found;
        EXPECT_FALSE(std::regex_search(text, found, follows)) << entry.path() << ": " << found.str().substr(0, 60);
    }
}

}  // namespace
