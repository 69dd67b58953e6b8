"use strict";
// Legends that are switches, by mouse, finger and keyboard: a box for a group, one for each of its
// items. A group of one item has one box. The name of a group shows it alone in all legends of the
// page; once more, and all is as before.

crankcheck.swatch = (() => {
  const { svg } = crankcheck;
  const SHAPES = {
    circle: ["circle", { cx: 15, cy: 7, r: 4.5 }],
    square: ["rect", { x: 10.8, y: 2.8, width: 8.4, height: 8.4 }],
    diamond: ["path", { d: "M15 1.2 20.8 7 15 12.8 9.2 7z" }],
    "triangle-up": ["path", { d: "M15 1.5 20.5 12h-11z" }],
    "triangle-down": ["path", { d: "M15 12.5 20.5 2h-11z" }],
    hourglass: ["path", { d: "M10 2h10L10 12h10z" }],
    x: ["path", { d: "M11.8 1.3 15 4.5l3.2-3.2 2.5 2.5L17.5 7l3.2 3.2-2.5 2.5L15 9.5l-3.2 3.2-2.5-2.5L12.5 7 9.3 3.8z" }],
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

/** Items for the looks of the page, in groups by engine; of many engines in families by formulation. */
crankcheck.lookGroups = (wanted, on = () => true) => {
  const groups = new Map();
  const many = new Set(crankcheck.looks.map((each) => each.engine)).size > 2;
  for (const look of crankcheck.looks.filter((each) => wanted.has(each.number))) {
    if (!groups.has(look.engine)) {
      const note = look.precision === "single" ? "single precision" : "";
      groups.set(look.engine, { title: look.engine, note, family: many ? look.formulation : "", items: [] });
    }
    groups.get(look.engine).items.push({
      id: look.number, label: look.variant, paint: `c${look.colour}`, symbol: look.symbol, dash: look.dash, on: on(look),
    });
  }
  return [...groups.values()];
};

/** The title of the group that is shown alone, if any, and what shows it in the legend of each container. */
crankcheck.alone = {
  legends: new Map(),
  shown: null,
  toggle(title) {
    this.shown = this.shown === title ? null : title;
    for (const legend of this.legends.values()) legend(this.shown);
  },
};

/**
 * Fill a container with the switches of some groups: `{title, items: [{id, label, paint, on}]}`, and
 * `note` and `family` where they have them. `changed` is called after every change. Gives `on(id)`,
 * `note(id, text)`, and `kept(id)`: whether it is on if all are shown; undefined if it is not here.
 */
crankcheck.legend = (container, groups, changed) => {
  const { html, alone } = crankcheck;
  const boxes = new Map();
  const notes = new Map();
  const shows = []; // what brings the box of each group up to date
  let before = null; // the boxes as they were before a group was shown alone
  container.replaceChildren();
  const rows = new Map([["", container]]); // of families: groups of none stand in the container itself
  for (const family of new Set(groups.map((each) => each.family ?? ""))) {
    if (!family) continue;
    rows.set(family, html("div"));
    container.append(html("div", { class: "family" }, html("span", { class: "quietly" }, family), rows.get(family)));
  }
  for (const { title, note: remark, family = "", items } of groups) {
    const group = html("div", { class: "group", role: "group", "aria-label": title });
    const whole = html("input", { type: "checkbox" });
    const own = items.map((item) => {
      const box = html("input", { type: "checkbox", "data-item": String(item.id) });
      const note = html("span", { class: "quietly" });
      box.checked = item.on;
      boxes.set(item.id, box);
      box.dataset.of = title;
      notes.set(item.id, note);
      group.append(html("label", { class: "item" }, box, crankcheck.swatch(item), html("span", {}, item.label), note));
      return box;
    });
    const name = html("button", { type: "button", title: `${title} alone, and all as before` }, title);
    const show = (shown) => {
      if (shown !== undefined) name.setAttribute("aria-pressed", shown === title);
      const number = own.filter((box) => box.checked).length;
      whole.checked = number === own.length;
      whole.indeterminate = number > 0 && number < own.length;
    };
    if (title) {
      whole.dataset.group = title;
      whole.setAttribute("aria-label", `all of ${title}`);
      const more = remark ? [html("span", { class: "quietly" }, remark)] : [];
      group.prepend(html("span", { class: "item whole" }, whole, name, ...more));
      name.addEventListener("click", () => alone.toggle(title));
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
    shows.push(show);
    rows.get(family).append(group);
  }
  /** Only the group of this title, if it is here; null: all as it was before. */
  function only(title) {
    const here = groups.some((each) => each.title === title);
    if (here) before ??= new Map([...boxes.values()].map((box) => [box, box.checked]));
    for (const box of before?.keys() ?? []) box.checked = here ? box.dataset.of === title : before.get(box);
    if (!here) before = null;
    shows.forEach((show) => show(title));
  }
  alone.legends.set(container, (title) => {
    only(title);
    changed();
  });
  only(alone.shown);
  return {
    on: (id) => boxes.get(id)?.checked ?? false,
    kept: (id) => before?.get(boxes.get(id)) ?? boxes.get(id)?.checked,
    note: (id, text) => {
      if (notes.has(id)) notes.get(id).textContent = text;
    },
    /** Only the items with these names are offered. */
    offer: (ids) => {
      for (const [id, box] of boxes) box.parentElement.hidden = !ids.includes(id);
    },
  };
};
