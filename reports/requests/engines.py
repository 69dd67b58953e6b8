"""`crankcheck engines`: the engines."""

from __future__ import annotations

from dataclasses import dataclass

from rich.console import Console
from rich.table import Table
from rich.text import Text

from sim.registry import available, brought, engine


@dataclass(frozen=True)
class EnginesRequest:
    """What `engines` was asked for, as given."""

    settings: bool = False

    def run(self, console: Console, progress: Console) -> int:
        """The engines: version, or the command that installs them; profiles, also with settings."""
        for entry in (*available(), *brought()):
            state = entry.version or entry.broken or f"not installed: {entry.install}"
            console.print(Text(f"{entry.name}  {state}", "bold" if entry.version else "yellow"))
            if entry.version is None:
                continue
            for profile in engine(entry.name).profiles.values():
                grid = Table.grid(padding=(0, 2, 0, 0))
                grid.add_column(no_wrap=True, min_width=12)
                grid.add_column(overflow="fold")
                grid.add_row(f"  {profile.name}", Text(profile.summary))
                if self.settings:
                    for name, setting in profile.settings.items():
                        grid.add_row("", Text(f"{name} = {setting.value}: {setting.reason}", "dim"))
                console.print(grid)
        return 0
