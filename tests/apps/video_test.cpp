// Films, where ffmpeg does not do its work. SPDX-License-Identifier: MIT
#include "video.h"

#include <cstdlib>

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/complaints.h"
#include "support/temp_folder.h"

namespace vesper::test {
namespace {

/// A program in place of ffmpeg for as long as this lives.
struct OtherFfmpeg {
    const TempFolder folder;
    const std::string path = std::getenv("PATH");

    explicit OtherFfmpeg(const std::string& script) {
        const auto program = folder.write("ffmpeg", "#!/bin/sh\n" + script + "\n");
        std::filesystem::permissions(program, std::filesystem::perms::owner_all);
        ::setenv("PATH", (folder.path().string() + ":" + path).c_str(), 1);
    }
    ~OtherFfmpeg() { ::setenv("PATH", path.c_str(), 1); }

    /// Five pictures of 256 KiB are more than a pipe holds; none are added where `pictures` is 0.
    std::string film(int pictures, int longest_stop_ms = 30'000) const {
        return complaint_of([&] {
            apps::Video video((folder / "film.mp4").string(), 256, 256, 25, vision::Display());
            video.longest_stop = std::chrono::milliseconds(longest_stop_ms);
            const std::vector<uint8_t> codes(256 * 256 * 4);
            for (int i = 0; i < pictures; ++i) video.add(codes);
            video.finish();
        });
    }
};

TEST(Video, AStoppedFfmpegIsGivenUp) {
    const OtherFfmpeg stopped("kill -STOP $$");
    for (const int pictures : {5, 0})
        EXPECT_TRUE(contains(stopped.film(pictures, 50),
                             "film.mp4: ffmpeg was stopped by a signal and has not gone on for 0.05 s"));
    EXPECT_FALSE(std::filesystem::exists(stopped.folder / "film.mp4"));
}

TEST(Video, AnFfmpegThatGoesOnOrIsSlowIsWaitedFor) {
    EXPECT_EQ(OtherFfmpeg("sleep 0.2; cat >/dev/null").film(5), "");
    EXPECT_EQ(OtherFfmpeg("(sleep 0.01; kill -CONT $$) & kill -STOP $$; cat >/dev/null; sleep 0.2").film(5), "");
}

TEST(Video, AnFfmpegThatEndsEarlySaysWhy) {
    EXPECT_TRUE(contains(OtherFfmpeg("echo no room >&2; exit 1").film(5), "film.mp4: ffmpeg: no room"));
    EXPECT_TRUE(contains(OtherFfmpeg("exit 3").film(0), "film.mp4: ffmpeg: it ended early"));
}

}  // namespace
}  // namespace vesper::test
