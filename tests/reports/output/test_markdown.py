"""Markdown from names that would be markup, in parts that keep to their room."""

from __future__ import annotations

import re

from reports.output.markdown import code, counted, folded, plain, table

NASTY = "a|b `c` <d> [e](f) @team *g* $h$ #1 \\ 中文"


def test_names_mean_themselves() -> None:
    text = plain(NASTY)
    assert re.sub(r"\\(.)", r"\1", text).replace("\N{WORD JOINER}", "") == NASTY
    assert "@team" not in text
    for special in "|`<[*$#":
        assert not re.search(rf"(?<!\\){re.escape(special)}", text), special
    assert plain("a\n\n| b") == r"a \| b"


def test_a_table_counts_what_it_has_no_room_for() -> None:
    text = table(("name", "number:"), [("x" * 50, i) for i in range(100)], 2000)
    assert len(text.encode()) < 2000
    shown = text.count("\n| ") - 1
    assert text.endswith(f"\n\nand {100 - shown} more")
    assert shown > 20


def test_a_fence_is_longer_than_any_in_the_code() -> None:
    assert code("a\n````\nb\n", "xml") == "`````xml\na\n````\nb\n`````"
    assert code("a", "") == "```\na\n```"


def test_a_title_to_click_on_is_no_markup() -> None:
    assert folded("<b> & @team", "x").startswith(
        "<details><summary>&lt;b&gt; &amp; @\N{WORD JOINER}team</summary>\n\nx\n\n</details>"
    )


def test_what_is_left_out_is_counted_by_its_name() -> None:
    assert counted(["a" * 10] * 3, 25, "lines") == ["a" * 10, "a" * 10, "\nand 1 more lines"]
    assert counted(["a" * 10] * 2, 25, "lines") == ["a" * 10, "a" * 10]
