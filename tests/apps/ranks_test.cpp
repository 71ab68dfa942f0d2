// Several processes at once: channels, films, and what can go wrong. Skipped where there is no mpirun.
// SPDX-License-Identifier: MIT
#include <fstream>

#include <gtest/gtest.h>

#include "channels/channels.h"
#include "run/channel_ranks.h"
#include "support/complaints.h"
#include "support/program.h"

namespace vesper::test {
namespace {

namespace fs = std::filesystem;
using drive::Channels, drive::ChannelTurns;

const fs::path kPrograms = fs::path(VESPER_PROGRAM).parent_path();

// Three screens, the one in the middle larger.
const std::string kRig = R"({"version": 1, "gaze": "front", "channels": [
    {"name": "left", "size_px": [48, 30], "yaw_deg": 48, "left_deg": -24, "right_deg": 24, "bottom_deg": -15, "top_deg": 15},
    {"name": "front", "size_px": [61, 37], "left_deg": -24, "right_deg": 24, "bottom_deg": -15, "top_deg": 15},
    {"name": "right", "size_px": [48, 30], "yaw_deg": -48, "left_deg": -24, "right_deg": 24, "bottom_deg": -15, "top_deg": 15, "warp": "keystone.data"}]})";

class RanksProgram : public ProgramTest {
protected:
    RanksProgram() : ProgramTest("") {
        if (std::system("command -v mpirun >/dev/null") != 0 || !fs::exists(kPrograms / "vesper-mpi.so"))
            missing_ = true;
    }
    void SetUp() override {
        if (missing_) GTEST_SKIP() << "no mpirun, or built without MPI";
        folder.write("rig.json", kRig);
        folder.write("keystone.data", "2\n2 2\n-1.5 -1 0 0 1\n1.5 -1 1 0 0.5\n-1 1 0 1 1\n1 0.9 1 1 0.5\n");
        const std::string yard = VESPER_SOURCE_DIR "/data/photometry/yard";
        ASSERT_EQ(
            run(VESPER_PROGRAM " convert " + yard + ".gltf --photometry " + yard + ".photometry.json -o yard.gltf"), 0)
            << said;
    }
    // `ranks` 1: without mpirun.
    int run_ranks(int ranks, const std::string& command) {
        const std::string root = "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 timeout 120 ",
                          many = root + "mpirun -q --oversubscribe --bind-to none -n " + std::to_string(ranks) + " ";
        return run((ranks > 1 ? many : "") + command);
    }
    std::string drive() const { return (kPrograms / "vesper-drive").string() + " "; }
    void expect_same(const std::string& a, const std::string& b, size_t files) {
        size_t count = 0;
        for (const auto& entry : fs::directory_iterator(folder / a)) {
            const std::string name = entry.path().filename();
            EXPECT_EQ(read_text(entry.path()), read_text(folder / b / name)) << b << "/" << name;
            ++count;
        }
        EXPECT_EQ(count, files);
    }
    // A log but for its last columns, which tell times.
    std::string timeless(const std::string& file, size_t columns) {
        std::ifstream in(folder / file);
        std::string text;
        for (std::string line; std::getline(in, line); text += line + "\n")
            for (size_t i = 0; i < columns; ++i) line.resize(line.rfind(','));
        return text;
    }

private:
    bool missing_ = false;
};

// Light of one screen is scattered into the others, the eye adapts to all, colours count, and statistics may be late:
// the pictures are those of one process, to the bit, and so is the log.
TEST_F(RanksProgram, ChannelsAreThoseOfOneProcess) {
    for (const std::string& options :
         std::vector<std::string>{"--glare cie", "--glare temporal --latency 1", "--operator devlin --latency 1"}) {
        const std::string command = drive() + "yard.gltf --headless --autopilot --seconds 0.1 --indirect off " +
                                    "--channels rig.json " + options + " ";
        for (const int ranks : {1, 3, 4}) {
            const std::string to = std::to_string(ranks);
            fs::remove_all(folder / to);
            fs::create_directory(folder / to);
            ASSERT_EQ(run_ranks(ranks, command + "--video " + to + "/%02d.png --log " + to + ".csv"), 0)
                << options << ": " << said;
        }
        expect_same("1", "4", 4);
        expect_same("1", "3", 4);
        EXPECT_EQ(timeless("1.csv", 2), timeless("4.csv", 4)) << options;
        EXPECT_NE(read_text(folder / "4.csv").find(",frame_ms,skew_us,last_rank\n"), std::string::npos);
    }
}

// Statistics that are a frame late make other pictures, but for the first one.
TEST_F(RanksProgram, LatencyIsThatOfAFrame) {
    for (const std::string& latency : std::vector<std::string>{"0", "1"}) {
        fs::create_directory(folder / latency);
        ASSERT_EQ(
            run_ranks(1, drive() + "yard.gltf --headless --autopilot --seconds 0.2 --indirect off --smoothing 0 " +
                             "--channels rig.json --latency " + latency + " --video " + latency + "/%02d.png"),
            0)
            << said;
    }
    EXPECT_EQ(read_text(folder / "0/00.png"), read_text(folder / "1/00.png"));
    EXPECT_NE(read_text(folder / "0/06.png"), read_text(folder / "1/06.png"));
}

// Frames in parallel, with an eye that is handed on.
TEST_F(RanksProgram, FilmsAreThoseOfOneProcess) {
    const std::string step = R"({"step":{"throttle":1}},)", frame = R"({"frame":true},)";
    std::string events = frame;
    for (int i = 0; i < 5; ++i) events += step + step + frame;
    events += R"({"restart":true},)" + frame + step + R"({"set":{"operator":"pattanaik"}},)" + frame + step;
    folder.write("d.json", R"({"vesper_drive":1,"scene":"yard.gltf","settings":{"indirect":"off"},"events":[)" +
                               events + R"({"frame":true}]})");
    for (const std::string& command :
         std::vector{drive() + "--headless --replay d.json --size 61x37 --glare temporal --probe 0.5,0.5 --video ",
                     std::string(VESPER_PROGRAM) +
                         " render yard.gltf --size 61x37 --frames 9 --glare temporal --indirect off -o ",
                     std::string(VESPER_PROGRAM) +
                         " render yard.gltf --size 61x37 --frames 9 --operator ldr --glare ldr -o "}) {
        for (const int ranks : {1, 2, 3}) {
            const std::string to = std::to_string(ranks);
            fs::remove_all(folder / to);
            fs::create_directory(folder / to);
            ASSERT_EQ(run_ranks(ranks, command + to + "/%d.png --log " + to + ".csv"), 0) << command << ": " << said;
        }
        expect_same("1", "2", 9);
        expect_same("1", "3", 9);
        const size_t times = command.starts_with(drive()) ? 2 : 0;
        EXPECT_EQ(timeless("1.csv", times), timeless("3.csv", times)) << command;
    }
}

// Pictures that are enlarged, and the light that was rendered of them.
TEST_F(RanksProgram, ScaledFilmsAreThoseOfOneProcess) {
    for (const std::string& command :
         std::vector{std::string(VESPER_PROGRAM) + " render yard.gltf --size 61x37 --scale 0.5 --frames 3 --indirect " +
                         "off --glare temporal -o %/%d.png -o %/%d.exr",
                     drive() + "yard.gltf --headless --autopilot --seconds 0.1 --indirect off --size 61x37 --scale " +
                         "0.5 --glare temporal --video %/%d.png",
                     drive() + "yard.gltf --headless --autopilot --seconds 0.1 --indirect off --size 61x37 --scale " +
                         "0.5 --quality fast --video %/%d.exr"}) {
        for (const int ranks : {1, 2}) {
            const std::string to = std::to_string(ranks);
            std::string own = command;
            for (size_t at = 0; (at = own.find("%/")) != own.npos;) own.replace(at, 1, to);
            fs::remove_all(folder / to);
            fs::create_directory(folder / to);
            ASSERT_EQ(run_ranks(ranks, own), 0) << own << ": " << said;
        }
        expect_same("1", "2", command.starts_with(drive()) ? 4 : 6);
    }
}

// A run that goes on where another one ended.
TEST_F(RanksProgram, EyesGoOnFromFiles) {
    const std::string render = VESPER_PROGRAM " render yard.gltf --size 48x30 --indirect off ";
    ASSERT_EQ(run(render + "--frames 5 --dt 0.5 -o a%d.png --eye-out a.csv"), 0) << said;
    ASSERT_EQ(run(render + "--frames 2 --dt 0.5 -o b%d.png --eye-out b.csv"), 0) << said;
    ASSERT_EQ(run(render + "--frames 3 --dt 0.5 --start 1 --eye-in b.csv -o c%d.png --eye-out c.csv"), 0) << said;
    for (int i = 0; i < 3; ++i)
        EXPECT_EQ(read_text(folder / ("a" + std::to_string(i + 2) + ".png")),
                  read_text(folder / ("c" + std::to_string(i) + ".png")));
    const auto last_row = [&](const std::string& file) {
        const std::string text = read_text(folder / file);
        const std::string row = text.substr(text.rfind('\n', text.size() - 2) + 1);
        return row.substr(row.find(',') + 1);  // without its number
    };
    EXPECT_EQ(last_row("a.csv"), last_row("c.csv"));
    ASSERT_EQ(run_ranks(2, render + "--frames 3 --dt 0.5 --start 1 --eye-in b.csv -o c%d.png --eye-out d.csv"), 0)
        << said;
    EXPECT_EQ(read_text(folder / "c.csv"), read_text(folder / "d.csv"));
    EXPECT_EQ(run(render + "--eye-in a.csv --operator ward -o d.png"), 2);
    EXPECT_NE(said.find("--eye-in a.csv: is of the operator irawan"), std::string::npos) << said;
}

// Conditions are shared out; the page, its pictures and its figures are the same.
TEST_F(RanksProgram, StudiesAreThoseOfOneProcess) {
    for (const int ranks : {1, 2})
        ASSERT_EQ(run_ranks(ranks, std::string(VESPER_PROGRAM) + " study operators yard.gltf --size 61x37 -o " +
                                       std::to_string(ranks)),
                  0)
            << said;
    size_t files = 0;
    for (const auto& entry : fs::directory_iterator(folder / "1")) {
        EXPECT_EQ(read_text(entry.path()), read_text(folder / "2" / entry.path().filename())) << entry.path();
        ++files;
    }
    EXPECT_GT(files, 10u);
}

// One line, whatever the number of ranks, and exit code 2 from each.
TEST_F(RanksProgram, RefusesWhatDoesNotGoTogether) {
    const auto expect = [&](int ranks, const std::string& command, const std::string& words) {
        EXPECT_EQ(run_ranks(ranks, command), 2) << command;
        EXPECT_NE(said.find(words), std::string::npos) << command << ": " << said;
        size_t lines = 0;
        for (size_t at = 0; (at = said.find("vesper", at)) != std::string::npos; at = said.find('\n', at)) ++lines;
        EXPECT_EQ(lines, 1u) << said;
    };
    const std::string headless = drive() + "yard.gltf --headless --seconds 0.1 --indirect off --video x%d.png ";
    expect(5, headless + "--channels rig.json", "no rank may be without a channel");
    expect(2, headless + "--channels none.json", "none.json");
    expect(2, std::string(VESPER_PROGRAM) + " inspect yard.gltf", "inspect does not run on several ranks");
    expect(2, std::string(VESPER_PROGRAM) + " render none.gltf -o x.png", "none.gltf");
    const auto rig = [&](int left, int front, int right) {
        std::string text = kRig;
        for (const auto& [name, rank] : {std::pair("left", left), {"front", front}, {"right", right}})
            if (rank >= 0)
                text.insert(text.find(std::string("{\"name\": \"") + name) + 1,
                            "\"rank\": " + std::to_string(rank) + ", ");
        folder.write("rig.json", text);
    };
    rig(1, -1, 2), expect(3, headless + "--channels rig.json", "channel front has no rank, and others have");
    rig(1, 3, 2), expect(3, headless + "--channels rig.json", "channel front is of rank 3");
    rig(0, 0, 1), expect(3, headless + "--channels rig.json", "rank 2 has no channel");
    rig(0, 0, 1);
    EXPECT_EQ(run_ranks(2, headless + "--channels rig.json"), 0) << said;

    // Each rank with arguments of its own.
    const std::string one = headless + "--channels rig.json --glare ";
    expect(1,
           "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 timeout 120 mpirun -q --oversubscribe -n 1 " +
               one + "cie : -n 1 " + one + "none",
           "has another command line than rank 0");

    // Each rank in a folder of its own.
    folder.write("rig.json", kRig);
    for (const std::string& there : std::vector<std::string>{"0", "1"}) {
        fs::create_directory(folder / there);
        fs::copy(folder / "rig.json", folder / there / "rig.json");
        fs::copy(folder / "keystone.data", folder / there / "keystone.data");
        fs::copy(folder / "yard.gltf", folder / there / "yard.gltf");
        if (fs::exists(folder / "yard.bin")) fs::copy(folder / "yard.bin", folder / there / "yard.bin");
    }
    const std::string apart = "sh -c 'cd $OMPI_COMM_WORLD_RANK && exec " + headless + "--channels rig.json'";
    EXPECT_EQ(run_ranks(2, apart), 0) << said;
    std::ofstream(folder / "1/yard.gltf", std::ios::app) << ' ';
    expect(2, apart, "has another yard.gltf than rank 0");
    fs::remove(folder / "1/yard.gltf");
    expect(2, apart, "rank 1 (left and front and right, on ");
}

// A rank that dies or stops ends the run; what was recorded can be driven again.
TEST_F(RanksProgram, ARankThatIsSilentEndsTheRun) {
    for (const std::string& signal : std::vector<std::string>{"KILL", "STOP"}) {
        fs::remove_all(folder / "d.json.part");
        folder.write("kill.sh",
                     "while [ ! -s l.csv.part ] || [ $(wc -l <l.csv.part) -lt 4 ]; do sleep 0.1; done\n"
                     "kill -" +
                         signal + " $(cat pid2)\n");
        folder.write("rank.sh", "echo $$ >pid$OMPI_COMM_WORLD_RANK\nexec " + drive() +
                                    "yard.gltf --headless --autopilot --seconds 600 --indirect off --channels rig.json "
                                    "--log l.csv --record d.json\n");
        folder.write("all.sh",
                     "sh kill.sh &\n"
                     "exec timeout 120 mpirun --oversubscribe --bind-to none -n 4 sh rank.sh\n");
        fs::remove(folder / "l.csv.part");
        const int code = run("sh all.sh", "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1");
        EXPECT_TRUE(code != 0 && code != 124) << code << ": " << said;
        const std::string name = signal == "KILL" ? "process rank 2" : "rank 2 (front, on ";
        EXPECT_NE(said.find(name), std::string::npos) << said;
        EXPECT_EQ(run_ranks(1, drive() + "--headless --replay d.json.part --record e.json"), 2);  // is not recorded
        EXPECT_EQ(run_ranks(1, drive() + "--headless --replay d.json.part --size 16x10 --fps 2 --log r.csv"), 0)
            << said;
    }
}

// Turns are heard in their order, now or one late; the first at once.
TEST(ChannelTurns, AreHeardAtOnceOrOneLate) {
    drive::ChannelLink alone;
    ChannelTurns turns(alone, drive::ChannelLink::Kind::Light);
    const auto tell = [&](int number, bool late) {
        apps::PacketWriter packet;
        packet.value(number);
        return apps::PacketReader(turns.tell(packet.take(), late).at(0)).value<int>();
    };
    EXPECT_EQ(tell(1, false), 1);
    EXPECT_EQ(tell(2, false), 2);
    turns.forget();
    EXPECT_EQ(tell(3, true), 3);
    EXPECT_EQ(tell(4, true), 3);
    EXPECT_EQ(tell(5, true), 4);
    EXPECT_EQ(tell(6, false), 6) << "those that were to be late are heard";
    turns.forget();
    EXPECT_EQ(tell(7, true), 7);
}

TEST(ChannelRanks, ShareTheChannels) {
    Channels channels;
    for (const char* name : {"a", "b", "c", "d", "e"}) channels.screens.push_back({.name = name});
    using Ranks = std::vector<int>;
    EXPECT_EQ(drive::ranks_of(channels, 1), Ranks({0, 0, 0, 0, 0}));
    EXPECT_EQ(drive::ranks_of(channels, 2), Ranks({1, 1, 1, 1, 1}));
    EXPECT_EQ(drive::ranks_of(channels, 3), Ranks({1, 1, 2, 2, 2}));
    EXPECT_EQ(drive::ranks_of(channels, 6), Ranks({1, 2, 3, 4, 5}));
    EXPECT_EQ(complaint_of([&] { drive::ranks_of(channels, 7); }),
              "there are 7 ranks, one that drives and 6 for 5 channels: no rank may be without a channel");
}

}  // namespace
}  // namespace vesper::test
