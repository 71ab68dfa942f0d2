#include "frame_files.h"

#include "arguments/arguments.h"
#include "arguments/glare_arguments.h"
#include "tone_log.h"

namespace vesper::commands {

apps::Bytes FrameRows::packed() const {
    apps::PacketWriter packet;
    for (const std::string* rows : {&log, &sources, &eye}) packet.list(*rows);
    return packet.take();
}

void FrameFiles::open(const std::string& log, const std::string& sources, const std::string& eye,
                      const std::string& more) {
    heading_ = apps::summed_heading(apps::log_heading() + more) + "\n";
    if (!log.empty()) log_.emplace(log).append(heading_);
    if (!sources.empty()) sources_.emplace(sources).append(apps::glare_sources_heading());
    eye_file_ = eye;
}

void FrameFiles::add(const apps::Bytes& rows) {
    apps::PacketReader packet(rows);
    for (auto* file : {&log_, &sources_})
        if (const std::string text = packet.text(); *file) (*file)->append(text);
    const std::string eye = packet.text();
    if (!eye_file_.empty() && !eye.empty()) apps::write_text(eye_file_, heading_ + eye);
}

void FrameFiles::complete() {
    for (auto* file : {&log_, &sources_})
        if (*file) (*file)->complete();
}

}  // namespace vesper::commands
