#include "core/io/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string_view>

#include "core/io/atomic_file.hpp"
#include "core/io/printable_text.hpp"

namespace sweepscope {
namespace {

struct Replacement {
  std::string_view from, to;
};

/// Replaces from left to right, so that what was put in is not read again.
template <std::size_t N>
std::string replaced(std::string_view text, const std::array<Replacement, N>& replacements) {
  std::string out;
  while (!text.empty()) {
    const auto hit = std::find_if(replacements.begin(), replacements.end(),
                                  [&](const Replacement& one) { return text.starts_with(one.from); });
    const bool found = hit != replacements.end();
    out += found ? hit->to : text.substr(0, 1);
    text.remove_prefix(found ? hit->from.size() : 1);
  }
  return out;
}

std::size_t letters(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

/// A number as people read it, with the minus sign that the format has.
std::string shown_number(double value, const std::optional<int>& decimals, std::string_view minus) {
  std::string text = decimals ? fmt::format("{:.{}f}", value, *decimals) : fmt::format("{}", value);
  const bool negative = text.front() == '-';
  if (!negative) return text;
  const bool is_zero = text.find_first_of("123456789in") == std::string::npos;  // "-0.00"; not "-inf", "nan"
  return is_zero ? text.substr(1) : std::string(minus) + text.substr(1);
}

std::string with_unit(const TableColumn& column) {
  return column.unit.empty() ? column.title : fmt::format("{} [{}]", column.title, column.unit);
}

// CSV

/// "offset" in "ms" is offset_ms, as in the curve's CSV.
std::string csv_name(const TableColumn& column) {
  constexpr auto kWords =
      std::to_array<Replacement>({{" ", "_"}, {"/", "_per_"}, {"°", "deg"}, {"%", "percent"}, {"µ", "u"}});
  const std::string title = replaced(column.title, std::to_array<Replacement>({{" ", "_"}}));
  return column.unit.empty() ? title : title + "_" + replaced(column.unit, kWords);
}

std::string csv_field(const std::string& name) {
  const std::string text = printable_text(name);
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  return "\"" + replaced(text, std::to_array<Replacement>({{"\"", "\"\""}})) + "\"";
}

std::string csv_cell(const TableCell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return csv_field(*text);
  if (const auto* number = std::get_if<double>(&cell)) return fmt::format("{}", *number);
  return "";
}

// Markdown

std::string markdown_text(std::string_view name) {
  const std::string text = printable_text(name);
  constexpr auto kEscapes = std::to_array<Replacement>({{"\\", "\\\\"},
                                                        {"|", "\\|"},
                                                        {"*", "\\*"},
                                                        {"_", "\\_"},
                                                        {"`", "\\`"},
                                                        {"~", "\\~"},
                                                        {"<", "&lt;"},
                                                        {"&", "&amp;"},
                                                        {"\r\n", "<br>"},
                                                        {"\n", "<br>"},
                                                        {"\r", "<br>"}});
  return replaced(text, kEscapes);
}

std::string markdown_cell(const TableCell& cell, const TableColumn& column) {
  if (const auto* text = std::get_if<std::string>(&cell)) return markdown_text(*text);
  if (const auto* number = std::get_if<double>(&cell)) return shown_number(*number, column.decimals, "−");
  return "–";
}

std::string padded(const std::string& text, std::size_t width, Alignment alignment) {
  const std::size_t room = width - std::min(width, letters(text));
  const std::size_t before = alignment == Alignment::kLeft     ? 0
                             : alignment == Alignment::kCentre ? room / 2
                                                               : room;
  return std::string(before, ' ') + text + std::string(room - before, ' ');
}

std::string markdown_rule(std::size_t width, Alignment alignment) {
  std::string rule(width, '-');
  if (alignment != Alignment::kLeft) rule.back() = ':';
  if (alignment == Alignment::kCentre) rule.front() = ':';
  return rule;
}

std::string joined(const std::vector<std::string>& parts, const char* between) {
  return fmt::format("{}", fmt::join(parts, between));
}

// LaTeX

/// What LaTeX would read as markup, and letters that not every engine has in text.
constexpr auto kLatexEscapes = std::to_array<Replacement>({
    {"\\", "\\textbackslash{}"},
    {"&", "\\&"},
    {"%", "\\%"},
    {"$", "\\$"},
    {"#", "\\#"},
    {"_", "\\_"},
    {"{", "\\{"},
    {"}", "\\}"},
    {"~", "\\textasciitilde{}"},
    {"^", "\\textasciicircum{}"},
    {"<", "$<$"},
    {">", "$>$"},
    {"|", "$|$"},
    {"\"", "''"},
    {"--", "-{}-{}"},
    {"\r\n", " "},
    {"\n", " "},
    {"\r", " "},
    {"−", "$-$"},
    {"–", "--"},
    {"±", "$\\pm$"},
    {"×", "$\\times$"},
    {"·", "$\\cdot$"},
    {"≤", "$\\leq$"},
    {"≥", "$\\geq$"},
    {"→", "$\\rightarrow$"},
    {"…", "\\ldots{}"},
    {"°", "$^{\\circ}$"},
    {"²", "$^{2}$"},
    {"³", "$^{3}$"},
    {"⁶", "$^{6}$"},
    {"µ", "$\\mu$"},
    {"α", "$\\alpha$"},
    {"β", "$\\beta$"},
    {"γ", "$\\gamma$"},
    {"δ", "$\\delta$"},
    {"ε", "$\\varepsilon$"},
    {"ζ", "$\\zeta$"},
    {"η", "$\\eta$"},
    {"θ", "$\\theta$"},
    {"ι", "$\\iota$"},
    {"κ", "$\\kappa$"},
    {"λ", "$\\lambda$"},
    {"μ", "$\\mu$"},
    {"ν", "$\\nu$"},
    {"ξ", "$\\xi$"},
    {"ο", "$o$"},
    {"π", "$\\pi$"},
    {"ρ", "$\\rho$"},
    {"ς", "$\\varsigma$"},
    {"σ", "$\\sigma$"},
    {"τ", "$\\tau$"},
    {"υ", "$\\upsilon$"},
    {"φ", "$\\varphi$"},
    {"χ", "$\\chi$"},
    {"ψ", "$\\psi$"},
    {"ω", "$\\omega$"},
    {"Γ", "$\\Gamma$"},
    {"Δ", "$\\Delta$"},
    {"Θ", "$\\Theta$"},
    {"Λ", "$\\Lambda$"},
    {"Ξ", "$\\Xi$"},
    {"Π", "$\\Pi$"},
    {"Σ", "$\\Sigma$"},
    {"Υ", "$\\Upsilon$"},
    {"Φ", "$\\Phi$"},
    {"Ψ", "$\\Psi$"},
    {"Ω", "$\\Omega$"},
    {"Α", "A"},
    {"Β", "B"},
    {"Ε", "E"},
    {"Η", "H"},
    {"Κ", "K"},
    {"Μ", "M"},
    {"Ν", "N"},
    {"Τ", "T"},
});

std::string latex_text(std::string_view text) {
  return replaced(printable_text(text), kLatexEscapes);
}

std::string latex_cell(const TableCell& cell, const TableColumn& column) {
  if (const auto* text = std::get_if<std::string>(&cell)) return latex_text(*text);
  if (const auto* number = std::get_if<double>(&cell)) return shown_number(*number, column.decimals, "$-$");
  return "--";
}

/// After a row's end LaTeX reads a "[" or a "*" as its argument.
std::string latex_row(const std::vector<std::string>& cells) {
  std::string row = joined(cells, " & ");
  if (row.starts_with('[') || row.starts_with('*')) row = fmt::format("{{{}}}{}", row[0], row.substr(1));
  return "  " + row + " \\\\\n";
}

}  // namespace

std::string to_csv(const Table& table) {
  std::vector<std::string> fields;
  for (const TableColumn& column : table.columns) fields.push_back(csv_field(csv_name(column)));
  std::string text = joined(fields, ",") + "\n";
  for (const auto& row : table.rows) {
    fields.clear();
    for (const TableCell& cell : row) fields.push_back(csv_cell(cell));
    text += joined(fields, ",") + "\n";
  }
  return text;
}

std::string to_markdown(const Table& table) {
  const std::size_t count = table.columns.size();
  std::vector<std::vector<std::string>> lines(1);
  for (const TableColumn& column : table.columns) lines[0].push_back(markdown_text(with_unit(column)));
  for (const auto& row : table.rows) {
    auto& line = lines.emplace_back();
    for (std::size_t c = 0; c < count; ++c) line.push_back(markdown_cell(row.at(c), table.columns[c]));
  }
  std::vector<std::size_t> widths(count, 3);  // a rule has three dashes at least
  for (const auto& line : lines) {
    for (std::size_t c = 0; c < count; ++c) widths[c] = std::max(widths[c], letters(line[c]));
  }
  std::vector<std::string> rules;
  for (std::size_t c = 0; c < count; ++c)
    rules.push_back(markdown_rule(widths[c], table.columns[c].alignment));
  std::string text = table.title.empty() ? "" : fmt::format("**{}**\n\n", markdown_text(table.title));
  for (std::size_t l = 0; l < lines.size(); ++l) {
    for (std::size_t c = 0; c < count; ++c)
      lines[l][c] = padded(lines[l][c], widths[c], table.columns[c].alignment);
    text += fmt::format("| {} |\n", joined(lines[l], " | "));
    if (l == 0) text += fmt::format("| {} |\n", joined(rules, " | "));
  }
  return text;
}

std::string to_latex(const Table& table) {
  std::string letters_of_columns;
  std::vector<std::string> cells;
  for (const TableColumn& column : table.columns) {
    letters_of_columns += column.alignment == Alignment::kLeft     ? 'l'
                          : column.alignment == Alignment::kCentre ? 'c'
                                                                   : 'r';
    cells.push_back(latex_text(with_unit(column)));
  }
  std::string text = table.title.empty() ? "" : fmt::format("% {}\n", latex_text(table.title));
  text += fmt::format("\\begin{{tabular}}{{{}}}\n  \\toprule\n", letters_of_columns) + latex_row(cells) +
          "  \\midrule\n";
  for (const auto& row : table.rows) {
    cells.clear();
    for (std::size_t c = 0; c < table.columns.size(); ++c)
      cells.push_back(latex_cell(row.at(c), table.columns[c]));
    text += latex_row(cells);
  }
  return text + "  \\bottomrule\n\\end{tabular}\n";
}

Result<void> write_table(const std::filesystem::path& path, const Table& table) {
  const std::string extension = path.extension().string();
  if (extension == ".csv") return write_file(path, to_csv(table));
  if (extension == ".md") return write_file(path, to_markdown(table));
  if (extension == ".tex") return write_file(path, to_latex(table));
  return failure(ExitCode::kWrongUsage,
                 fmt::format("{}: a table is written as .csv, .md or .tex", path.string()));
}

}  // namespace sweepscope
