// Films, by a program that others wrote. SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "io/new_file.h"
#include "vision/display.h"

namespace vesper::apps {

/// Pipes frames to the program `ffmpeg`, which encodes them into a NewFile by its descriptor: it is given no name of a
/// file. finish() puts the film in place; without it nothing is left behind. No shell is involved. An ffmpeg that some
/// signal has stopped is ended after `longest_stop`, with an Error.
class Video {
public:
    std::chrono::milliseconds longest_stop{30'000};

    /// Throws Error if there is no ffmpeg, or the size cannot be a film's.
    /// `comment`: what the film says of itself.
    Video(std::string file, uint32_t width, uint32_t height, double frames_per_second, const vision::Display& display,
          const std::string& comment = {});
    ~Video();
    Video(const Video&) = delete;
    Video& operator=(const Video&) = delete;

    /// Codes as ToneMapped::display holds them. Throws Error with what ffmpeg said.
    void add(std::span<const uint8_t> codes);
    /// Waits for ffmpeg and replaces the target. Throws Error with what ffmpeg said.
    void finish();

private:
    [[noreturn]] void give_up();
    int wait();
    bool has_ended();
    int write(std::span<const uint8_t> codes);

    std::string file_;
    io::NewFile film_;
    io::Descriptor log_, pipe_;
    size_t frame_bytes_;
    pid_t process_ = -1;  ///< -1: none, or it has ended with `status_`
    int status_ = -1;
    std::optional<std::chrono::steady_clock::time_point> stopped_;  ///< since when
};

}  // namespace vesper::apps
