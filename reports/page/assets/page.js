"use strict";
// What all scripts of the page share. Text goes in as text only: nothing here makes HTML of strings.

const crankcheck = (() => {
  const SVG = "http://www.w3.org/2000/svg";
  const MISSING = -32768;
  const themed = [];

  /** What a section embedded in the page; null where there is nothing. */
  function embedded(name) {
    const found = document.getElementById(`embedded-${name}`);
    return found && JSON.parse(found.textContent);
  }

  const viewed = (base64) => new DataView(Uint8Array.from(atob(base64), (c) => c.charCodeAt(0)).buffer);

  /** Numbers from the form of `reports.drawing.moving.singles`. */
  function singles(packed) {
    const whole = viewed(packed.singles);
    return Float64Array.from({ length: packed.samples }, (_, i) => whole.getFloat32(4 * i, true));
  }

  /** Rows of numbers from the form of `reports.drawing.moving.packed`; what is missing is NaN. */
  function unpacked(packed) {
    const whole = viewed(packed.base64);
    return packed.scales.map((scale, row) => {
      const values = new Float64Array(packed.samples);
      for (let i = 0; i < packed.samples; i += 1) {
        const level = whole.getInt16(2 * (row * packed.samples + i), true);
        values[i] = level === MISSING ? NaN : scale * level;
      }
      return values;
    });
  }

  function make(element, attributes, children) {
    for (const [name, value] of Object.entries(attributes)) {
      if (value === true) element.setAttribute(name, "");
      else if (value !== false && value !== null) element.setAttribute(name, value);
    }
    element.append(...children);
    return element;
  }

  /** An HTML element with attributes and children (elements, or strings as text). */
  const html = (name, attributes = {}, ...children) =>
    make(document.createElement(name), attributes, children);

  /** An SVG element. */
  const svg = (name, attributes = {}, ...children) =>
    make(document.createElementNS(SVG, name), attributes, children);

  /** A colour of the style sheet, as it is in the theme of the moment. */
  const colour = (name) =>
    getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

  /** A number with few digits, such as 2.7e-4. */
  function short(value, digits = 2) {
    if (value === null || !Number.isFinite(value)) return "–";
    if (value === 0) return "0";
    return value.toExponential(digits - 1).replace("e+", "e");
  }

  /** A number with few digits, without an exponent where it needs none: 0.0123, 345, 6.7e-5. */
  function readable(value, digits = 3) {
    const size = Math.abs(value);
    return size === 0 || (size >= 1e-3 && size < 1e5) ? String(Number(value.toPrecision(digits))) : short(value, digits).replace(/\.?0+e/, "e");
  }

  /** A time in the unit that suits it. */
  function duration(seconds) {
    if (seconds === null || !Number.isFinite(seconds)) return "not timed";
    const [size, unit] = [[1, "s"], [1e-3, "ms"], [1e-6, "µs"]].find(([s]) => seconds >= 0.9995 * s) ?? [1e-9, "ns"];
    return `${Number((seconds / size).toPrecision(3))} ${unit}`;
  }

  const system = () => (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
  const dark = () => (document.documentElement.dataset.theme ?? system()) === "dark";

  /** Calls `draw` whenever the theme has changed. */
  const onTheme = (draw) => themed.push(draw);
  const retheme = () => themed.forEach((draw) => draw());

  /** Take a theme and keep it; that of the system is followed, and not kept. */
  function choose(theme) {
    if (theme === system()) delete document.documentElement.dataset.theme;
    else document.documentElement.dataset.theme = theme;
    try {
      if (theme === system()) localStorage.removeItem("crankcheck-theme");
      else localStorage.setItem("crankcheck-theme", theme);
    } catch {
      // Kept for this visit only.
    }
  }

  function themeButton() {
    const button = document.getElementById("theme");
    const label = () => {
      button.textContent = dark() ? "Light theme" : "Dark theme";
    };
    button.hidden = false;
    label();
    button.addEventListener("click", () => {
      choose(dark() ? "light" : "dark");
      label();
      retheme();
    });
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
      label();
      retheme();
    });
  }

  addEventListener("beforeprint", () => { // paper is light, and nobody opens a drawer of it
    const { theme } = document.documentElement.dataset;
    document.documentElement.dataset.theme = "light";
    retheme();
    const closed = [...document.querySelectorAll("details:not([open])")];
    closed.forEach((each) => each.setAttribute("open", ""));
    addEventListener("afterprint", () => {
      closed.forEach((each) => each.removeAttribute("open"));
      choose(theme ?? system());
      retheme();
    }, { once: true });
  });
  themeButton();
  return {
    embedded, unpacked, singles, html, svg, colour, short, readable, duration, onTheme,
    looks: embedded("looks") ?? [],
    calm: matchMedia("(prefers-reduced-motion: reduce)"),
  };
})();
