// What programs print. Text of files cannot reach the terminal but as plain characters of one line.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace vesper::apps {

/// printf into a string, for the conversions c, d, e, f, g, i, s, u, x and %. Texts (%s) are made plain: see
/// one_line().
[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...);

/// Prints format(...) to standard output.
[[gnu::format(printf, 1, 2)]] void print(const char* pattern, ...);
/// Prints lines that are formatted already to standard output; control characters in them are replaced.
void print_text(const std::string& lines);

/// The same of what a file holds: 400 lines at most, then how many more there are.
void print_report(const std::string& lines);

/// Prints "note: TEXT" or "warning: TEXT" to standard error; TEXT is made plain. Of several ranks the first does so, as
/// others have the same to say.
void print_note(const std::string& text);
void print_warning(const std::string& text);
/// Prints notes, at most 20 of a kind and 100 in all, then how many more there are. Notes are of one kind if they
/// differ in numbers and quoted names only. `before`: "note: ", "warning: "; empty: to standard output.
void print_notes(const std::vector<std::string>& notes, const std::string& before = "note: ");
/// Prints "PROGRAM: TEXT" to standard error; TEXT is made plain.
void print_error(const std::string& program, const std::string& text);

}  // namespace vesper::apps
