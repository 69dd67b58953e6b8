"""Hostile text in all that a file may hold, and the elements of a page in which it stands."""

import json
import re
from html.parser import HTMLParser
from typing import Any

from reports.store.manifest import Manifest
from reports.store.reader import Stored

VOID = {"meta", "link", "input", "br", "img", "col"}
EVIL = '</script><img src=x onerror="window.hacked=1"><b>\'&amp;{{ 7 * 7 }}'


class Outline(HTMLParser):
    """The elements of a page with their attributes, each closed by its own end, and the text."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.open: list[str] = []
        self.text = ""
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag, f"</{tag}> closes another element"

    def handle_data(self, data: str) -> None:
        self.text += data if self.open[-1:] != ["script"] else ""

    def named(self, tag: str) -> list[dict[str, str | None]]:
        return [attributes for name, attributes in self.elements if name == tag]

    def sections(self) -> list[str | None]:
        return [each["id"] for each in self.named("section")]


def stands_alone(text: str, sections: list[str]) -> None:
    """The sections are there in their order, all that leads somewhere does, and nothing is loaded
    from outside."""
    outline = Outline(text)
    assert outline.open == []
    assert outline.sections() == sections
    ids = [attributes["id"] for _, attributes in outline.elements if "id" in attributes]
    assert len(ids) == len(set(ids))
    assert set(re.findall(r'aria-labelledby="([^"]+)"', text)) <= set(ids)
    links = {(each["href"] or "")[1:] for each in outline.named("a")}
    assert links - {""} <= set(ids)
    assert {each["for"] for each in outline.named("label") if "for" in each} <= set(ids)
    for tag, attributes in outline.elements:
        for name in ("src", "href", "action", "data", "poster", "srcset"):
            value = attributes.get(name) or "#"
            assert value.startswith(("#", "data:")), f"{tag} {name}={value}"
        assert not [name for name in attributes if name.startswith("on")]
    style = text[text.index("<style>") : text.index("</style>")]
    assert "url(" not in style
    assert "@import" not in style


def shown_and_not_read(text: str, scripts: int) -> None:
    """Hostile text of a page made no element, and no script beside our own."""
    outline = Outline(text)
    assert outline.open == []
    assert outline.named("img") == []
    assert not [each for _, each in outline.elements if "onerror" in each]
    ours = [each for each in outline.named("script") if each.get("type") != "application/json"]
    assert len(ours) == scripts


def embedded_in(text: str, name: str) -> dict[str, Any]:
    found = re.search(rf'id="embedded-{name}">(.*?)</script>', text, re.DOTALL)
    assert found
    return json.loads(found[1])


def evil(stored: Stored) -> Stored:
    """The store with hostile text wherever a file may have it; drawings keep the scenes' names."""
    cells = stored.cells.copy()
    for column in ("variant", "reason", "status", "version", "warnings"):
        cells[column] = [f"{EVIL}{value}" if value != "ok" else value for value in cells[column]]
    cells["scene"] = [f"{EVIL}{name}" for name in cells["scene"]]
    cells["asked"] = [json.dumps({EVIL: EVIL, **json.loads(asked)}) for asked in cells["asked"]]
    hacked = ("Crank-rocker", "</script><script>window.hacked=1//")
    scenes = {f"{EVIL}{k}": text.replace(*hacked) for k, text in stored.manifest.scenes.items()}
    run = {"command": [EVIL], "started": EVIL, "study": {EVIL: EVIL}, "provenance": {EVIL: EVIL}}
    found = Stored(stored.folder, Manifest(scenes, (run,)), cells, stored.timings)
    vars(found)["_traces"] = stored._traces
    return found
