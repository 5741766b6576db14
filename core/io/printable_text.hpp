#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace sweepscope {

/// Names from outside (topics, joints, frames, paths) as they can be shown anywhere. Valid UTF-8 is kept.
/// What steers a terminal, turns the direction of writing, breaks lines or is forbidden in XML is escaped: a
/// byte as \xNN (control characters, DEL, bytes that are no UTF-8), a code point beyond ASCII as \u{NNNN} (C1
/// controls, bidirectional controls, line and paragraph separators, U+FFFE and U+FFFF). What is printable
/// already comes back as it is, so applying it twice does no harm.
std::string printable_line(std::string_view text);

/// The same for text of several lines: line breaks are kept.
std::string printable_text(std::string_view text);

/// The same for a message that may end with a list: a line break is kept where two spaces follow, as before
/// the lines of a list; any other one came with a name.
std::string printable_message(std::string_view text);

/// The text with only the bytes that are no UTF-8 escaped: for formats that have escapes of their own for the
/// rest, such as JSON.
std::string valid_utf8(std::string_view text);

/// A word as a shell takes it: in 'single quotes' unless all of it is plain.
std::string shell_word(const std::string& word);

/// A printable text inside XML or HTML: markup characters and double quotes as entities.
std::string markup_escaped(std::string_view printable);

/// A document as JSON, indented by two spaces, with a line end. Strings that are no UTF-8 are made so by
/// valid_utf8, and the control characters that JSON lets through are written as \uNNNN.
std::string json_text(nlohmann::ordered_json document);

}  // namespace sweepscope
