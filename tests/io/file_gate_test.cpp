// No output replaces an input, whatever their names. SPDX-License-Identifier: MIT
#include "io/file_gate.h"

#include "io/growing_file.h"
#include "io/new_file.h"
#include "io/read_file.h"
#include "support/complaints.h"
#include "support/temp_folder.h"

namespace vesper::test {
namespace {

using io::FileGate, io::announce_write;
namespace fs = std::filesystem;

constexpr const char* kRead = "would replace what is read";

/// The message of the Error that a call throws; empty if it throws none.
template <class Call>
std::string error_of(const Call& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

/// A file, and other ways to it.
struct Names {
    const TempFolder folder;
    const std::vector<fs::path> all{folder / "a", folder / "link", folder / "hard", folder.path() / "." / "a",
                                    folder / "folder-link/a"};

    Names() {
        folder.write("a", "precious");
        fs::create_symlink("a", folder / "link");
        fs::create_hard_link(folder / "a", folder / "hard");
        fs::create_directory_symlink(".", folder / "folder-link");
    }
};

TEST(FileGate, RefusesToReplaceWhatWasRead) {
    const Names names;
    const FileGate gate;
    io::read_file(names.folder / "a", 10);
    for (const fs::path& name : names.all) {
        EXPECT_TRUE(contains(error_of([&] { io::replace_file(name, {}); }), kRead)) << name;
        EXPECT_TRUE(contains(error_of([&] { io::GrowingFile grows(name); }), kRead)) << name;
        EXPECT_TRUE(contains(error_of([&] { announce_write("-o", name); }), kRead)) << name;
    }
    EXPECT_EQ(read_text(names.folder / "a"), "precious");
    io::replace_file(names.folder / "b", {});
}

TEST(FileGate, RefusesToReadWhatWillBeWritten) {
    const Names names;
    for (const fs::path& name : names.all) {
        const FileGate gate;
        announce_write("--log", name);
        const std::string error = error_of([&] { io::read_file(names.folder / "a", 10); });
        EXPECT_EQ(error, "--log " + name.string() + ": " + kRead);
        EXPECT_TRUE(contains(error_of([&] { io::announce_read(names.folder / "a"); }), kRead)) << name;
    }
}

TEST(FileGate, KnowsWhatIsReadOnlyLater) {
    const Names names;
    const FileGate gate;
    io::NewFile file(names.folder / "link");
    io::read_file(names.folder / "a", 10);
    EXPECT_TRUE(contains(error_of([&] { file.commit(); }), kRead));
    EXPECT_EQ(read_text(names.folder / "a"), "precious");
}

TEST(FileGate, RefusesToWriteTwice) {
    const Names names;
    for (const fs::path& name : names.all) {
        const FileGate gate;
        announce_write("-o", names.folder / "a");
        EXPECT_TRUE(contains(error_of([&] { announce_write("--log", name); }), "would be written twice")) << name;
    }
    const FileGate gate;
    announce_write("-o", names.folder / "new");
    fs::create_symlink("new", names.folder / "to-new");
    EXPECT_TRUE(contains(error_of([&] { announce_write("--log", names.folder / "to-new"); }), "twice"));
    announce_write("--json", "/dev/null"), announce_write("--csv", "/dev/null");
    EXPECT_TRUE(contains(error_of([&] { announce_write("-o", names.folder / "none/x"); }), "there is no folder"));
}

TEST(FileGate, LetsFilesBeReadThatAreComplete) {
    const TempFolder folder;
    const FileGate gate;
    io::GrowingFile file(folder / "log");
    file.append("x");
    EXPECT_TRUE(contains(error_of([&] { io::read_file(folder / "log.part", 10); }), kRead));
    file.complete();
    EXPECT_EQ(io::read_file(folder / "log", 10).size(), 1u);
}

TEST(FileGate, EndsWithItsTask) {
    const Names names;
    {
        const FileGate gate;
        const FileGate inner;  // without effect
        io::read_file(names.folder / "a", 10);
    }
    io::replace_file(names.folder / "a", {});
    EXPECT_EQ(read_text(names.folder / "a"), "");
}

}  // namespace
}  // namespace vesper::test
