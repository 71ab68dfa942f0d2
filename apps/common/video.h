// Films, by a program that others wrote. SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <span>
#include <string>

#include "vision/display.h"

namespace vesper {

/// Pipes frames to the program `ffmpeg`, which encodes them to a file of its own beside the target. finish() puts that
/// in place; without it nothing is left behind. No shell is involved.
class Video {
public:
    /// Throws Error if there is no ffmpeg, or the size cannot be a film's.
    Video(std::string file, uint32_t width, uint32_t height, double frames_per_second, const Display& display);
    ~Video();
    Video(const Video&) = delete;
    Video& operator=(const Video&) = delete;

    /// Codes as ToneMapped::display holds them. Throws Error with what ffmpeg said.
    void add(std::span<const uint8_t> codes);
    /// Waits for ffmpeg and replaces the target. Throws Error with what ffmpeg said.
    void finish();

private:
    [[noreturn]] void fail();
    int wait();

    std::string file_, temporary_, log_;
    size_t frame_bytes_;
    int pipe_ = -1;
    pid_t process_ = -1;
};

}  // namespace vesper
