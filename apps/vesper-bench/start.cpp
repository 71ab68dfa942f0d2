#include "start.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <tuple>

#include "base/error.h"
#include "base/stopwatch.h"

namespace vesper::bench {
namespace {

using Work = std::function<void(const std::function<void()>&)>;

/// The life of the fresh process: writes "+" for the first frame, or why there was none.
[[noreturn]] void live(int out, const std::string& folder, const Work& work) {
    for (const char* variable :
         {"MESA_SHADER_CACHE_DIR", "MESA_GLSL_CACHE_DIR", "__GL_SHADER_DISK_CACHE_PATH", "XDG_CACHE_HOME"})
        setenv(variable, folder.c_str(), 1);
    const auto say = [&](const std::string& text) { return write(out, text.data(), text.size()); };
    try {
        work([&] { std::ignore = say("+"); });  // a driver may write its cache when its device is closed: let it
    } catch (const std::exception& error) {
        std::ignore = say(error.what());
    }
    _exit(0);
}

double seconds_to_first_frame(const std::string& folder, const Work& work) {
    int ends[2];
    if (pipe(ends) != 0) throw Error("timing the start: no pipe");
    const Stopwatch watch;
    const pid_t child = fork();
    if (child < 0) throw Error("timing the start: no process");
    if (child == 0) {
        close(ends[0]);
        live(ends[1], folder, work);
    }
    close(ends[1]);
    std::string said;
    double milliseconds = 0;
    char buffer[512];
    for (ssize_t got; (got = read(ends[0], buffer, sizeof buffer)) > 0; said.append(buffer, size_t(got)))
        if (said.empty()) milliseconds = watch.milliseconds();
    close(ends[0]);
    waitpid(child, nullptr, 0);
    if (said != "+")
        throw Error("timing the start: " + (said.empty() ? std::string("the process ended without a frame") : said));
    return milliseconds * 1e-3;
}

}  // namespace

std::vector<Start> time_starts(const std::string& folder, const Work& work) {
    std::vector<Start> starts;
    for (const char* cache : {"cold", "warm"}) starts.push_back({cache, seconds_to_first_frame(folder, work)});
    return starts;
}

}  // namespace vesper::bench
