// A check in a process of its own, for calls that may end it. SPDX-License-Identifier: MIT
#pragma once

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <functional>
#include <optional>

namespace vesper::test {

/// How often reading a glTF file may end the process where an allocation fails. tinygltf frees its JSON in the
/// destructor of nlohmann::json, which takes memory for that and cannot report that there is none.
constexpr size_t kMostEnds = 4;

/// The result of `check` in a child process, 0 to 255; nothing where abort() ended it.
inline std::optional<int> in_child(const std::function<int()>& check) {
    const pid_t child = fork();
    if (child == 0) {
        const rlimit none{0, 0};
        setrlimit(RLIMIT_CORE, &none);
        dup2(open("/dev/null", O_WRONLY), STDERR_FILENO);
        _exit(check());
    }
    int status = 0;
    waitpid(child, &status, 0);
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGABRT) return std::nullopt;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 255;
}

}  // namespace vesper::test
