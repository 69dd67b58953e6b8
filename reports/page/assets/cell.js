"use strict";
// What is known of a cell, in a panel of its section: its end, its errors by their limits, its
// settings, and the command that repeats it.

/** What shows a cell of a line in the panel of the section `name`, which embedded `settings` and `rules`. */
crankcheck.cellPanel = (name, { settings, rules }) => {
  const { html, looks, readable, short } = crankcheck;
  const part = (each) => document.getElementById(`${name}-${each}`);
  return (line, cell, scene) => {
    part("known").hidden = !cell;
    if (!cell) return;
    part("cell").textContent = `${scene}, ${looks[line.look].name}, ${cell.step}: ${cell.verdict}.`;
    part("failed").replaceChildren(...cell.failed.map((rule) => html("li", {}, `${rules[rule] ?? "Rule"} (${rule})`)));
    part("errors").replaceChildren(...cell.errors.map(([error, unit, largest, limit]) => html("tr", {},
      html("th", { scope: "row" }, error), html("td", { class: "num" }, `${short(largest, 3)} `, html("span", { class: "quietly" }, unit)),
      html("td", { class: "num" }, short(limit, 3)), html("td", { class: "num" }, limit ? `${readable(largest / limit, 3)} times` : "–"))));
    part("set").textContent = settings[line.look];
    part("command").textContent = `${line.command} ${cell.at}`;
  };
};

/** Names of cells lead to the panel of a section that embedded them as `known`; `choose` is given the line and the cell. */
crankcheck.cellsLead = (name, own, choose) => {
  const show = crankcheck.cellPanel(name, own);
  const lineOf = (at) => own.known.find(({ scene, look }) => scene === at.scene && String(look) === at.look);
  crankcheck.leads(`${name}-known`, lineOf, (at) => {
    const line = lineOf(at);
    const cell = line.cells.find(({ steps }) => Math.abs(steps / at.steps - 1) < 1e-4) ?? line.cells.at(-1);
    choose(line, cell);
    show(line, cell, line.scene);
  });
};
