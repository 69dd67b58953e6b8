"""The reference of every command, as the command line declares them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import typer

from reports.cli import app


def commands_page() -> str:
    """Markdown: a section for each command, with what it does, its usage and its options."""
    group: Any = typer.main.get_command(app)
    return "\n\n".join(_sections(group, "crankcheck")) + f"\n\n## Exit codes\n\n{_exit_codes()}\n"


def _sections(group: Any, called: str) -> Iterator[str]:
    for name, late in sorted(group.commands.items()):
        command = getattr(late, "loaded", late)
        if command.hidden:
            continue
        full = f"{called} {name}"
        if hasattr(command, "commands"):
            yield from _sections(command, full)
            if not command.invoke_without_command:
                continue
        yield _section(command, full)


def _section(command: Any, called: str) -> str:
    context = typer.Context(command, info_name=called)
    usage = " ".join(command.collect_usage_pieces(context))
    parts = [f"## {called}", _prose(command.help), f"```text\n{called} {usage}\n```"]
    rows = [_row(each, context) for each in command.params if not each.hidden]
    if rows:
        parts.append("\n".join(["| option | default | what |", "|---|---|---|", *rows]))
    return "\n\n".join(parts)


def _row(parameter: Any, context: typer.Context) -> str:
    """One line of the table: how it is written, its default, its purpose."""
    written, told = parameter.get_help_record(context)
    what, _, extra = told.rpartition("  [") if told.endswith("]") else (told, "", "")
    facts = extra.rstrip("]").split("; ") if extra else []
    default = next((fact[9:] for fact in facts if fact.startswith("default: ")), "")
    rest = [fact for fact in facts if not fact.startswith("default: ") and fact != "required"]
    default = "required" if "required" in facts else f"`{default}`" if default else ""
    limits = f" ({', '.join(f'`{fact}`' for fact in rest)})" if rest else ""
    cells = [f"`{written}`", default, f"{_prose(what)}{limits}"]
    return f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in cells)} |"


def _prose(text: str | None) -> str:
    """Help as Markdown: what a page would take for marks stands for itself."""
    told = (text or "").replace("\b", "").replace("*", r"\*").replace("<", "&lt;")
    return told.replace("$", "&#36;").strip()


def _exit_codes() -> str:
    told = app.info.epilog
    assert isinstance(told, str)
    return told
