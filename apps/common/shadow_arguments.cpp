#include "shadow_arguments.h"

#include <cstdlib>
#include <filesystem>

#include "io/cache_folder.h"
#include "print.h"

namespace vesper::apps {
namespace {

constexpr const char* kOff = "off";

std::string variable(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

// Relative paths are to be ignored (XDG Base Directory Specification).
std::string user_folder() {
    for (const std::filesystem::path& caches :
         {std::filesystem::path(variable("XDG_CACHE_HOME")), std::filesystem::path(variable("HOME")) / ".cache"})
        if (caches.is_absolute()) return (caches / "vesper/shadows").string();
    return kOff;
}

}  // namespace

void add_shadow_options(Command command, ShadowArguments& a, const std::string& budget_default,
                        const std::string& cache_default) {
    command.add_option("--shadows", a.shadows, "on: lamps light only what they see; off: they shine through everything")
        .check(one_of({"on", kOff}))
        .shows_default();
    command
        .add_option("--shadow-budget", a.budget,
                    "Tiles of distance maps (64 x 64 texels) that are drawn for a frame where lamps or bodies move; "
                    "what is left is out of date in it\nDefault: " +
                        budget_default)
        .check({[](const std::string& text) {
                    const bool number = !text.empty() && text.find_first_not_of("0123456789") == text.npos;
                    return number
                               ? ""
                               : "a number of tiles is expected, 0 or more, not " + (text.empty() ? "nothing" : text);
                },
                "TILES"});
    command
        .add_option("--shadow-cache", a.cache,
                    "Folder that keeps shadows and light between surfaces that stand still for later runs, at most 1 "
                    "GiB; off: none\n"
                    "Default: " +
                        cache_default)
        .check({[](const std::string& text) {
                    return text.empty() ? std::string("a folder or off is expected") : std::string();
                },
                "DIR|off"});
}

void set_shadows(const ShadowArguments& a, render::RenderSettings& settings) {
    settings.shadows = a.shadows == "on", settings.shadow_budget = a.budget;
}

std::shared_ptr<Cache> shadow_cache(const std::string& asked) {
    std::string folder = asked.empty() ? variable("VESPER_SHADOW_CACHE") : asked;
    if (folder.empty()) folder = user_folder();
    return folder == kOff ? nullptr : std::make_shared<io::CacheFolder>(folder);
}

void print_cache_note(const std::string& problem) {
    if (!problem.empty()) print_note("shadows and light are not kept for later runs (--shadow-cache): " + problem);
}

}  // namespace vesper::apps
