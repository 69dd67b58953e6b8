"""What is wrong with a built site: links and anchors that lead nowhere, pictures that are not
there, and whatever would ask the network."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

LOADED = {"script": "src", "link": "href", "img": "src", "iframe": "src", "source": "src"}
"""What a browser fetches by itself, and the attribute that says from where."""
ANYWHERE = {"404.html"}
"""Served at any depth, with addresses to match."""


@dataclass
class Document(HTMLParser):
    """The anchors of a page, and what it names: (line, address, whether a browser fetches it)."""

    anchors: set[str] = field(default_factory=set)
    named: list[tuple[int, str, bool]] = field(default_factory=list)

    def __post_init__(self) -> None:
        super().__init__()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Called for each tag."""
        told = dict(attrs)
        for name in ("id", "name"):
            if value := told.get(name):
                self.anchors.add(value)
        line = self.getpos()[0]
        if tag == "a" and (value := told.get("href")):
            self.named.append((line, value, False))
        if tag in LOADED and (value := told.get(LOADED[tag])):
            self.named.append((line, value, True))
        if tag == "autoref":
            self.named.append((line, f"#{told.get('identifier')}", False))


def faults_of_site(site: Path) -> Iterator[str]:
    """Every fault, with the page and its line."""
    documents = {}
    for path in sorted(site.rglob("*.html")):
        if path.relative_to(site).as_posix() not in ANYWHERE:
            documents[path] = Document()
            documents[path].feed(path.read_text(encoding="utf-8"))
    for path, document in documents.items():
        for line, address, fetched in document.named:
            if fault := _fault(path, address, fetched, documents, site):
                yield f"{path.relative_to(site)}:{line}: {address}: {fault}"


def _fault(
    path: Path, address: str, fetched: bool, documents: dict[Path, Document], site: Path
) -> str:
    parts = urlsplit(address)
    if parts.scheme == "data":
        return ""
    if parts.scheme or parts.netloc:
        return "would be fetched from the network" if fetched else ""
    to = (path.parent / unquote(parts.path)).resolve() if parts.path else path
    if to.is_dir():
        to /= "index.html"
    if not to.is_relative_to(site.resolve()) or not to.is_file():
        return "is not there"
    if parts.fragment and to in documents and unquote(parts.fragment) not in documents[to].anchors:
        return "has no such anchor"
    return ""
