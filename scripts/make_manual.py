#!/usr/bin/env python3
"""Writes manual pages and the shells' completions from what the program's --help says, which it makes of the descriptions
of its options.

    scripts/make_manual.py PROGRAM SHARE    # SHARE/man/man1, and where bash, zsh and fish look below SHARE
"""
import re
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

COLUMN = 28  # where descriptions begin


@dataclass
class Item:
    """An option, an argument or a command: its names, what stands behind them, and what it is for."""
    names: list[str]
    value: str
    text: str

    @property
    def takes_value(self) -> bool:
        return bool(self.value)

    @property
    def choices(self) -> list[str]:
        """The words of a bracket at the end such as [draft, normal or high]; none for numbers and what else is legal."""
        bracket = re.search(r"\[([\w.-]+(?:, [\w.-]+)*(?: or [\w.-]+)?)\]$", self.text)
        words = re.split(r", | or ", bracket[1]) if bracket else []
        return words if len(words) > 1 and not any(re.fullmatch(r"[\d.-]+", word) for word in words) else []


@dataclass
class Command:
    words: list[str]
    summary: str = ""
    usage: str = ""
    sections: dict[str, list[Item]] = field(default_factory=dict)
    footer: str = ""

    @property
    def title(self) -> str:
        return "-".join(["photohull", *self.words])

    def items(self, section: str) -> list[Item]:
        return self.sections.get(section, [])


def item_of(head: str, text: str) -> Item:
    names, _, value = head.partition(" ")
    return Item(names.split(","), value, text)


def parse(words: list[str], text: str) -> Command:
    command = Command(words)
    section, footer = "", []
    for line in text.splitlines():
        if line.startswith("Usage: "):
            command.usage = re.sub(r"^Usage: \S+", "photohull", line)
        elif not command.usage:
            command.summary = f"{command.summary} {line.strip()}".strip()
        elif re.fullmatch(r"(Options|Positionals|Subcommands):", line):
            section = line[:-1]
            command.sections[section] = []
        elif section and line.startswith("  "):
            head, rest = line[:COLUMN].strip(), line[COLUMN:].strip()
            if line[COLUMN - 1:COLUMN] not in (" ", ""):  # a head that is longer has a line of its own
                head, rest = line.strip(), ""
            if head:
                head, _, more = head.partition("  ")
                command.sections[section].append(item_of(head, f"{more} {rest}".strip()))
            else:
                last = command.sections[section][-1]
                last.text = f"{last.text} {rest}".strip()
        elif line.strip() or footer:
            section = ""
            footer.append(line)
    command.footer = "\n".join(footer).rstrip()
    return command


def read_commands(program: str) -> list[Command]:
    """The program itself, and all commands and those below them."""
    found, waiting = [], [[]]
    while waiting:
        words = waiting.pop(0)
        text = subprocess.run([program, *words, "--help"], check=True, capture_output=True, text=True).stdout
        found.append(parse(words, text))
        waiting += [[*words, item.names[0]] for item in found[-1].items("Subcommands")]
    return found


def troff(text: str) -> str:
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return re.sub(r"(?m)^([.'])", r"\\&\1", text)


def man_page(command: Command, version: str) -> str:
    name = troff(command.title)
    lines = [f'.TH {command.title.upper()} 1 "" "photohull {version}" "photohull"', ".SH NAME",
             f"{name} \\- {troff(command.summary)}", ".SH SYNOPSIS", f".B {troff(command.usage)}"]
    for section, title in (("Positionals", "ARGUMENTS"), ("Options", "OPTIONS"), ("Subcommands", "COMMANDS")):
        if command.items(section):
            lines.append(f".SH {title}")
        for item in command.items(section):
            lines += [".TP", f".B {troff(', '.join(item.names))} {troff(item.value)}".rstrip(), troff(item.text) or "\\&"]
    if command.footer:
        lines += [".SH NOTES", ".nf", troff(command.footer), ".fi"]
    if command.items("Subcommands"):
        pages = [f".BR {troff(command.title)}\\-{troff(item.names[0])} (1)" for item in command.items("Subcommands")]
        lines += [".SH SEE ALSO", *pages]
    return "\n".join(lines) + "\n"


def shell_quoted(text: str) -> str:
    return "'" + text.replace("'", "'\\''") + "'"


def bash_completion(commands: list[Command]) -> str:
    lines = ["# Completion of photohull for bash.", "_photohull() {",
             "  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} command= word words= files=yes",
             "  for word in \"${COMP_WORDS[@]:1:COMP_CWORD-1}\"; do", "    case \"$command $word\" in"]
    for command in commands:
        if command.words:
            before = " ".join(command.words[:-1])
            lines.append(f"      '{before} {command.words[-1]}') command='{' '.join(command.words)}' ;;")
    lines += ["    esac", "  done", "  case \"$command $before\" in"]
    for command in commands:
        for item in command.items("Options"):
            if item.choices:
                names = "|".join(f"'{' '.join(command.words)} {name}'" for name in item.names)
                lines.append(f"    {names}) words='{' '.join(item.choices)}' files= ;;")
    lines += ["    *)", "      case $command in"]
    for command in commands:
        words = [name for item in command.items("Options") for name in item.names]
        words += [item.names[0] for item in command.items("Subcommands")]
        files = " files=" if command.items("Subcommands") else ""
        lines.append(f"        '{' '.join(command.words)}') words='{' '.join(words)}'{files} ;;")
    lines += ["      esac", "      [[ $current != -* && -n $files ]] && words=", "      ;;", "  esac",
              "  mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$current\"; [[ -n $files && $current != -* ]] && compgen -f -- \"$current\")",
              "}", "complete -o filenames -F _photohull photohull"]
    return "\n".join(lines) + "\n"


def zsh_spec(item: Item) -> list[str]:
    text = re.sub(r"([\[\]:])", r"\\\1", item.text)
    action = f"({' '.join(item.choices)})" if item.choices else "_files"
    value = f":value:{action}" if item.takes_value else ""
    return [shell_quoted(f"{name}[{text}]{value}") for name in item.names]


def zsh_completion(commands: list[Command]) -> str:
    lines = ["#compdef photohull", "# Completion of photohull for zsh.", "_photohull() {", "  local command=${words[2]}",
             "  if (( CURRENT == 2 )); then", "    local -a commands=("]
    lines += [f"      {shell_quoted(item.names[0] + ':' + item.text)}" for item in commands[0].items("Subcommands")]
    lines += ["    )", "    _describe command commands", "    return", "  fi", "  shift words", "  (( CURRENT-- ))", "  case $command in"]
    for command in commands:
        if len(command.words) == 1:
            specs = [spec for item in command.items("Options") for spec in zsh_spec(item)]
            lines.append(f"    {command.words[0]}) _arguments {' '.join(specs)} '*:file:_files' ;;")
    return "\n".join([*lines, "  esac", "}", "_photohull \"$@\""]) + "\n"


def fish_completion(commands: list[Command]) -> str:
    lines = ["# Completion of photohull for fish."]
    for command in commands:
        condition = f"__fish_seen_subcommand_from {command.words[-1]}" if command.words else "__fish_use_subcommand"
        for item in command.items("Subcommands"):
            lines.append(f"complete -c photohull -n {shell_quoted(condition)} -f -a {item.names[0]} -d {shell_quoted(item.text)}")
        for item in command.items("Options"):
            names = " ".join(f"-l {name[2:]}" if name.startswith("--") else f"-s {name[1:]}" for name in item.names)
            value = f" -x -a {shell_quoted(' '.join(item.choices))}" if item.choices else " -r" if item.takes_value else ""
            lines.append(f"complete -c photohull -n {shell_quoted(condition)} {names}{value} -d {shell_quoted(item.text)}")
    return "\n".join(lines) + "\n"


def main() -> int:
    program, share = sys.argv[1], Path(sys.argv[2])
    commands = read_commands(program)
    version = subprocess.run([program, "--version"], check=True, capture_output=True, text=True).stdout.split()[-1]
    files = {f"man/man1/{command.title}.1": man_page(command, version) for command in commands}
    files |= {"bash-completion/completions/photohull": bash_completion(commands),
              "zsh/vendor-completions/_photohull": zsh_completion(commands),
              "fish/vendor_completions.d/photohull.fish": fish_completion(commands)}
    for name, text in files.items():
        path = share / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    print(f"{len(files)} files in {share}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
