// A folder that keeps shadow maps: what was kept comes back whole or not at all, whatever is in the folder.
// SPDX-License-Identifier: MIT
#include "io/cache_folder.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <thread>

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/temp_folder.h"

namespace vesper::test {
namespace {

namespace fs = std::filesystem;

constexpr Digest::Value kKey{0x0123456789abcdefu, 0xfedcba9876543210u};
constexpr const char* kName = "0123456789abcdeffedcba9876543210.vesper-map";
constexpr size_t kBytes = 1000, kHeader = 56;

std::vector<std::byte> noise(size_t bytes, unsigned seed = 1) {
    std::vector<std::byte> made(bytes);
    for (std::byte& byte : made) byte = std::byte((seed = seed * 1664525 + 1013904223) >> 24);
    return made;
}

std::optional<std::vector<std::byte>> read(io::CacheFolder& cache, const Digest::Value& key, size_t bytes = kBytes) {
    std::vector<std::byte> read(bytes);
    return cache.read(key, read) ? std::optional(read) : std::nullopt;
}

/// Without the secret number of the folder.
size_t entries(const fs::path& folder) {
    return size_t(std::count_if(fs::directory_iterator(folder), fs::directory_iterator(), [](const auto& entry) {
        return entry.path().filename() != io::CacheFolder::kSecretName;
    }));
}

/// Seconds before now at which a file was used last.
void age(const fs::path& file, int seconds) {
    fs::last_write_time(file, fs::file_time_type::clock::now() - std::chrono::seconds(seconds));
}

class MapFolder : public testing::Test {
protected:
    TempFolder folder;
    fs::path place = folder / "caches" / "of" / "maps";
    io::CacheFolder cache{place};
    const std::vector<std::byte> bytes = noise(kBytes);

    /// Writes another content in place of the file, and expects that it counts as none and is replaced.
    void expect_replaced(const std::string& text, const std::string& what) {
        std::ofstream(place / kName, std::ios::binary | std::ios::trunc) << text;
        expect_replaced(what);
    }
    void expect_replaced(const std::string& what) {
        SCOPED_TRACE(what);
        EXPECT_EQ(read(cache, kKey), std::nullopt);
        cache.write(kKey, bytes);
        EXPECT_EQ(cache.settle(), "");
        EXPECT_EQ(read(cache, kKey), bytes);
        EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(place / kName)));
        EXPECT_EQ(entries(place), 1u);
    }
};

TEST_F(MapFolder, GivesBackWhatItWasGiven) {
    EXPECT_EQ(read(cache, kKey), std::nullopt);
    EXPECT_FALSE(fs::exists(folder / "caches")) << "who looks makes no folder";
    cache.write(kKey, bytes);
    EXPECT_EQ(cache.settle(), "");
    EXPECT_EQ(read(cache, kKey), bytes);
    EXPECT_EQ(fs::file_size(place / kName), kHeader + kBytes);
    EXPECT_EQ(entries(place), 1u);
    EXPECT_EQ(fs::status(folder / "caches").permissions(), fs::perms::owner_all);
    io::CacheFolder other(place);
    EXPECT_EQ(read(other, kKey), bytes);
    EXPECT_EQ(read(other, {kKey[1], kKey[0]}), std::nullopt);
    EXPECT_EQ(read(other, kKey, kBytes - 1), std::nullopt);
    EXPECT_EQ(read(other, kKey, kBytes + 1), std::nullopt);
    other.write(kKey, bytes);  // two programs have drawn it
    EXPECT_EQ(other.settle(), "");
    EXPECT_EQ(read(other, kKey), bytes);
}

TEST_F(MapFolder, ReplacesWhatIsDamaged) {
    cache.write(kKey, bytes);
    const std::string whole = read_text(place / kName);
    for (size_t at = 0; at < whole.size(); at += at < kHeader ? 1 : 97) {
        std::string damaged = whole;
        damaged[at] = char(damaged[at] ^ 0x10);
        expect_replaced(damaged, "byte " + std::to_string(at));
    }
    for (const size_t size : {size_t{0}, size_t{1}, kHeader - 1, kHeader, whole.size() - 1})
        expect_replaced(whole.substr(0, size), std::to_string(size) + " bytes");
    expect_replaced(whole + "x", "too long");
    expect_replaced(std::string(whole.size(), '\0'), "zeros");
    EXPECT_EQ(read_text(place / kName), whole);
    // The file of another key, with another name.
    cache.write({1, 2}, noise(kBytes, 2));
    fs::rename(place / "00000000000000010000000000000002.vesper-map", place / kName);
    expect_replaced("of another key");
    // A hole of 1 TiB.
    fs::resize_file(place / kName, uint64_t{1} << 40u);
    expect_replaced("large");
}

// A digest as anyone can make it, of a content in place of the one that was written.
TEST_F(MapFolder, TakesNoForgedFiles) {
    cache.write(kKey, bytes);
    const std::string whole = read_text(place / kName);
    EXPECT_EQ(cache.bytes(kKey), kBytes);
    for (const size_t at : {size_t{0}, kBytes / 2, kBytes - 1}) {
        std::string forged = whole;
        forged[kHeader + at] = char(forged[kHeader + at] ^ 1);
        const std::span content = std::as_bytes(std::span(forged)).subspan(kHeader);
        for (const bool with_key : {false, true}) {
            Digest digest;
            if (with_key) digest.add_value(kKey);
            digest.add(content);
            const Digest::Value value = digest.value();
            std::memcpy(&forged[kHeader - sizeof value], &value, sizeof value);
            expect_replaced(forged, "byte " + std::to_string(at));
        }
    }
    // Without the secret number files count as none; another one is made.
    fs::remove(place / io::CacheFolder::kSecretName);
    EXPECT_EQ(read(cache, kKey), std::nullopt);
    expect_replaced(whole, "of a secret that is lost");
    EXPECT_EQ(fs::status(place / io::CacheFolder::kSecretName).permissions(),
              fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(MapFolder, TrustsThisUserAlone) {
    cache.write(kKey, bytes);
    for (const fs::perms more : {fs::perms::group_write, fs::perms::others_write}) {
        fs::permissions(place, more, fs::perm_options::add);
        io::CacheFolder open(place);
        EXPECT_EQ(read(open, kKey), std::nullopt);
        EXPECT_EQ(open.bytes(kKey), 0u);
        EXPECT_FALSE(open.writes());
        const std::string said = open.settle();
        EXPECT_NE(said.find("may be written by other users"), said.npos) << said;
        EXPECT_EQ(open.settle(), "") << "once";
        EXPECT_THROW(open.make(), Error);
        io::CacheFolder writer(place);
        writer.write({1, 2}, bytes);
        EXPECT_NE(writer.settle(), "");
        EXPECT_EQ(entries(place), 1u) << "nothing is written there";
        fs::permissions(place, more, fs::perm_options::remove);
        EXPECT_EQ(read(cache, kKey), bytes);
        // And of one file: it is replaced.
        fs::permissions(place / kName, more, fs::perm_options::add);
        io::CacheFolder other(place);
        EXPECT_EQ(read(other, kKey), std::nullopt);
        EXPECT_TRUE(other.writes());
        const std::string note = other.settle();
        EXPECT_NE(note.find(kName), note.npos) << note;
        EXPECT_EQ(other.settle(), "") << "once";
        other.write(kKey, bytes);
        EXPECT_EQ(read(other, kKey), bytes);
    }
    if (::geteuid() != 0) return;
    ASSERT_EQ(::chown((place / kName).c_str(), 12345, 12345), 0);
    EXPECT_EQ(read(cache, kKey), std::nullopt);
    EXPECT_NE(cache.settle().find("is of another user"), std::string::npos);
    ASSERT_EQ(::chown(place.c_str(), 12345, 12345), 0);
    io::CacheFolder others(place);
    EXPECT_EQ(read(others, kKey), std::nullopt);
    EXPECT_NE(others.settle().find("is of another user"), std::string::npos);
    ASSERT_EQ(::chown(place.c_str(), ::geteuid(), ::getegid()), 0);
}

TEST_F(MapFolder, FollowsNoLinks) {
    cache.write(kKey, bytes);
    fs::rename(place / kName, folder / "elsewhere");
    const std::string whole = read_text(folder / "elsewhere");
    fs::create_symlink(folder / "elsewhere", place / kName);
    cache.write(kKey, bytes);
    ASSERT_TRUE(fs::is_regular_file(fs::symlink_status(place / kName))) << "it was replaced";
    fs::remove(place / kName);
    fs::create_symlink(folder / "elsewhere", place / kName);
    expect_replaced("a link to a whole file");
    EXPECT_EQ(read_text(folder / "elsewhere"), whole);
    fs::remove(place / kName);
    fs::create_symlink(folder / "nowhere", place / kName);
    expect_replaced("a link to nowhere");
    EXPECT_FALSE(fs::exists(folder / "nowhere"));
    fs::remove(place / kName);
    ASSERT_EQ(::mkfifo((place / kName).c_str(), 0600), 0);
    expect_replaced("a pipe");
}

// It is no file of ours, and its map is drawn each time.
TEST_F(MapFolder, LeavesFolders) {
    fs::create_directories(place / kName);
    EXPECT_EQ(read(cache, kKey), std::nullopt);
    cache.write(kKey, bytes);
    EXPECT_EQ(cache.settle(), "");
    EXPECT_TRUE(fs::is_directory(place / kName));
    EXPECT_EQ(entries(place), 1u);
    cache.write({1, 2}, bytes);
    EXPECT_EQ(read(cache, {1, 2}), bytes);
}

TEST_F(MapFolder, SaysOnceWhyItKeepsNothing) {
    folder.write("file", "");
    io::CacheFolder below(folder / "file" / "maps");
    EXPECT_TRUE(below.writes());
    EXPECT_EQ(read(below, kKey), std::nullopt);
    EXPECT_EQ(below.settle(), "");
    below.write(kKey, bytes);
    EXPECT_FALSE(below.writes());
    below.write({1, 2}, bytes);
    const std::string problem = below.settle();
    EXPECT_NE(problem.find("file/maps"), problem.npos) << problem;
    EXPECT_NE(problem.find("Not a directory"), problem.npos) << problem;
    EXPECT_EQ(below.settle(), "");
    EXPECT_THROW(below.make(), Error);
    io::CacheFolder later(folder / "later" / "maps");
    folder.write("later", "");
    later.write(kKey, bytes);
    fs::remove(folder / "later");
    later.write(kKey, bytes);
    EXPECT_FALSE(fs::exists(folder / "later")) << "it goes on trying";
    EXPECT_THROW(io::CacheFolder(folder / "file").make(), Error);
    EXPECT_NO_THROW(cache.make());
    EXPECT_TRUE(fs::is_directory(place));
    io::CacheFolder full("/dev/full");
    full.write(kKey, bytes);
    EXPECT_NE(full.settle(), "");
}

// In a process of its own, whose files may not grow; no signal comes, though the host has not ignored it.
TEST_F(MapFolder, KeepsNothingOnAFullDisk) {
    const pid_t child = ::fork();
    if (child == 0) {
        std::signal(SIGXFSZ, SIG_DFL);
        const rlimit limit{kBytes / 2, kBytes / 2};
        ::setrlimit(RLIMIT_FSIZE, &limit);
        cache.write(kKey, bytes);
        const bool said = cache.settle().find("File too large") != std::string::npos;
        ::_exit(said && !cache.writes() && entries(place) == 0 ? 0 : 1);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

TEST_F(MapFolder, RemovesWhatWasUsedLongestAgo) {
    constexpr size_t kFiles = 16;
    io::CacheFolder small(place, kFiles * (kBytes + kHeader));
    const auto file_of = [&](uint64_t k) { return place / (hexadecimal({k, k}) + ".vesper-map"); };
    fs::create_directories(place);
    // None of ours: other names, and what lies elsewhere.
    const std::string strange = std::string(4 * kFiles * kBytes, 'x');
    for (const char* name : {"notes.txt", "0123456789ABCDEFfedcba9876543210.vesper-map", "x.vesper-map"})
        std::ofstream(place / name) << strange, age(place / name, 100000);
    folder.write("elsewhere", strange);
    fs::create_symlink(folder / "elsewhere", file_of(900));
    fs::create_directory(file_of(901));
    const size_t others = entries(place);
    for (uint64_t k = 0; k < kFiles; ++k) {
        small.write({k, k}, bytes);
        age(file_of(k), int(1000 - k));
    }
    EXPECT_EQ(small.settle(), "");
    EXPECT_EQ(entries(place), others + kFiles) << "they fit";
    EXPECT_NE(read(small, {0, 0}), std::nullopt);  // it is used now
    small.write({100, 100}, bytes);
    EXPECT_EQ(small.settle(), "");
    EXPECT_TRUE(fs::exists(file_of(0)));
    EXPECT_TRUE(fs::exists(file_of(100)));
    // An eighth is free then: of 17 files 14 are left.
    for (uint64_t k = 1; k < kFiles; ++k) EXPECT_EQ(fs::exists(file_of(k)), k > 3) << k;
    EXPECT_EQ(entries(place), others + 14);
    EXPECT_TRUE(fs::is_symlink(file_of(900)));
    EXPECT_EQ(read_text(folder / "elsewhere"), strange);
    EXPECT_EQ(read_text(place / "notes.txt"), strange);
}

// Others write, too: what they left is counted.
TEST_F(MapFolder, StaysSmallWithSeveralPrograms) {
    constexpr uint64_t kMost = 64 * (kBytes + kHeader);
    std::vector<std::unique_ptr<io::CacheFolder>> programs;
    for (int i = 0; i < 3; ++i) programs.push_back(std::make_unique<io::CacheFolder>(place, kMost));
    for (uint64_t k = 0; k < 300; ++k) {
        programs[k % 3]->write({k, k}, bytes);
        EXPECT_EQ(programs[k % 3]->settle(), "");
        uint64_t size = 0;
        for (const auto& entry : fs::directory_iterator(place)) size += entry.file_size();
        EXPECT_LE(size, kMost + 3 * (kMost / 16 + kBytes + kHeader)) << k;
        if (k > 64) {
            EXPECT_GT(size, kMost / 2) << k;
        }
    }
}

// Readers see whole files or none, while others replace and remove them.
TEST_F(MapFolder, IsSafeForSeveralAtOnce) {
    constexpr uint64_t kMost = 20 * (kBytes + kHeader);
    const auto work = [&](unsigned seed) {
        io::CacheFolder own(place, kMost);
        size_t wrong = 0;
        for (unsigned i = 0; i < 2000; ++i) {
            const uint64_t k = (seed = seed * 1664525 + 1013904223) >> 26;
            const std::vector<std::byte> expected = noise(kBytes, unsigned(k));
            const auto got = read(own, {k, k});
            if (got) wrong += *got == expected ? 0 : 1;
            own.write({k, k}, expected);
            wrong += own.settle().empty() ? 0 : 1;
        }
        return wrong;
    };
    size_t wrong[3]{};
    {
        std::vector<std::jthread> threads;
        for (unsigned i = 0; i < 3; ++i) threads.emplace_back([&, i] { wrong[i] = work(i + 7); });
    }
    for (const size_t of_thread : wrong) EXPECT_EQ(of_thread, 0u);
    for (const auto& entry : fs::directory_iterator(place))
        EXPECT_TRUE(entry.path().string().ends_with(".vesper-map") ||
                    entry.path().filename() == io::CacheFolder::kSecretName)
            << entry.path();
}

}  // namespace
}  // namespace vesper::test
