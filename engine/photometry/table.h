// Shared parts of the readers of distributions: text, bounds, checks, symmetry. Not a public header.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "photometry/distribution.h"

namespace vesper::photometry {

constexpr uint64_t kMaxTableBytes = 64u << 20;
constexpr size_t kMaxAngles = 4096;      ///< of either list, as the file has it
constexpr size_t kMaxCells = 8'000'000;  ///< of the table with its symmetry expanded

/// A text file line by line: CR, LF or CRLF, with or without a byte order mark. Texts in UTF-16 have one, and become
/// UTF-8.
class LineReader {
public:
    LineReader(std::span<const uint8_t> bytes, std::string name);

    /// The next line without its end; empty at the end of the file.
    std::optional<std::string_view> next();
    /// Number of the line that next() gave last, from 1.
    size_t line() const { return line_; }
    /// Everything after that line.
    std::string_view rest() const { return text_.substr(at_); }
    [[noreturn]] void fail(const std::string& reason) const { fail_at(line_, reason); }
    [[noreturn]] void fail_at(size_t line, const std::string& reason) const;

private:
    std::string name_;
    std::shared_ptr<const std::string> converted_;  // from UTF-16
    std::string_view text_;
    size_t at_ = 0, line_ = 0;
};

std::string_view trimmed(std::string_view text);
/// A text made fit for a name: trimmed, control characters replaced; bytes that are no UTF-8 are taken for Latin-1.
std::string readable(std::string_view text);
/// A text in a message, quoted and short.
std::string quoted(std::string_view text);
/// The words of a heading in lower case, separated by any other characters: "V [°]" is one, "I_cd" are two.
std::vector<std::string> words_of(std::string_view heading);
/// Whether a corner cell names tan gamma ("tan_gamma", "tg", "beta\\tan(gamma)"): the file is an r-table.
bool names_tan_gamma(std::string_view cell);
/// A finite number; the whole text must be one. One too small for a double is 0. A decimal comma will do where `comma`
/// is set.
std::optional<double> number_of(std::string_view text, bool comma = true);

/// The trimmed fields of a line. Parsing stops after more than `most` fields, so that the caller sees the excess.
std::vector<std::string_view> fields_of(std::string_view line, char separator, size_t most);

enum class TablePart : uint8_t { Horizontal, Vertical, Candela };
using TableFault = std::function<void(TablePart, const std::string& reason)>;  ///< must throw

/// Reason to refuse a table of so many angles; empty if it is accepted.
std::string objection_to_size(double horizontal, double vertical);

/// True if C planes from 0 close the circle: the gap from the last to 360 deg is at most 1.5 times the widest step.
bool go_round(const std::vector<double>& planes);

/// Completes a table as read from a file: checks angles and intensities, drops a repeated last angle, sets negative
/// noise (down to -1 % of the largest intensity) to 0 and expands symmetry. C planes may be one; 0 to 90, 180 or 360
/// (whose two ends differ by at most 10 % of the largest intensity: their mean is taken); 0 to less than 360 if they
/// close the circle; 90 to 270; -90 to 90. `halves`: H of types A and B from 0 stands for both sides, and so does V
/// from 0 where the table is bright there, as no luminaire ends its light on such a line. Notes say what was assumed.
void finish_table(Distribution& table, bool halves, const TableFault& fault);

/// Adds a note of the luminous flux, beside what the file states, to a table with other notes, or one that gives more
/// light than its lamps.
void note_flux(Distribution& table);

}  // namespace vesper::photometry
