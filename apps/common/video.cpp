#include "video.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "base/error.h"
#include "base/one_line.h"
#include "io/descriptor.h"
#include "print.h"

extern char** environ;

namespace vesper::apps {
namespace {

constexpr const char* kThreads = "4";           // of its own, or films would depend on how many processors there are
constexpr std::chrono::milliseconds kLook{10};  // between looks at ffmpeg while it is waited for
constexpr int kFilm = 3;                        // the descriptor of the film in ffmpeg

std::vector<std::string> command_line(uint32_t width, uint32_t height, double fps, const vision::Display& display,
                                      const std::string& comment) {
    const bool wide = display.bits == 10, pq = display.eotf == vision::Eotf::Pq;
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
    add({"-vf", filter.c_str(), "-c:v", wide ? "libx265" : "libx264", "-crf", "14", "-threads", kThreads, "-preset",
         "medium", "-pix_fmt", wide ? "yuv420p10le" : "yuv420p"});
    if (wide) add({"-x265-params", "log-level=error", "-tag:v", "hvc1"});
    add({"-color_primaries", display.primaries == io::kRec2020     ? "bt2020"
                             : display.primaries == io::kDisplayP3 ? "smpte432"
                                                                   : "bt709"});
    add({"-color_trc", pq ? "smpte2084" : "iec61966-2-1", "-colorspace", pq ? "bt2020nc" : "bt709", "-color_range",
         "tv"});
    const std::string film = "file:/proc/self/fd/" + std::to_string(kFilm);  // it is opened twice, for +faststart
    if (!comment.empty()) add({"-metadata", ("comment=" + comment).c_str()});
    add({"-movflags", "+faststart", "-f", "mp4", film.c_str()});
    return words;
}

}  // namespace

Video::Video(std::string file, uint32_t width, uint32_t height, double fps, const vision::Display& display,
             const std::string& comment)
    : file_(std::move(file)),
      film_(file_),
      log_(::memfd_create("ffmpeg", MFD_CLOEXEC)),
      frame_bytes_(size_t{4} * width * height) {
    if (width > 8192 || height > 8192) throw Error(one_line(file_) + ": a film has at most 8192 x 8192 px");
    std::signal(SIGPIPE, SIG_IGN);  // an ffmpeg that gives up is an error to report, not to die of

    int ends[2];
    if (!log_.is_open() || ::pipe2(ends, O_CLOEXEC) != 0) io::fail(file_, "no pipe to ffmpeg", errno);
    const io::Descriptor frames(ends[0]);
    pipe_ = io::Descriptor(ends[1]);
    ::fcntl(pipe_.number(), F_SETFL, O_NONBLOCK);  // of this end alone: a stopped ffmpeg is not waited for
    // Copies above the numbers that ffmpeg will see, so that none of those is replaced before it is copied.
    const auto copied = [](int number) { return io::Descriptor(::fcntl(number, F_DUPFD_CLOEXEC, kFilm + 1)); };
    const io::Descriptor in = copied(frames.number()), out = copied(film_.descriptor().number()),
                         log = copied(log_.number());
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, in.number(), STDIN_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, log.number(), STDERR_FILENO);
    posix_spawn_file_actions_adddup2(&actions, out.number(), kFilm);
    std::vector<std::string> words = command_line(width, height, fps, display, comment);
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    const int code = ::posix_spawnp(&process_, "ffmpeg", &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (code == 0) return;
    process_ = -1;
    throw Error(one_line(file_) + (code == ENOENT ? ": the program ffmpeg, which encodes films, is not installed"
                                                  : std::string(": ffmpeg cannot be started: ") + std::strerror(code)));
}

Video::~Video() {
    if (process_ <= 0) return;
    ::kill(process_, SIGKILL);  // also where it is stopped: its film is not kept
    while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) continue;
}

/// Looks at ffmpeg. Throws Error, and ends it, where it has been stopped for too long.
bool Video::has_ended() {
    if (process_ <= 0) return true;
    int status = -1;
    const pid_t changed = ::waitpid(process_, &status, WNOHANG | WUNTRACED | WCONTINUED);
    if (changed < 0 && errno != EINTR) process_ = -1;
    if (changed > 0) {
        if (WIFSTOPPED(status))
            stopped_ = std::chrono::steady_clock::now();
        else if (WIFCONTINUED(status))
            stopped_.reset();
        else
            status_ = status, process_ = -1;
    }
    if (process_ > 0 && stopped_ && std::chrono::steady_clock::now() - *stopped_ > longest_stop)
        throw Error(one_line(file_) + format(": ffmpeg was stopped by a signal and has not gone on for %.3g s",
                                             std::chrono::duration<double>(longest_stop).count()));
    return process_ <= 0;
}

int Video::wait() {
    pipe_.close();
    while (!has_ended()) std::this_thread::sleep_for(kLook);
    return status_;
}

/// Writes to ffmpeg, which may be slow. Returns 0 or the error code.
int Video::write(std::span<const uint8_t> codes) {
    while (!codes.empty()) {
        const ssize_t written = ::write(pipe_.number(), codes.data(), codes.size());
        if (written >= 0) {
            codes = codes.subspan(size_t(written));
        } else if (errno == EAGAIN) {
            pollfd room{.fd = pipe_.number(), .events = POLLOUT, .revents = 0};
            if (::poll(&room, 1, int(kLook.count())) == 0 && has_ended()) return EPIPE;
        } else if (errno != EINTR) {
            return errno;
        }
    }
    return 0;
}

void Video::give_up() {
    wait();
    char said[1024];
    const ssize_t size = ::pread(log_.number(), said, sizeof said, 0);
    const std::string text(said, size_t(std::max<ssize_t>(0, size)));
    throw Error(one_line(file_) +
                ": ffmpeg: " + (text.empty() ? "it ended early" : one_line(text.substr(0, text.find('\n')))));
}

void Video::add(std::span<const uint8_t> codes) {
    if (codes.size() != frame_bytes_) throw Error(one_line(file_) + ": all pictures of a film must have one size");
    if (write(codes) != 0) give_up();
}

void Video::finish() {
    const int status = wait();
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) give_up();
    film_.commit();
}

}  // namespace vesper::apps
