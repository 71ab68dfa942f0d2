// Disks that are full and programs that are killed: an old file stays whole, or the new one is.
// SPDX-License-Identifier: MIT
#include <sys/wait.h>
#include <unistd.h>

#include <map>
#include <set>

#include "faults/faults.h"
#include "places.h"
#include "session/drive_file.h"
#include "support/program.h"

namespace vesper::test {
namespace {

namespace fs = std::filesystem;

const std::string kOld = "what was there before";
const fs::path kData = fs::path(VESPER_SOURCE_DIR) / "data";

std::string fault(FaultKind kind, uint64_t at) {
    return "LD_PRELOAD=" VESPER_FAULTS " VESPER_FAULT='" + std::to_string(int(kind)) + " " + std::to_string(at) + " 0'";
}

/// What writes files, and which.
struct Writing {
    std::string arguments;
    std::vector<std::string> files;
};

class DiskFaults : public ProgramTest {
protected:
    std::vector<Writing> writings() {
        folder.write("empty.gltf", R"({"asset":{"version":"2.0"},"extras":{"vesper":{"version":1}}})");
        EXPECT_EQ(run("render empty.gltf --size 16x8 --frames 2 -o f%d.exr"), 0) << said;
        const std::string road = "road " + (kData / "road/worked-example.json").string();
        std::vector<Writing> all{
            {road + " --csv points.csv --json road.json", {"points.csv", "road.json"}},
            {"convert " + (kData / "rivoli/rivoli.xodr").string() + " -o lanes.glb", {"lanes.glb"}},
            {"render empty.gltf --size 16x8 -o a.png -o a.exr --log a.csv --stats-json a.json",
             {"a.png", "a.exr", "a.json"}}};
        if (run("tonemap f%d.exr -o film.mp4") == 0) all.push_back({"tonemap f%d.exr -o film.mp4", {"film.mp4"}});
        return all;
    }
    std::map<std::string, std::string> contents(const Writing& writing) const {
        std::map<std::string, std::string> all;
        for (const std::string& file : writing.files) all[file] = read_text(folder / file);
        return all;
    }
    void put_old(const Writing& writing) const {
        for (const std::string& file : writing.files) folder.write(file, kOld);
    }
    /// But for what there is of a log, which stays.
    std::set<std::string> names() const {
        std::set<std::string> found;
        for (const auto& entry : fs::directory_iterator(folder.path()))
            if (entry.path().filename() != "a.csv.part") found.insert(entry.path().filename().string());
        return found;
    }
};

TEST_F(DiskFaults, AFullDiskIsReportedAndChangesNothing) {
    for (const Writing& writing : writings()) {
        ASSERT_EQ(run(writing.arguments), 0) << said;
        size_t bytes = 0;
        for (const auto& [file, text] : contents(writing)) bytes += text.size();
        for (const size_t room : {size_t{0}, size_t{1}, bytes / 2, bytes - 1}) {
            put_old(writing);
            const std::set<std::string> before = names();
            SCOPED_TRACE(writing.arguments + ", room for " + std::to_string(room) + " of " + std::to_string(bytes) +
                         " bytes");
            expect_refused(writing.arguments, {}, fault(FaultKind::Disk, room));
            for (const auto& [file, text] : contents(writing))
                EXPECT_TRUE(text == kOld || (writing.files.size() > 1 && text.size() > kOld.size())) << file;
            EXPECT_EQ(names(), before);
        }
    }
}

TEST_F(DiskFaults, KilledAtAnyChangeOfAFile) {
    for (const Writing& writing : writings()) {
        ASSERT_EQ(run(writing.arguments), 0) << said;
        const auto made = contents(writing);
        uint64_t at = 0;
        do {
            put_old(writing);
            at += 1 + at / 2;  // ffmpeg changes its file dozens of times
            run(writing.arguments, fault(FaultKind::Kill, at));
            for (const auto& [file, text] : contents(writing))
                EXPECT_TRUE(text == kOld || text == made.at(file))
                    << writing.arguments << ", change " << at << ": " << file << " is neither old nor new";
            ASSERT_LT(at, 1000u);
        } while (contents(writing) != made);
        EXPECT_GT(at, 3u) << writing.arguments;
    }
}

// A recording grows: whenever its program is killed it can be read, with all that was done up to then but the last.
TEST_F(DiskFaults, ARecordingCanBeReadWheneverItsProgramWasKilled) {
    constexpr size_t kEvents = 6;
    const fs::path file = folder / "drive.json";
    const auto record = [&](uint64_t at) {
        const pid_t child = ::fork();
        if (child == 0) {
            if (::chdir(folder.path().c_str()) != 0) ::_exit(1);
            vesper_fault_arm(FaultKind::Kill, at, 0);
            drive::DriveRecorder recorder({.scene = "street.json", .messages = {}, .settings = {}});
            recorder.open("drive.json");
            for (size_t i = 0; i < kEvents; ++i)
                recorder.add({.kind = drive::DriveEvent::Kind::Step,
                              .input = {.steering = double(i) / kEvents},
                              .name = {},
                              .value = {}});
            recorder.close();
            ::_exit(0);
        }
        int status = 0;
        ::waitpid(child, &status, 0);
        return WIFEXITED(status) && WEXITSTATUS(status) == 0;
    };
    size_t most = 0;
    for (uint64_t at = 1; at < 1000; ++at) {
        folder.write("drive.json", kOld);
        if (record(at)) {
            EXPECT_EQ(drive::read_drive(file).events.size(), kEvents);
            EXPECT_GT(at, 2 * kEvents);
            return;
        }
        if (read_text(file) == kOld) {
            EXPECT_EQ(most, 0u) << "change " << at;
            continue;
        }
        const drive::Drive drive = drive::read_drive(file);
        EXPECT_GE(drive.events.size(), most) << "change " << at;
        most = drive.events.size();
    }
    FAIL() << "it was never done";
}

}  // namespace
}  // namespace vesper::test
