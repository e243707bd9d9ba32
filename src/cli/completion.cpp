#include "cli/completion.h"

#include "cli/offers.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

namespace gnomon {

namespace {

std::string joined(const std::vector<std::string>& words, const char* with = " ") {
  return fmt::format("{}", fmt::join(words, with));
}

std::vector<const CLI::App*> verbsOf(const CLI::App& program) {
  return program.get_subcommands([](const CLI::App*) { return true; });
}

std::vector<std::string> verbNames(const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* verb : verbsOf(program)) names.push_back(verb->get_name());
  return names;
}

bool isPositional(const CLI::Option* option) {
  return option->get_lnames().empty() && option->get_snames().empty();
}

bool takesValue(const CLI::Option* option) {
  return option->get_items_expected_max() > 0;
}

// "--maps", "-o", ...: what is typed.
std::vector<std::string> namesOf(const CLI::Option* option) {
  std::vector<std::string> names;
  for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

// Up to its first full stop or semicolon, for where there is room for a line.
std::string firstClause(const std::string& text) {
  return text.substr(0, text.find_first_of(";\n"));
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  for (size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + with.size()))
    text.replace(at, what.size(), with);
  return text;
}

// Within single quotes of a shell.
std::string quoted(const std::string& text) {
  return "'" + replaced(text, "'", "'\\''") + "'";
}

// --- bash ----------------------------------------------------------------------------------------------

std::string bashCase(const std::vector<std::string>& names, const Offers& offers) {
  const std::string values = joined(offers.values);
  std::string action;
  switch (offers.kind) {
    case Offers::Kind::Nothing:
      action = "COMPREPLY=()";
      break;
    case Offers::Kind::Files:
      action = fmt::format("COMPREPLY=($(compgen -f -W '{}' -- \"$cur\"))", values);
      break;
    case Offers::Kind::Folders:
      action = "COMPREPLY=($(compgen -d -- \"$cur\"))";
      break;
    case Offers::Kind::OneOf:
      action = fmt::format("COMPREPLY=($(compgen -W '{}' -- \"$cur\"))", values);
      break;
    case Offers::Kind::SomeOf:
      action = fmt::format("_gnomon_some '{}'", values);
      break;
  }
  return fmt::format("        {}) {}; return ;;\n", joined(names, "|"), action);
}

std::string bashScript(const CLI::App& program) {
  std::string text = R"(# bash completion for gnomon; `gnomon completion bash` writes it
_gnomon_some() {  # the last of a list with commas
  local before=""
  [[ $cur == *,* ]] && before=${cur%,*},
  COMPREPLY=($(compgen -P "$before" -W "$1" -- "${cur##*,}"))
  compopt -o nospace 2>/dev/null
}
_gnomon() {
  local cur=${COMP_WORDS[COMP_CWORD]} prev="" verb=${COMP_WORDS[1]}
  ((COMP_CWORD > 0)) && prev=${COMP_WORDS[COMP_CWORD-1]}
  COMPREPLY=()
)";
  text += fmt::format(
      "  if ((COMP_CWORD == 1)); then COMPREPLY=($(compgen -W '{} --help --version' -- \"$cur\")); return; fi\n",
      joined(verbNames(program)));
  text += "  case $verb in\n";
  for (const CLI::App* verb : verbsOf(program)) {
    std::vector<std::string> flags;
    std::string cases, positional = "COMPREPLY=()";
    for (const CLI::Option* option : verb->get_options()) {
      const Offers& offers = offersOf(option);
      if (isPositional(option)) {
        if (offers.kind == Offers::Kind::Files)
          positional = fmt::format("COMPREPLY=($(compgen -f -W '{}' -- \"$cur\"))", joined(offers.values));
        else if (offers.kind == Offers::Kind::Folders)
          positional = "COMPREPLY=($(compgen -d -- \"$cur\"))";
        else if (offers.kind == Offers::Kind::OneOf)
          positional = fmt::format("COMPREPLY=($(compgen -W '{}' -- \"$cur\"))", joined(offers.values));
        continue;
      }
      for (const std::string& name : namesOf(option)) flags.push_back(name);
      if (takesValue(option)) cases += bashCase(namesOf(option), offers);
    }
    text += fmt::format("    {})\n      case $prev in\n{}      esac\n", verb->get_name(), cases);
    text += fmt::format("      if [[ $cur == -* ]]; then COMPREPLY=($(compgen -W '{}' -- \"$cur\")); else {}; fi ;;\n",
                        joined(flags), positional);
  }
  return text + "  esac\n}\ncomplete -o filenames -o bashdefault -F _gnomon gnomon\n";
}

// --- zsh -----------------------------------------------------------------------------------------------

std::string zshText(const std::string& text) {
  std::string out;
  for (const char c : firstClause(text)) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

std::string zshAction(const Offers& offers) {
  switch (offers.kind) {
    case Offers::Kind::Files:
      return offers.values.empty()
                 ? "_files"
                 : fmt::format("_alternative \"files:file:_files\" \"names:name:({})\"", joined(offers.values));
    case Offers::Kind::Folders:
      return "_files -/";
    case Offers::Kind::OneOf:
      return "(" + joined(offers.values) + ")";
    case Offers::Kind::SomeOf:
      return "_values -s , value " + joined(offers.values);
    case Offers::Kind::Nothing:
      break;
  }
  return " ";
}

std::string zshScript(const CLI::App& program) {
  std::string text = "#compdef gnomon\n# zsh completion for gnomon; `gnomon completion zsh` writes it\n_gnomon() {\n";
  text += "  local -a verbs=(\n";
  for (const CLI::App* verb : verbsOf(program))
    text += fmt::format("    {}\n", quoted(verb->get_name() + ":" + zshText(verb->get_description())));
  text += "  )\n  if ((CURRENT == 2)); then _describe verb verbs; return; fi\n";
  text += "  local verb=${words[2]}\n  shift words; ((CURRENT--))\n  case $verb in\n";
  for (const CLI::App* verb : verbsOf(program)) {
    text += fmt::format("    {})\n      _arguments -s -S", verb->get_name());
    for (const CLI::Option* option : verb->get_options()) {
      if (isPositional(option)) {
        text += " \\\n        " + quoted(fmt::format("1:{}:{}", option->get_name(), zshAction(offersOf(option))));
        continue;
      }
      for (const std::string& name : namesOf(option))
        text +=
            " \\\n        " + quoted(fmt::format("*{}[{}]{}", name, zshText(option->get_description()),
                                                 takesValue(option) ? ":value:" + zshAction(offersOf(option)) : ""));
    }
    text += "\n      ;;\n";
  }
  return text + "  esac\n}\n_gnomon \"$@\"\n";
}

// --- fish ----------------------------------------------------------------------------------------------

std::string fishText(const std::string& text) {
  return "'" + replaced(replaced(firstClause(text), "\\", "\\\\"), "'", "\\'") + "'";
}

std::string fishValues(const Offers& offers) {
  switch (offers.kind) {
    case Offers::Kind::Files:
      return offers.values.empty() ? " -r -F" : fmt::format(" -r -F -a '{}'", joined(offers.values));
    case Offers::Kind::Folders:
      return " -x -a '(__fish_complete_directories)'";
    case Offers::Kind::OneOf:
      return fmt::format(" -x -a '{}'", joined(offers.values));
    case Offers::Kind::SomeOf:
      return fmt::format(" -x -a '(__fish_complete_list , \"printf %s\\\\n {}\")'", joined(offers.values));
    case Offers::Kind::Nothing:
      break;
  }
  return " -x";
}

std::string fishScript(const CLI::App& program) {
  std::string text = "# fish completion for gnomon; `gnomon completion fish` writes it\ncomplete -c gnomon -f\n";
  for (const CLI::App* verb : verbsOf(program))
    text += fmt::format("complete -c gnomon -n __fish_use_subcommand -a {} -d {}\n", verb->get_name(),
                        fishText(verb->get_description()));
  for (const CLI::App* verb : verbsOf(program)) {
    const std::string where = fmt::format("complete -c gnomon -n '__fish_seen_subcommand_from {}'", verb->get_name());
    for (const CLI::Option* option : verb->get_options()) {
      text += where;
      for (const std::string& name : option->get_snames()) text += " -s " + name;
      for (const std::string& name : option->get_lnames()) text += " -l " + name;
      if (takesValue(option))
        text +=
            isPositional(option) ? replaced(fishValues(offersOf(option)), " -x", " -f") : fishValues(offersOf(option));
      text += " -d " + fishText(option->get_description()) + "\n";
    }
  }
  return text;
}

// --- the manual ----------------------------------------------------------------------------------------

// A line that troff takes for text: no request at its beginning, no escape within.
std::string troff(const std::string& text) {
  const std::string line = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
  return line.starts_with(".") || line.starts_with("'") ? "\\&" + line : line;
}

std::string troffLines(const std::string& text) {
  std::string out;
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = text.substr(at, end - at);
    out += line.empty() ? ".PP\n" : troff(line) + "\n";
    at = end + 1;
  }
  return out;
}

std::string manualOption(const CLI::Option* option) {
  std::string names;
  for (const std::string& name : namesOf(option)) names += (names.empty() ? "\\fB" : "\\fR, \\fB") + troff(name);
  std::string text = fmt::format(".TP\n{}\\fR", isPositional(option) ? "\\fB" + troff(option->get_name()) : names);
  if (takesValue(option) && !isPositional(option)) text += " \\fI" + troff(option->get_type_name()) + "\\fR";
  text += "\n" + troff(option->get_description()) + "\n";
  if (!option->get_default_str().empty()) text += fmt::format("Default: {}\\&.\n", troff(option->get_default_str()));
  return text;
}

std::string manualVerb(const CLI::App& verb) {
  std::string text = fmt::format(".SS \"gnomon {}\"\n{}\\&.\n", verb.get_name(), troff(verb.get_description()));
  std::vector<std::string> headings;
  for (const CLI::Option* option : verb.get_options()) {
    const std::string heading = isPositional(option) ? "" : option->get_group();
    if (std::find(headings.begin(), headings.end(), heading) == headings.end()) headings.push_back(heading);
  }
  for (const std::string& heading : headings) {
    if (!heading.empty()) text += fmt::format(".PP\n\\fI{}\\fR\n", troff(heading));
    for (const CLI::Option* option : verb.get_options())
      if ((isPositional(option) ? "" : option->get_group()) == heading) text += manualOption(option);
  }
  return text;
}

}  // namespace

const std::vector<std::string>& completionShells() {
  static const std::vector<std::string> shells = {"bash", "zsh", "fish"};
  return shells;
}

std::string completionScript(const CLI::App& program, const std::string& shell) {
  return shell == "bash" ? bashScript(program) : shell == "zsh" ? zshScript(program) : fishScript(program);
}

std::string manualPage(const CLI::App& program, const std::string& version) {
  std::string text = fmt::format(".TH GNOMON 1 \"\" \"gnomon {}\" \"User Commands\"\n.SH NAME\ngnomon \\- {}\n",
                                 version, troff(program.get_description()));
  text += ".SH SYNOPSIS\n";
  for (const CLI::App* verb : verbsOf(program))
    text += fmt::format(".B gnomon {}\n.RI [ options ]\n.br\n", verb->get_name());
  text += ".SH SUBCOMMANDS\n";
  for (const CLI::App* verb : verbsOf(program)) text += manualVerb(*verb);
  return text + ".SH \"EXIT CODES AND ENVIRONMENT\"\n" + troffLines(program.get_footer());
}

}  // namespace gnomon
