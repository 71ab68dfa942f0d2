#include "video.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <vector>

#include "arguments.h"
#include "base/error.h"
#include "io/atomic_file.h"

extern char** environ;

namespace vesper {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> command_line(const std::string& to, uint32_t width, uint32_t height, double fps,
                                      const Display& display) {
    const bool wide = display.bits == 10, pq = display.eotf == Eotf::Pq;
    std::vector<std::string> words{"ffmpeg",
                                   "-hide_banner",
                                   "-loglevel",
                                   "error",
                                   "-xerror",
                                   "-y",  // without -xerror a film that the disk has no room to end is a success
                                   "-f",
                                   "rawvideo",
                                   "-pixel_format",
                                   wide ? "x2bgr10le" : "rgba",
                                   "-video_size",
                                   format("%ux%u", width, height),
                                   "-framerate",
                                   format("%.9g", fps),
                                   "-i",
                                   "-"};
    // Colours are halved: sides must be even, so a black column or row is added where they are not.
    std::string filter = format("pad=%u:%u:0:0:black", width + width % 2, height + height % 2);
    filter += pq ? ",scale=out_color_matrix=bt2020:out_range=tv" : ",scale=out_color_matrix=bt709:out_range=tv";
    const auto add = [&](std::initializer_list<const char*> more) {
        words.insert(words.end(), more.begin(), more.end());
    };
    add({"-vf", filter.c_str(), "-c:v", wide ? "libx265" : "libx264", "-crf", "14", "-preset", "medium", "-pix_fmt",
         wide ? "yuv420p10le" : "yuv420p"});
    if (wide) add({"-x265-params", "log-level=error", "-tag:v", "hvc1"});
    add({"-color_primaries", display.primaries == kRec2020     ? "bt2020"
                             : display.primaries == kDisplayP3 ? "smpte432"
                                                               : "bt709"});
    add({"-color_trc", pq ? "smpte2084" : "iec61966-2-1", "-colorspace", pq ? "bt2020nc" : "bt709", "-color_range",
         "tv"});
    add({"-movflags", "+faststart", "-f", "mp4", to.c_str()});
    return words;
}

}  // namespace

Video::Video(std::string file, uint32_t width, uint32_t height, double fps, const Display& display)
    : file_(std::move(file)), frame_bytes_(size_t{4} * width * height) {
    if (width > 8192 || height > 8192) throw Error(one_line(file_) + ": a film has at most 8192 x 8192 px");
    const fs::path folder = fs::path(file_).parent_path();
    const std::string stem = ".vesper-" + std::to_string(::getpid()) + "-film";
    temporary_ = (folder / (stem + ".tmp")).string();
    log_ = (folder / (stem + ".log")).string();
    std::signal(SIGPIPE, SIG_IGN);  // an ffmpeg that gives up is an error to report, not to die of

    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw Error(one_line(file_) + ": no pipe to ffmpeg: " + std::strerror(errno));
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, log_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    std::vector<std::string> words = command_line(temporary_, width, height, fps, display);
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    const int code = ::posix_spawnp(&process_, "ffmpeg", &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    ::close(ends[0]);
    pipe_ = ends[1];
    if (code == 0) return;
    process_ = -1;
    ::close(pipe_);
    ::unlink(log_.c_str());
    throw Error(one_line(file_) + (code == ENOENT ? ": the program ffmpeg, which encodes films, is not installed"
                                                  : std::string(": ffmpeg cannot be started: ") + std::strerror(code)));
}

Video::~Video() {
    if (process_ > 0) {
        ::kill(process_, SIGTERM);
        wait();
    }
    ::unlink(temporary_.c_str());
    ::unlink(log_.c_str());
}

int Video::wait() {
    if (pipe_ >= 0) ::close(pipe_);
    pipe_ = -1;
    int status = -1;
    if (process_ > 0)
        while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
        }
    process_ = -1;
    return status;
}

void Video::fail() {
    wait();
    std::string said = "it ended early";
    try {
        const auto bytes = read_file(log_, 1u << 20);
        if (!bytes.empty()) said.assign(bytes.begin(), std::find(bytes.begin(), bytes.end(), '\n'));
    } catch (const Error&) {
        // It said nothing.
    }
    throw Error(one_line(file_) + ": ffmpeg: " + one_line(said));
}

void Video::add(std::span<const uint8_t> codes) {
    if (codes.size() != frame_bytes_) throw Error(one_line(file_) + ": all pictures of a film must have one size");
    while (!codes.empty()) {
        const ssize_t written = ::write(pipe_, codes.data(), codes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail();
        codes = codes.subspan(size_t(written));
    }
}

void Video::finish() {
    const int status = wait();
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) fail();
    if (::rename(temporary_.c_str(), file_.c_str()) != 0)
        throw Error(one_line(file_) + ": cannot be written: " + std::strerror(errno));
}

}  // namespace vesper
