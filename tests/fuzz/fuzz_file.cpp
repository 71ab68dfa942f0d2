#include <unistd.h>

#include <fstream>

#include "base/error.h"
#include "fuzz/targets.h"

namespace vesper::test {
namespace {

namespace fs = std::filesystem;
using Bytes = std::span<const uint8_t>;

// A folder in memory where there is one, gone with the program.
class Scratch {
public:
    Scratch() {
        const fs::path shm = "/dev/shm";
        folder_ =
            (fs::is_directory(shm) ? shm : fs::temp_directory_path()) / ("vesper-fuzz-" + std::to_string(::getpid()));
        fs::create_directories(folder_);
    }
    ~Scratch() {
        std::error_code ignored;
        fs::remove_all(folder_, ignored);
    }
    fs::path operator/(const std::string& name) const { return folder_ / name; }

private:
    fs::path folder_;
};

}  // namespace

FuzzTarget of_file(const std::string& name, const std::function<void(const fs::path&)>& read) {
    return [=](Bytes bytes) {
        static const Scratch scratch;
        const fs::path file = scratch / name;
        std::ofstream(file, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
        read(file);
    };
}

std::map<std::string, FuzzTarget> answering(std::map<std::string, FuzzTarget> targets) {
    for (auto& [name, target] : targets)
        target = [read = target](Bytes bytes) {
            try {
                read(bytes);
            } catch (const Error&) {
            }
        };
    return targets;
}

}  // namespace vesper::test
