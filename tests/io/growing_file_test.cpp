// Files that grow beside their place. SPDX-License-Identifier: MIT
#include "io/growing_file.h"

#include "support/complaints.h"
#include "support/temp_folder.h"

namespace vesper::test {
namespace {

using io::GrowingFile;
namespace fs = std::filesystem;

TEST(GrowingFile, TakesItsNameWhenItIsComplete) {
    const TempFolder folder;
    folder.write("log", "a good one");
    {
        GrowingFile file(folder / "log");
        file.append("one\n");
        EXPECT_EQ(read_text(folder / "log.part"), "one\n") << "on disk at once";
        file.append("two\n");
        EXPECT_EQ(read_text(folder / "log"), "a good one");
        file.complete();
    }
    EXPECT_EQ(read_text(folder / "log"), "one\ntwo\n");
    EXPECT_FALSE(fs::exists(folder / "log.part"));
}

TEST(GrowingFile, LeavesWhatThereIsWhenItIsNot) {
    const TempFolder folder;
    folder.write("log", "a good one");
    GrowingFile(folder / "log").append("half\n");
    EXPECT_EQ(read_text(folder / "log"), "a good one");
    EXPECT_EQ(read_text(folder / "log.part"), "half\n");
}

TEST(GrowingFile, KeepsLinksAndWritesToWhatIsNoFile) {
    const TempFolder folder;
    folder.write("target", "old");
    fs::create_symlink("target", folder / "link");
    const auto expect_written_through = [&](const char* target, const char* link) {
        GrowingFile file(folder / link);
        file.append("new");
        file.complete();
        EXPECT_TRUE(fs::is_symlink(folder / link));
        EXPECT_EQ(read_text(folder / target), "new");
    };
    expect_written_through("target", "link");
    GrowingFile null("/dev/null");
    null.append("x");
    null.complete();
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    EXPECT_THROW(GrowingFile(folder.path()), Error);
    EXPECT_THROW(GrowingFile(folder / "missing/x"), Error);
    // A link to what is not there yet makes it; one that leads nowhere is refused.
    fs::create_symlink("new", folder / "ahead");
    expect_written_through("new", "ahead");
    fs::create_symlink("loop", folder / "loop");
    EXPECT_THROW(GrowingFile(folder / "loop"), Error);
}

// Whatever links lead from the part's name, and whatever the part of a link is: nothing is written through them.
TEST(GrowingFile, WritesThroughNoLink) {
    const TempFolder folder;
    folder.write("input", "precious");
    fs::create_symlink("input", folder / "soft.part");
    fs::create_hard_link(folder / "input", folder / "hard.part");
    for (const char* name : {"soft", "hard"}) {
        GrowingFile file(folder / name);
        file.append("new");
        EXPECT_EQ(read_text(folder / "input"), "precious") << name;
        file.complete();
        EXPECT_EQ(read_text(folder / name), "new");
        EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(folder / name))) << name;
    }
    EXPECT_EQ(read_text(folder / "input"), "precious");
    EXPECT_EQ(GrowingFile::part_of(folder / "soft"), folder / "soft.part");
    fs::create_directory(folder / "elsewhere");
    folder.write("elsewhere/log", "old");
    fs::create_symlink("elsewhere/log", folder / "link");
    EXPECT_EQ(GrowingFile::part_of(folder / "link"), folder / "elsewhere/log.part") << "where it really grows";
    EXPECT_EQ(GrowingFile::part_of(""), "");
    fs::create_directory(folder / "taken.part");
    EXPECT_THROW(GrowingFile(folder / "taken"), Error);
}

TEST(GrowingFile, RefusesASecondWriter) {
    const TempFolder folder;
    GrowingFile first(folder / "log");
    first.append("one\n");
    try {
        GrowingFile second(folder / "log");
        FAIL() << "two writers of one file";
    } catch (const Error& error) {
        EXPECT_TRUE(contains(error.what(), "log.part: is being written by another program")) << error.what();
    }
    first.append("two\n");
    first.complete();
    EXPECT_EQ(read_text(folder / "log"), "one\ntwo\n");
    GrowingFile next(folder / "log");  // the lock went with the first
    next.append("three\n");
    next.complete();
    EXPECT_EQ(read_text(folder / "log"), "three\n");
}

TEST(GrowingFile, TakesNoOtherFilesPlace) {
    const TempFolder folder;
    GrowingFile file(folder / "log");
    file.append("own");
    fs::remove(folder / "log.part");
    folder.write("log.part", "another's");
    EXPECT_THROW(file.complete(), Error);
    EXPECT_EQ(read_text(folder / "log.part"), "another's");
    EXPECT_FALSE(fs::exists(folder / "log"));
}

}  // namespace
}  // namespace vesper::test
