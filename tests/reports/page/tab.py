"""A tab of a real browser, with the network off, in which page after page is opened.

All pages are one file to it, and in all of them Plotly begins at the same line: a browser compiles
what it has seen there once in a fifth of the time, and that is most of what opening a page takes.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from playwright.sync_api import Browser, CDPSession, Page

WIDE, PHONE = {"width": 1280, "height": 900}, {"width": 390, "height": 844}
LONG_MS = 300_000
"""Ends what hangs."""
PLOTLY, LINE = "<script>/**\n* plotly.js", 20_000
"""How Plotly begins, and the line at which it does."""
STATE = """() => ({
  choices: [...document.querySelectorAll('select')].map(each => [each.id, each.value]),
  boxes: [...document.querySelectorAll('[data-item]')].map(
    each => [each.closest('.legend').id, each.dataset.item, each.checked]),
})"""
RESTORE = """({choices, boxes}) => {
  for (const [id, value] of choices) {
    const each = document.getElementById(id);
    if (each.value !== value) { each.value = value; each.dispatchEvent(new Event('change')); }
  }
  for (const [legend, item, checked] of boxes) {
    const each = document.querySelector(`#${legend} [data-item="${item}"]`);
    if (each.checked !== checked) each.click();
  }
}"""
VISIT = """() => {
  for (const choice of document.querySelectorAll('select')) {
    for (const option of [...choice.options]) {
      choice.value = option.value;
      choice.dispatchEvent(new Event('change'));
    }
  }
  const buttons = '[data-item], [data-group], [data-run], th button';
  document.querySelectorAll(buttons).forEach(each => each.click());
  document.querySelectorAll('details').forEach(each => { each.open = true; });
  document.querySelectorAll('details:not(.run)').forEach(each => { each.open = false; });
}"""
SHIFTED = """() => new Promise(done => {
  let sum = 0;
  new PerformanceObserver(list => list.getEntries().forEach(
    each => { sum += each.hadRecentInput ? 0 : each.value; }
  )).observe({type: 'layout-shift', buffered: true});
  requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(() => done(sum), 0)));
})"""
OUT = """() => [...document.querySelectorAll('body *')].filter(each => {
  const box = each.getBoundingClientRect();
  const frame = each.closest('.scroll, pre, .skip, svg');
  return box.width && (!frame || frame === each) && !each.matches('.skip, #js-plotly-tester')
    && (box.right > 390.5 || box.left < -0.5);
}).map(each => `${each.tagName} ${each.id} ${each.textContent.slice(0, 40)}`)"""
CONTROLS = "button, input, select, summary, .scroll"
NAMELESS = """controls => [...document.querySelectorAll(
  `${controls}, [role=img], [role=figure]`)].filter(
  each => !(each.getAttribute('aria-label') || each.textContent.trim()
    || [...(each.labels ?? [])].some(label => label.textContent.trim()))
).map(each => each.outerHTML)"""
UNREACHED = """controls => [...document.querySelectorAll(`${controls}, a`)].filter(
  each => each.tabIndex < 0 && !each.closest('.chart')).map(each => each.outerHTML)"""
DRAWERS = """open => document.querySelectorAll('details').forEach(
  each => { each.open = open; })"""
BY_HAND = """() => {
  const own = ['requestAnimationFrame', 'cancelAnimationFrame', 'setTimeout', 'clearTimeout'];
  const real = own.map(name => [name, window[name]]);
  const due = new Map();
  let [now, last] = [0, 0];
  const later = (call, at) => { due.set(++last, {call, at}); return last; };
  window.requestAnimationFrame = call => later(call, 0);
  window.setTimeout = (call, ms = 0) => later(call, now + ms);
  window.cancelAnimationFrame = window.clearTimeout = ticket => due.delete(ticket);
  window.elapse = ms => {
    for (const end = now + ms; now < end;) {
      now = Math.min(now + 20, end);
      for (const [ticket, {call, at}] of [...due]) if (at <= now && due.delete(ticket)) call(now);
    }
  };
  window.realTime = () => {
    real.forEach(([name, call]) => { window[name] = call; });
    delete window.elapse;
  };
}"""
"""Frames and timers come when `elapse` is called, however fast the machine is: one in 20 ms."""


def aligned(text: str) -> str:
    """A page with empty lines before its Plotly, where it has one."""
    before, plotly, after = text.partition(PLOTLY)
    return before + "\n" * (LINE - before.count("\n")) * bool(plotly) + plotly + after


@dataclass
class Tab:
    """A tab, with all that its page said and asked for since it was opened."""

    page: Page
    file: Path
    screen: CDPSession
    is_phone: bool = False
    said: list[str] = field(default_factory=list)
    asked: list[str] = field(default_factory=list)
    path: Path | None = None
    first: object = None

    @classmethod
    def of(cls, browser: Browser, folder: Path) -> Tab:
        context = browser.new_context(offline=True, viewport=WIDE)
        context.set_default_timeout(LONG_MS)
        page = context.new_page()
        tab = cls(page, folder / "page.html", context.new_cdp_session(page))
        page.on("console", lambda message: tab.said.append(f"{message.type}: {message.text}"))
        page.on("pageerror", lambda error: tab.said.append(f"error: {error}"))
        page.on("request", lambda request: tab.asked.append(request.url))
        return tab

    def on(self, size: Mapping[str, int]) -> Tab:
        """The tab of a screen: a phone's is touched."""
        if self.is_phone != (size is PHONE):
            self.is_phone, self.path = size is PHONE, None
            screen = {"screenWidth": size["width"], "screenHeight": size["height"]}
            shape = {**size, **screen, "deviceScaleFactor": 1, "mobile": self.is_phone}
            self.screen.send("Emulation.setDeviceMetricsOverride", shape)
            self.screen.send("Emulation.setTouchEmulationEnabled", {"enabled": self.is_phone})
        return self

    def open(self, path: Path, *sections: str, **media: object) -> Tab:
        """Open a page, and draw the diagrams of some of its sections."""
        self.check()
        self._media(**media)
        self.path = path
        self.file.write_text(aligned(path.read_text(encoding="utf-8")), encoding="utf-8")
        self.page.goto(self.file.as_uri())
        self.first = self.page.evaluate(STATE)
        self.show(*sections)
        return self

    def visit(self, path: Path, *sections: str) -> Tab:
        """A page as it was when it was opened; it is opened where another one is."""
        if self.path != path:
            return self.open(path, *sections)
        self._media()
        self.page.evaluate("window.realTime?.()")
        self.restore()
        return self

    def check(self) -> None:
        """The page had nothing to say, and asked for nothing but itself."""
        said, asked = self.said[:], {url for url in self.asked if not url.startswith("data:")}
        self.said.clear()
        self.asked.clear()
        assert said == []
        assert asked <= {self.file.as_uri()}

    def hostile_text_does_nothing(self, place: str) -> None:
        """Though it is read at a place."""
        assert self.page.evaluate("() => window.hacked") is None
        assert self.page.locator("main img").count() == 0
        assert "{{ 7 * 7 }}" in self.text(place)

    def _media(self, **media: object) -> None:
        self.page.emulate_media(**{"reduced_motion": "reduce", "color_scheme": "light", **media})

    def restore(self) -> None:
        self.page.evaluate(RESTORE, self.first)

    def show(self, *sections: str) -> None:
        """Scroll to sections and wait for their diagrams."""
        for section in sections:
            self.page.locator(f"#{section}").scroll_into_view_if_needed()
            for chart in self.page.locator(f"#{section} .chart").all():
                chart.scroll_into_view_if_needed()
                chart.locator(".main-svg").first.wait_for()

    def elapse(self, ms: float) -> None:
        """Let time go by for the page, whose time stands still from now on."""
        self.page.evaluate(f"if (!window.elapse) ({BY_HAND})()")
        self.page.evaluate("ms => window.elapse(ms)", ms)

    def slide(self, name: str, at: float) -> None:
        self.page.evaluate(
            """([name, at]) => { const slider = document.getElementById(name);
            slider.value = at; slider.dispatchEvent(new Event('input')); }""",
            [name, at],
        )

    def drawn(self, shapes: str) -> list[str]:
        found = "all => all.map(each => each.getAttribute('d') ?? '')"
        return self.page.locator(shapes).evaluate_all(found)

    def no_error_and_no_request(self, *clicks: str) -> None:
        """In a whole visit: every choice is made, every switch clicked, every drawer opened."""
        shifted = self.page.evaluate(SHIFTED)
        self.page.evaluate(VISIT)
        for each in clicks:
            self.page.locator(each).click()
        self.restore()
        self.check()
        assert shifted < 0.05, "what is read should stay where it is"

    def nothing_runs_out(self) -> None:
        """On a phone, with all drawers closed and with all open."""
        for is_open in (False, True):
            self.page.evaluate(DRAWERS, is_open)
            assert self.page.evaluate(OUT) == []
            self.needs_no_scrolling_aside()

    def needs_no_scrolling_aside(self) -> None:
        screen = PHONE if self.is_phone else WIDE
        assert self.page.evaluate("document.documentElement.scrollWidth") <= screen["width"]

    def every_control_has_a_name(self, is_reached_by_tab: bool = True) -> None:
        assert self.page.evaluate(NAMELESS, CONTROLS) == []
        if is_reached_by_tab:
            self.page.evaluate("() => { document.activeElement.blur(); scrollTo(0, 0); }")
            assert self.page.evaluate(UNREACHED, CONTROLS) == []

    def text(self, place: str) -> str:
        return self.page.locator(place).inner_text()
