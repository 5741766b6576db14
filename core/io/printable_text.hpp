#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace sweepscope {

/// Names from outside (topics, joints, frames, paths), made safe to show anywhere. Valid UTF-8 is kept.
/// Characters that control a terminal, change the writing direction, break lines or are forbidden in XML are
/// escaped: a byte as \xNN (control characters, DEL, bytes that are no UTF-8), a code point beyond ASCII as
/// \u{NNNN} (C1 controls, bidirectional controls, line and paragraph separators, U+FFFE and U+FFFF). Text
/// that is already printable is unchanged, so applying it twice is harmless.
std::string printable_line(std::string_view text);

/// The same for text of several lines: line breaks are kept.
std::string printable_text(std::string_view text);

/// The same for a message that may end with a list: a line break is kept where two spaces follow, as before
/// the lines of a list; any other one came with a name.
std::string printable_message(std::string_view text);

/// Escapes only the bytes that are not valid UTF-8: for formats with escapes of their own, such as JSON.
std::string valid_utf8(std::string_view text);

/// A word quoted for a shell: in 'single quotes' unless no character needs them.
std::string shell_word(const std::string& word);

/// A printable text inside XML or HTML: markup characters and double quotes as entities.
std::string markup_escaped(std::string_view printable);
/// Any text as one printable line inside XML or HTML; for attributes too, where a line break would be read as
/// a space.
std::string markup_line(std::string_view text);

/// A document as JSON, indented by two spaces, with a line end. Strings that are not UTF-8 pass through
/// valid_utf8, and the control characters that JSON allows are written as \uNNNN.
std::string json_text(nlohmann::ordered_json document);

/// A text as a JSON string, in double quotes, which is one of YAML as well.
std::string json_string(std::string_view text);

}  // namespace sweepscope
