#include "io/files_read.h"

namespace vesper {
namespace {

thread_local FilesRead* listener = nullptr;

std::filesystem::path true_name(const std::filesystem::path& file) {
    std::error_code failed;
    const std::filesystem::path name =
        std::filesystem::weakly_canonical(std::filesystem::absolute(file, failed), failed);
    return failed ? file : name;
}

}  // namespace

FilesRead::FilesRead() { listener = this; }
FilesRead::~FilesRead() { listener = nullptr; }

bool FilesRead::contains(const std::filesystem::path& file) const { return files_.contains(true_name(file)); }

void note_read(const std::filesystem::path& file) {
    if (listener) listener->files_.insert(true_name(file));
}

}  // namespace vesper
