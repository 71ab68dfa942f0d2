// Files are replaced whole or not at all. SPDX-License-Identifier: MIT

#include "io/new_file.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>

#include "base/one_line.h"
#include "io/growing_file.h"
#include "io/read_file.h"
#include "io/temporary.h"
#include "support/complaints.h"
#include "support/temp_folder.h"

namespace vesper::test {
namespace {

using io::replace_file;
namespace fs = std::filesystem;

std::vector<uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

size_t entries(const fs::path& folder) {
    return static_cast<size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(NewFile, WritesAndReplaces) {
    const TempFolder folder;
    replace_file(folder / "a", bytes_of("first, and longer"));
    EXPECT_EQ(read_text(folder / "a"), "first, and longer");
    fs::permissions(folder / "a", fs::perms::owner_read | fs::perms::owner_write);
    replace_file(folder / "a", bytes_of("second"));
    EXPECT_EQ(read_text(folder / "a"), "second");
    EXPECT_EQ(fs::status(folder / "a").permissions(), fs::perms::owner_read | fs::perms::owner_write);
    EXPECT_EQ(entries(folder.path()), 1u);
    replace_file(folder / std::string(255, 'n'), {});  // the longest name there can be
    EXPECT_EQ(entries(folder.path()), 2u);
}

TEST(NewFile, KeepsLinks) {
    const TempFolder folder;
    folder.write("target", "old");
    fs::create_symlink("target", folder / "link");
    replace_file(folder / "link", bytes_of("new"));
    EXPECT_TRUE(fs::is_symlink(folder / "link"));
    EXPECT_EQ(read_text(folder / "target"), "new");
    fs::create_symlink("not-yet", folder / "ahead");
    replace_file(folder / "ahead", bytes_of("new"));
    EXPECT_TRUE(fs::is_symlink(folder / "ahead"));
    EXPECT_EQ(read_text(folder / "not-yet"), "new");
    fs::create_symlink("loop", folder / "loop");
    EXPECT_THROW(replace_file(folder / "loop", bytes_of("x")), Error);
}

TEST(NewFile, SaysWhyItCannot) {
    const TempFolder folder;
    folder.write("file", "");
    EXPECT_THROW(replace_file(folder.path(), bytes_of("x")), Error);
    EXPECT_THROW(replace_file(folder / "missing/x", bytes_of("x")), Error);
    EXPECT_THROW(replace_file(folder / "file/x", bytes_of("x")), Error);
    try {
        replace_file("/dev/full", bytes_of("x"));
        FAIL() << "a full device must be noticed";
    } catch (const Error& error) {
        EXPECT_TRUE(contains(error.what(), "/dev/full: cannot be written: No space left"));
    }
    replace_file("/dev/null", bytes_of("x"));
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(NewFile, LeavesTheOldFileWhenTheNewDoesNotFit) {
    const TempFolder folder;
    folder.write("a", "old");
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const rlimit small{1000, before.rlim_max};
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &small);
    EXPECT_THROW(replace_file(folder / "a", std::vector<uint8_t>(5000)), Error);
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    EXPECT_EQ(read_text(folder / "a"), "old");
    EXPECT_EQ(entries(folder.path()), 1u);
}

// Until it is complete nothing of it has a name, whatever ends the program.
TEST(NewFile, HasNoNameUntilItIsComplete) {
    const TempFolder folder;
    folder.write("a", "old");
    io::NewFile file(folder / "a");
    file.write(bytes_of("new"));
    EXPECT_EQ(entries(folder.path()), 1u);
    EXPECT_EQ(read_text(folder / "a"), "old");
    file.commit();
    EXPECT_EQ(read_text(folder / "a"), "new");
    { io::NewFile(folder / "b").write(bytes_of("half")); }
    EXPECT_EQ(entries(folder.path()), 1u);
}

// Where there are no unnamed files: the names cannot be foreseen, and go with the object or with a signal.
TEST(Temporary, GoesWithItsObjectOrWithASignal) {
    const TempFolder folder;
    {
        io::Temporary made(folder.path());
        ASSERT_EQ(made.error(), 0);
        io::Temporary other(folder.path());
        EXPECT_EQ(entries(folder.path()), 2u);
        EXPECT_EQ(made.take().write(bytes_of("x")), 0);
        EXPECT_EQ(made.rename_to(folder / "kept"), 0);
    }
    EXPECT_EQ(entries(folder.path()), 1u);
    EXPECT_EQ(read_text(folder / "kept"), "x");
    const io::Temporary left(folder.path());
    EXPECT_EQ(entries(folder.path()), 2u);
    io::remove_temporaries();
    EXPECT_EQ(entries(folder.path()), 1u);
    EXPECT_EQ(io::Temporary(folder / "missing").error(), ENOENT);
}

TEST(NewFile, DoesNotWaitForAReaderOfAPipe) {
    const TempFolder folder;
    ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
    EXPECT_THROW(replace_file(folder / "pipe", bytes_of("x")), Error);
    EXPECT_THROW(io::GrowingFile(folder / "pipe"), Error);
    const io::Descriptor reader(::open((folder / "pipe").c_str(), O_RDONLY | O_NONBLOCK));
    replace_file(folder / "pipe", bytes_of("x"));
    char got = 0;
    EXPECT_EQ(::read(reader.number(), &got, 1), 1);
    EXPECT_EQ(got, 'x');
}

TEST(ReadFile, ReadsRegularFilesUpToALimit) {
    const TempFolder folder;
    folder.write("a", "12345");
    EXPECT_EQ(io::read_file(folder / "a", 5).size(), 5u);
    EXPECT_THROW(io::read_file(folder / "a", 4), Error);
    EXPECT_THROW(io::read_file(folder.path(), 100), Error);
    EXPECT_THROW(io::read_file("/dev/zero", 100), Error);
    ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
    EXPECT_THROW(io::read_file(folder / "pipe", 100), Error);
}

TEST(OneLine, MakesMessagesOneLine) {
    EXPECT_EQ(one_line("a\nb\tc"), "a?b?c");
    EXPECT_EQ(one_line("caf\xc3\xa9 \xe2\x9d\xa4 \xf0\x9f\x92\xa1"), "caf\xc3\xa9 \xe2\x9d\xa4 \xf0\x9f\x92\xa1");
    EXPECT_EQ(one_line("\xff"
                       "a\xc3"),
              "?a?")
        << "no UTF-8";
    EXPECT_EQ(one_line("\xc2\x9b"
                       "1m\xc0\x9b\xed\xa0\x80\xf4\x90\x80\x80"),
              "??1m" + std::string(9, '?'))
        << "a control character of two bytes, overlong, surrogate, beyond U+10FFFF";
    EXPECT_EQ(one_line("a\u2028b\u202ec\u2066d\u2030"), "a???b???c???d\u2030")
        << "separators of lines, changes of direction";
    EXPECT_EQ(one_line(std::string(400, 'x')), std::string(300, 'x') + "...");
    EXPECT_EQ(one_line(std::string(299, 'x') + "❤❤"), std::string(299, 'x') + "...");  // cut between characters
}

}  // namespace
}  // namespace vesper::test
