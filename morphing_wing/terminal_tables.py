"""Tables for a terminal."""

from __future__ import annotations

import shutil
from collections.abc import Iterable, Sequence

from rich.console import Console
from rich.table import Table

__all__ = ["console", "show", "text_table"]


def console() -> Console:
    """Return a console on standard output, 132 columns wide where that has no width of its own."""
    return Console(width=shutil.get_terminal_size((132, 40)).columns)


def show(parts: Iterable[Table | str]) -> None:
    """Print tables, a blank line above each, and sentences as they are. Call on one rank."""
    to = console()
    for part in parts:
        if not isinstance(part, str):
            to.print()
        to.print(part, highlight=False, markup=False)


def text_table(
    title: str, headings: Sequence[str], rows: Iterable[Sequence[str]], caption: str | None = None
) -> Table:
    """Return a table of texts, its title on the left."""
    table = Table(title=title, title_justify="left", caption=caption, caption_justify="left")
    for heading in headings:
        table.add_column(heading)
    for row in rows:
        table.add_row(*row)
    return table
