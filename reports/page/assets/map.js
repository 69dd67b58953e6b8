"use strict";
// A table whose cells hold rows of buttons: one stop of the tab key, and arrow keys from there on.

/**
 * Arrows go left and right through the buttons of a row, up and down to the same place in the next
 * row; Home and End go to the ends of the row. Gives `enter(button)`: the stop of the tab key.
 */
crankcheck.arrows = (table, selector) => {
  const rows = [...table.rows].map((row) => [...row.querySelectorAll(selector)]).filter((row) => row.length);
  const every = rows.flat();

  function enter(button) {
    every.forEach((each) => {
      each.tabIndex = each === button ? 0 : -1;
    });
  }

  /** The button in another row that stands under this one: in the same cell, at the same place. */
  function beside(button, row) {
    const cell = button.closest("td");
    const place = [...cell.querySelectorAll(selector)].indexOf(button);
    const there = row.filter((each) => each.closest("td").cellIndex === cell.cellIndex);
    return there[Math.min(place, there.length - 1)] ?? row[0];
  }

  function wanted(button, key) {
    const index = rows.findIndex((row) => row.includes(button));
    const row = rows[index];
    const place = row.indexOf(button);
    if (key === "ArrowLeft") return row[place - 1];
    if (key === "ArrowRight") return row[place + 1];
    if (key === "Home") return row[0];
    if (key === "End") return row.at(-1);
    const other = rows[index + { ArrowUp: -1, ArrowDown: 1 }[key]];
    return other && beside(button, other);
  }

  table.addEventListener("keydown", (event) => {
    const button = event.target.closest(selector);
    const known = ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown", "Home", "End"].includes(event.key);
    if (!button || !known || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    const next = wanted(button, event.key);
    if (!next) return;
    enter(next);
    next.focus();
  });
  if (every.length) enter(every[0]);
  return { enter };
};
