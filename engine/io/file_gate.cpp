#include "io/file_gate.h"

#include <sys/stat.h>

#include <optional>
#include <vector>

#include "base/error.h"
#include "base/one_line.h"
#include "io/new_file.h"

namespace vesper::io {
namespace {

namespace fs = std::filesystem;

thread_local FileGate* gate = nullptr;

fs::path folder_of(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : fs::path("."); }

/// A regular file that exists.
std::optional<FileIdentity> existing(const fs::path& file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
    return FileIdentity{status.st_dev, status.st_ino, {}};
}

/// What is written to a path: the file there is now, and the one of that name. None for a folder, a pipe, a terminal.
std::vector<FileIdentity> identities_of(const fs::path& file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) == 0 && !S_ISREG(status.st_mode)) return {};
    std::vector<FileIdentity> found;
    if (const auto now = existing(file)) found.push_back(*now);
    const fs::path target = target_of(file);
    if (::stat(folder_of(target).c_str(), &status) == 0)
        found.push_back({status.st_dev, status.st_ino, target.filename().string()});
    return found;
}

void refuse_written(const FileIdentity& identity) {
    if (const auto writer = gate->written.find(identity); writer != gate->written.end())
        throw WouldReplace(writer->second + ": would replace what is read");
}

}  // namespace

FileGate::FileGate() {
    if (!gate) gate = this;
}
FileGate::~FileGate() {
    if (gate == this) gate = nullptr;
}

void gate_contents(const fs::path& file, std::span<const uint8_t> bytes) {
    if (!gate || !gate->keeps_contents) return;
    Digest digest;
    digest.add(std::as_bytes(bytes));
    gate->contents[file.filename().string()].insert(digest.value());
}

std::map<std::string, std::set<Digest::Value>> contents_read() {
    return gate ? gate->contents : std::map<std::string, std::set<Digest::Value>>{};
}

void announce_read(const fs::path& file) {
    const auto identity = existing(file);
    if (!gate || !identity) return;
    for (const FileIdentity& known : identities_of(file)) refuse_written(known);
    gate->read.insert(*identity);
}

void announce_write(const std::string& option, const fs::path& file) {
    if (file.empty()) return;
    const std::string place = option + " " + one_line(file.string());
    const fs::path folder = folder_of(file);
    std::error_code failed;
    if (!fs::is_directory(folder, failed)) throw Error(place + ": there is no folder " + one_line(folder.string()));
    if (!gate) return;
    for (const FileIdentity& identity : identities_of(file)) {
        if (gate->read.contains(identity)) throw WouldReplace(place + ": would replace what is read");
        if (!gate->written.emplace(identity, place).second) throw Error(place + ": would be written twice");
    }
}

void gate_read(int descriptor, const fs::path& file) {
    struct stat status {};
    if (!gate || ::fstat(descriptor, &status) != 0) return;
    const FileIdentity opened{status.st_dev, status.st_ino, {}};
    refuse_written(opened);
    announce_read(file);
    gate->read.insert(opened);  // whatever has the name by now
}

void gate_write(const fs::path& file) {
    if (!gate) return;
    if (const auto identity = existing(file); identity && gate->read.contains(*identity))
        throw WouldReplace(one_line(file.string()) + ": would replace what is read");
}

void gate_grows(const fs::path& file) {
    if (gate)
        for (const FileIdentity& identity : identities_of(file))
            gate->written.emplace(identity, one_line(file.string()));
}

void gate_written(const fs::path& file) {
    if (gate)
        for (const FileIdentity& identity : identities_of(file)) gate->written.erase(identity);
}

}  // namespace vesper::io
