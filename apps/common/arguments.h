// What the commands share: checks of arguments, texts. SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>

#include "io/files_read.h"

namespace vesper {

/// Throws Error if the file that an option names was read.
void refuse_overwriting(const FilesRead&, const std::string& option, const std::string& file);

/// The files of a command: no output may replace an input or another output.
class Files {
public:
    /// Everything that is read is named first. An empty name is no file.
    void reads(const std::string& file);
    /// Throws Error if the folder that `file` is to be written to does not exist, if the file is read or written twice.
    void writes(const std::string& option, const std::string& file);
    /// Throws Error if something that is written was read since, whatever named it.
    void refuse_overwriting(const FilesRead&) const;

private:
    std::set<std::string> read_;
    std::map<std::string, std::pair<std::string, std::string>> written_;  // by their true names: option and file
};

/// A value as a shell takes it for one word.
std::string in_shell(const std::string& value);

/// Writes a text file, which is replaced only when complete.
void write_text(const std::string& file, const std::string& text);
/// printf into a string.
[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...);
/// At most so many characters of UTF-8, then spaces up to so many columns.
std::string column(const std::string& text, size_t width);

}  // namespace vesper
