#include "arguments/cache_arguments.h"

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
        if (caches.is_absolute()) return (caches / "vesper").string();
    return kOff;
}

}  // namespace

void add_cache_option(Command command, std::string& asked, const std::string& default_words) {
    command
        .add_option("--cache", asked,
                    "Folder that keeps shadow maps and light between surfaces that stand still for later runs, at most "
                    "1 GiB; off: none\n"
                    "Default: " +
                        default_words)
        .check({[](const std::string& text) {
                    return text.empty() ? std::string("a folder or off is expected") : std::string();
                },
                "DIR|off"});
}

std::shared_ptr<Cache> cache_of(const std::string& asked) {
    std::string folder = asked.empty() ? variable("VESPER_CACHE") : asked;
    if (folder.empty()) folder = user_folder();
    return folder == kOff ? nullptr : std::make_shared<io::CacheFolder>(folder);
}

void print_cache_note(const std::string& problem) {
    if (!problem.empty()) print_note("shadow maps and light are not kept for later runs (--cache): " + problem);
}

}  // namespace vesper::apps
