"""Why an install did not work, in one line that names no host."""

from __future__ import annotations

import platform
import re
from collections.abc import Iterable

from packaging.version import InvalidVersion, Version

from models.errors import cut

LONGEST = 200
URL = re.compile(r"\b[a-z][a-z0-9+.]*://[^\s'\"`)>,]+", re.IGNORECASE)
HOST_OF_URL = re.compile(r"://(?:[^/@\s]*@)?(\[[^\]]*\]|[^/:\s'\"`)>,]+)")
HOST = re.compile(r"host='([^']+)'")
OFFERED = re.compile(r"requirement (\S+?)==(\S+) \(from versions: ([^)]*)\)")
REFUSED = re.compile(r"there is no version of (\S+?)==(\S+?)(?:,| and|$)")
NO_WHEEL = re.compile(r"(\S+?)==(\S+) has no (?:usable )?wheels")
NETWORK = re.compile(
    "connection broken|Failed to establish|Max retries exceeded|Failed to fetch|dns error|"
    "error sending request|Network is unreachable|Name or service not known|name resolution"
)
CAUSE = re.compile(
    "refused|unreachable|resolution|lookup address|not known|timed out|certificate|"
    "Tunnel connection failed|Unauthorized|Forbidden"
)
NUMBERED = re.compile(r"\[Errno -?\d+\]|\(os error \d+\)")
NOISE = ("WARNING:", "Looking in", "[notice]", "hint:", "DEPRECATION", "Traceback", "Using Python")


def reason(*outputs: str) -> str:
    """The one line that matters in what pip or uv wrote."""
    text = _named("\n".join(outputs))
    flat = " ".join(text.split())
    if NETWORK.search(flat):
        return _network(text)
    if match := OFFERED.search(flat):
        return _not_offered(match[1], match[2], match[3].split(", "))
    if match := REFUSED.search(flat) or NO_WHEEL.search(flat):
        return _not_offered(match[1], match[2], ())
    return shortened(_telling(text) or "the installer gave no reason")


def shortened(text: str) -> str:
    """One line of bounded length."""
    return cut(" ".join(text.split()), LONGEST)


def _named(output: str) -> str:
    """The output with hosts, URLs and what only draws lines taken out."""
    hosts = {*HOST_OF_URL.findall(output), *HOST.findall(output)}
    text = URL.sub("the package index", output)
    for host in sorted(hosts, key=len, reverse=True):
        text = text.replace(host, "the package index")
    return re.sub("[\u2500-\u257f\u25b6\u00d7]", " ", text)


def _network(text: str) -> str:
    """No answer from where packages come from, and why as far as it is told."""
    lines = [line.strip() for line in text.splitlines() if CAUSE.search(line)]
    parts = [part for line in lines[-1:] for part in re.split(r": (?=\S)", line)]
    cause = "".join([part for part in parts if CAUSE.search(part)][-1:])
    cause = NUMBERED.sub("", cause).strip(" ')]")
    return shortened("the package index could not be reached" + (f" ({cause})" if cause else ""))


def _not_offered(name: str, version: str, offered: Iterable[str]) -> str:
    """There is no such version for this Python; and which are near."""
    near = _nearest(version, offered)
    python = ".".join(platform.python_version_tuple()[:2])
    here = f"Python {python} on {platform.system()} {platform.machine()}"
    what = f"no {name} {version} is offered as a wheel for {here}"
    return what + (f"; near it: {', '.join(near)}" if near else "")


def _nearest(version: str, offered: Iterable[str]) -> list[str]:
    """The two offered versions below one, and the one above."""
    try:
        asked = Version(version)
        others = sorted(Version(text.strip()) for text in offered if text != "none")
    except InvalidVersion:
        return []
    below = [other for other in others if other < asked][-2:]
    above = [other for other in others if other > asked][:1]
    return [str(each) for each in (*below, *above)]


def _telling(text: str) -> str:
    """pip's first error; uv's cause, which says more than its error; else the last line."""
    lines = [line.strip() for line in text.splitlines()]
    lines = [line for line in lines if line and not line.startswith(NOISE)]
    for number, line in enumerate(lines):
        if line.startswith("ERROR:"):
            return line.removeprefix("ERROR:").strip()
        if cause := re.match(r"(?:[Cc]ause(?:d by)?: *)?(Because .*)", line):
            return " ".join([cause[1], *lines[number + 1 :]])
    causes = [line for line in lines if re.match("cause(d by)?:", line, re.IGNORECASE)]
    last = causes[-1:] or lines[-1:]
    return re.sub(r"(?i)^(error|caused by|cause): *", "", last[0]) if last else ""
