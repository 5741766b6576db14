#include "app/manual.hpp"

#include <fmt/format.h>

#include <map>
#include <sstream>
#include <string_view>
#include <vector>

namespace sweepscope::app {
namespace {

/// An option as pages and shells need it.
struct Described {
  std::vector<std::string> names;  // "-o", "--output"; of a positional its name
  std::string value;               // the value's name; empty: a flag
  std::vector<std::string> choices;
  std::string description, standard;  // `standard`: the default
  std::string group;                  // its heading in --help
  bool positional = false, required = false;
};

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, at);) parts.push_back(part);
  return parts;
}

Described described(const CLI::Option& option) {
  Described out;
  out.positional = option.get_positional();
  if (out.positional) out.names.push_back(option.get_name());
  for (const std::string& name : option.get_snames()) out.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) out.names.push_back("--" + name);
  out.description = option.get_description();
  out.standard = option.get_default_str();
  out.required = option.get_required();
  out.group = option.get_group();
  if (option.get_expected_max() == 0) return out;
  // CLI11 writes "NAME:CHECK"; names such as FROM:TO:STEP hold colons themselves.
  std::string type = option.get_type_name();
  const auto open = type.find(":{"), close = type.rfind('}');
  if (open != type.npos && close != type.npos)
    out.choices = split(type.substr(open + 2, close - open - 2), ',');
  for (const std::string_view check : {":{", ":INT in", ":FLOAT in", ":POSITIVE", ":NONNEGATIVE"})
    if (const auto at = type.find(check); at != type.npos) type.resize(at);
  out.value = type.empty() ? "VALUE" : type;
  return out;
}

std::vector<Described> options_of(const CLI::App& command) {
  std::vector<Described> options;
  for (const CLI::Option* option : command.get_options())
    if (!option->get_group().empty()) options.push_back(described(*option));
  return options;
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

std::string replaced(const std::string& text, const std::map<char, std::string>& by) {
  std::string out;
  for (const char c : text) {
    const auto found = by.find(c);
    out += found == by.end() ? std::string(1, c) : found->second;
  }
  return out;
}

// ---- the manual page

std::string roff(const std::string& text) {
  std::string out =
      replaced(text, {{'\\', "\\e"}, {'-', "\\-"}, {'~', "\\(ti"}, {'^', "\\(ha"}, {'`', "\\(ga"}});
  if (!out.empty() && (out.front() == '.' || out.front() == '\'')) out.insert(0, "\\&");
  return out;
}

std::string roff_lines(const std::string& text) {
  std::string out;
  for (const std::string& line : split(text, '\n')) out += roff(line) + "\n";
  return out;
}

std::string man_option(const Described& option) {
  std::string names;
  for (const std::string& name : option.names)
    names += (names.empty() ? "" : ", ") + fmt::format("\\fB{}\\fR", roff(name));
  if (!option.positional && !option.value.empty()) names += fmt::format(" \\fI{}\\fR", roff(option.value));
  std::string text = fmt::format(".TP\n{}\n{}", names, roff(option.description));
  std::string choices;
  for (const std::string& choice : option.choices) choices += (choices.empty() ? "" : ", ") + choice;
  if (!choices.empty()) text += roff(" (" + choices + ")");
  if (!option.standard.empty()) text += roff(fmt::format(" [{}]", option.standard));
  return text + "\n";
}

std::string man_command(const CLI::App& app, const CLI::App& command) {
  const std::vector<Described> options = options_of(command);
  std::string usage, list;
  for (const Described& option : options)
    if (option.positional) {
      usage += " \\fI" + roff(option.names.front()) + "\\fR";
      list += man_option(option);
    }
  for (const std::string& group : command.get_groups()) {
    if (group != "Options") list += fmt::format(".PP\n\\fB{}\\fR\n", roff(group));
    for (const Described& option : options)
      if (!option.positional && option.group == group) list += man_option(option);
  }
  std::string text =
      fmt::format(".SS {0} {1}\n{4}.PP\n\\fB{0} {1}\\fR [\\fIOPTIONS\\fR]{2}\n{3}", app.get_name(),
                  command.get_name(), usage, list, roff_lines(command.get_description()));
  const std::string footer = command.get_footer();
  if (!footer.empty()) text += ".PP\n.nf\n" + roff_lines(footer) + ".fi\n";
  return text;
}

constexpr std::string_view kExitCodes =
    ".SH EXIT STATUS\n.TP\n0\nDone.\n.TP\n1\nAn offset lies outside of what --expect allows.\n.TP\n2\nWrong usage, or an output cannot be written.\n.TP\n3\nAn input "
    "cannot be read.\n.TP\n4\nThe offset cannot be determined from this recording; the result says "
    "why.\n.TP\n5\nA picture or value differs from what a script of view expects.\n.TP\n130\nInterrupted.\n";

// ---- completions

std::string words_of(const std::vector<Described>& options, bool with_values) {
  std::string words;
  for (const Described& option : options) {
    if (option.positional || (with_values && option.value.empty())) continue;
    for (const std::string& name : option.names) words += (words.empty() ? "" : " ") + name;
  }
  return words;
}

std::string joined(const std::vector<std::string>& parts, const std::string& between) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : between) + part;
  return text;
}

/// The first sentence or clause, for lists.
std::string brief(const std::string& description) {
  const auto end = description.find_first_of(":;(\n");
  std::string text = description.substr(0, end);
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

std::string in_quotes(const std::string& text) {
  return "'" + replaced(text, {{'\'', "'\\''"}}) + "'";
}

}  // namespace

std::string man_page(const CLI::App& app) {
  std::string text = fmt::format(
      ".TH SWEEPSCOPE 1 \"\" \"sweepscope {0}\" \"User Commands\"\n.SH NAME\n{1} \\- find the time offset "
      "between a "
      "laser scanner and its motor, and see it\n.SH SYNOPSIS\n\\fB{1}\\fR \\fISUBCOMMAND\\fR "
      "[\\fIOPTIONS\\fR] ...\n"
      ".SH DESCRIPTION\n{2}",
      SWEEPSCOPE_VERSION, app.get_name(), roff_lines(app.get_description()));
  for (const Described& option : options_of(app)) text += man_option(option);
  text += ".SH SUBCOMMANDS\n";
  for (const CLI::App* command : commands_of(app)) text += man_command(app, *command);
  const std::string footer = app.get_footer();  // its first line is its heading
  return text + std::string(kExitCodes) + ".SH EXAMPLES\n.nf\n" +
         roff_lines(footer.substr(footer.find('\n') + 1)) + ".fi\n";
}

std::string bash_completion(const CLI::App& app) {
  std::string names, values, options;
  for (const CLI::App* command : commands_of(app)) {
    const auto all = options_of(*command);
    names += (names.empty() ? "" : "|") + command->get_name();
    options += fmt::format("    {}) words='{}' ;;\n", command->get_name(), words_of(all, false));
    for (const Described& option : all)
      if (!option.choices.empty())
        for (const std::string& name : option.names)
          values += fmt::format("    {}:{}) words='{}' ;;\n", command->get_name(), name,
                                joined(option.choices, " "));
    if (const std::string with_value = words_of(all, true); !with_value.empty())
      values += fmt::format("    {0}:{1}) return ;;\n", command->get_name(),
                            replaced(with_value, {{' ', "|" + command->get_name() + ":"}}));
  }
  return fmt::format(
      "# bash completion of sweepscope\n"
      "_sweepscope() {{\n"
      "  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD-1]}} command= words= i\n"
      "  COMPREPLY=()\n"
      "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
      "    case ${{COMP_WORDS[i]}} in {0}) command=${{COMP_WORDS[i]}}; break ;; esac\n"
      "  done\n"
      "  case $command:$previous in\n"
      "{1}"
      "  esac\n"
      "  if [ -z \"$words\" ]; then case $command in\n"
      "    '') words='{2} {3}' ;;\n"
      "{4}"
      "  esac; [[ -z $command || $current == -* ]] || return; fi\n"
      "  COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n"
      "}}\n"
      "complete -o bashdefault -o default -F _sweepscope sweepscope\n",
      names, values, replaced(names, {{'|', " "}}), words_of(options_of(app), false), options);
}

namespace {

std::string zsh_text(const std::string& text) {
  return replaced(brief(text), {{'[', "("}, {']', ")"}, {':', "\\:"}, {'\'', "'\\''"}});
}

std::string zsh_option(const Described& option) {
  if (option.positional) return fmt::format("        '*:{}:_files'\n", option.names.front());
  const std::string values =
      option.choices.empty() ? std::string("_files") : "(" + joined(option.choices, " ") + ")";
  std::string text;
  for (const std::string& name : option.names)
    text += fmt::format(
        "        '*{}[{}]{}'\n", name, zsh_text(option.description),
        option.value.empty() ? "" : fmt::format(":{}:{}", replaced(option.value, {{':', "\\:"}}), values));
  return text;
}

}  // namespace

std::string zsh_completion(const CLI::App& app) {
  std::string commands, cases;
  for (const CLI::App* command : commands_of(app)) {
    commands += fmt::format("    '{}:{}'\n", command->get_name(), zsh_text(command->get_description()));
    std::string options;
    for (const Described& option : options_of(*command)) options += zsh_option(option);
    cases += fmt::format("    {})\n      options=(\n{}      ) ;;\n", command->get_name(), options);
  }
  return fmt::format(
      "#compdef sweepscope\n"
      "_sweepscope() {{\n"
      "  local -a commands options\n"
      "  commands=(\n{}  )\n"
      "  if (( CURRENT == 2 )); then _describe subcommand commands; return; fi\n"
      "  case $words[2] in\n{}  esac\n"
      "  shift words; (( CURRENT-- ))\n"
      "  _arguments -s $options\n"
      "}}\n"
      "_sweepscope \"$@\"\n",
      commands, cases);
}

std::string fish_completion(const CLI::App& app) {
  std::string text = "# fish completion of sweepscope\n";
  for (const CLI::App* command : commands_of(app)) {
    text += fmt::format("complete -c sweepscope -f -n __fish_use_subcommand -a {} -d {}\n",
                        command->get_name(), in_quotes(brief(command->get_description())));
    for (const Described& option : options_of(*command)) {
      if (option.positional) continue;
      text += fmt::format("complete -c sweepscope -n '__fish_seen_subcommand_from {}'", command->get_name());
      for (const std::string& name : option.names)
        text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      if (!option.choices.empty()) text += " -x -a " + in_quotes(joined(option.choices, " "));
      if (option.choices.empty() && !option.value.empty()) text += " -r";
      text += " -d " + in_quotes(brief(option.description)) + "\n";
    }
  }
  return text;
}

void declare_manual(CLI::App& app) {
  const auto print = [](const std::string& text) {
    fmt::print("{}", text);
    throw CLI::Success();
  };
  app.add_flag_callback("--man", [&app, print] { print(man_page(app)); })->group("");
  app.add_option_function<std::string>("--completion",
                                       [&app, print](const std::string& shell) {
                                         print(shell == "bash"  ? bash_completion(app)
                                               : shell == "zsh" ? zsh_completion(app)
                                                                : fish_completion(app));
                                       })
      ->check(CLI::IsMember({"bash", "zsh", "fish"}))
      ->group("");
}

}  // namespace sweepscope::app
