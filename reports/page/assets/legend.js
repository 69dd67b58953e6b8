"use strict";
// Legends that are switches, by mouse, finger and keyboard: a box for a group, one for each of its
// items. A group of one item has one box.

crankcheck.swatch = (() => {
  const { svg } = crankcheck;
  const SHAPES = {
    circle: ["circle", { cx: 15, cy: 7, r: 4.5 }],
    square: ["rect", { x: 10.8, y: 2.8, width: 8.4, height: 8.4 }],
    diamond: ["path", { d: "M15 1.2 20.8 7 15 12.8 9.2 7z" }],
    "triangle-up": ["path", { d: "M15 1.5 20.5 12h-11z" }],
    cross: ["path", { d: "M13 2h4v3h3v4h-3v3h-4v-3h-3v-4h3z" }],
    star: ["path", { d: "M15 .8l1.7 4 4.3.4-3.3 2.8 1 4.2-3.7-2.2-3.7 2.2 1-4.2-3.3-2.8 4.3-.4z" }],
  };

  /** A stroke and, where there is one, a marker: how an item is drawn. */
  return (item) =>
    svg(
      "svg",
      { class: `swatch ${item.paint}`, viewBox: "0 0 30 14", "aria-hidden": "true", "data-dash": item.dash ?? "solid" },
      svg("line", { x1: 1, y1: 7, x2: 29, y2: 7 }),
      ...(item.symbol in SHAPES ? [svg(...SHAPES[item.symbol])] : []),
    );
})();

/** Items for the looks of the page, in groups by engine. */
crankcheck.lookGroups = (wanted, on = () => true) => {
  const groups = new Map();
  for (const look of crankcheck.looks.filter((each) => wanted.has(each.number))) {
    if (!groups.has(look.engine)) groups.set(look.engine, []);
    groups.get(look.engine).push({
      id: look.number, label: look.variant, paint: `c${look.colour}`, symbol: look.symbol, dash: look.dash, on: on(look),
    });
  }
  return [...groups].map(([title, items]) => ({ title, items }));
};

/**
 * Fill a container with the switches of some groups: `{title, items: [{id, label, paint, on}]}`.
 * `changed` is called after every change. Gives `on(id)` and `note(id, text)`.
 */
crankcheck.legend = (container, groups, changed) => {
  const { html } = crankcheck;
  const boxes = new Map();
  const notes = new Map();
  container.replaceChildren();
  for (const { title, items } of groups) {
    const group = html("div", { class: "group", role: "group", "aria-label": title });
    const whole = html("input", { type: "checkbox" });
    const own = items.map((item) => {
      const box = html("input", { type: "checkbox", "data-item": String(item.id) });
      const note = html("span", { class: "quietly" });
      box.checked = item.on;
      boxes.set(item.id, box);
      notes.set(item.id, note);
      group.append(html("label", { class: "item" }, box, crankcheck.swatch(item), html("span", {}, item.label), note));
      return box;
    });
    const show = () => {
      const number = own.filter((box) => box.checked).length;
      whole.checked = number === own.length;
      whole.indeterminate = number > 0 && number < own.length;
    };
    if (title) {
      whole.dataset.group = title;
      group.prepend(html("label", { class: "item whole" }, whole, html("span", {}, title)));
    }
    whole.addEventListener("change", () => {
      own.forEach((box) => {
        box.checked = whole.checked;
      });
      changed();
    });
    own.forEach((box) =>
      box.addEventListener("change", () => {
        show();
        changed();
      }),
    );
    show();
    container.append(group);
  }
  return {
    on: (id) => boxes.get(id)?.checked ?? false,
    note: (id, text) => {
      if (notes.has(id)) notes.get(id).textContent = text;
    },
    /** Only the items with these names are offered. */
    offer: (ids) => {
      for (const [id, box] of boxes) box.parentElement.hidden = !ids.includes(id);
    },
  };
};
