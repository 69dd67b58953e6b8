"use strict";
// Tables of class "sortable": every head becomes a button that sorts by its column.

for (const table of document.querySelectorAll("table.sortable")) {
  const heads = [...table.tHead.rows[table.tHead.rows.length - 1].cells];
  const body = table.tBodies[0];

  /** What a cell is sorted by: its data-value, as a number where it is one, or its text. */
  function keyOf(row, column) {
    const cell = row.cells[column];
    const text = cell.dataset.value ?? cell.textContent.trim();
    const number = Number(text);
    if (text === "" || text === "nan" || text === "–") return null;
    return text === "inf" ? Infinity : Number.isNaN(number) ? text : number;
  }

  function compare(a, b, sign) {
    if (a === null || b === null) return (a === null) - (b === null); // nothing goes last
    if (typeof a === "number" && typeof b === "number") return sign * (a - b);
    return sign * String(a).localeCompare(String(b), "en", { numeric: true });
  }

  function sort(column) {
    const head = heads[column];
    const descending = head.getAttribute("aria-sort") === "ascending";
    const rows = [...body.rows].map((row) => [keyOf(row, column), row]);
    rows.sort(([a], [b]) => compare(a, b, descending ? -1 : 1));
    body.append(...rows.map(([, row]) => row));
    heads.forEach((each) => each.removeAttribute("aria-sort"));
    head.setAttribute("aria-sort", descending ? "descending" : "ascending");
  }

  heads.forEach((head, column) => {
    const button = crankcheck.html("button", { type: "button" });
    button.append(...head.childNodes, crankcheck.html("span", { class: "arrow", "aria-hidden": "true" }));
    head.append(button);
    button.addEventListener("click", () => sort(column));
  });
}

/** What names a cell or a line of cells (`data-look`, of a `-scene` and `-steps`) leads to what is known of it. */
crankcheck.leads = (anchor, has, show) => {
  for (const each of document.querySelectorAll("[data-look]")) {
    if (!has(each.dataset)) continue;
    const link = crankcheck.html("a", { href: `#${anchor}`, class: "known" });
    link.append(...each.childNodes);
    each.append(link);
    link.addEventListener("click", () => show(each.dataset));
  }
};

// A field that shows only the rows with its text in them.
for (const field of document.querySelectorAll("input[data-filters]")) {
  const table = document.getElementById(field.dataset.filters);
  const told = document.getElementById(`${field.id}-told`);
  field.closest(".field").hidden = false;
  field.addEventListener("input", () => {
    const words = field.value.toLowerCase().split(/\s+/).filter(Boolean);
    let shown = 0;
    for (const row of table.tBodies[0].rows) {
      const text = row.textContent.toLowerCase();
      row.hidden = !words.every((word) => text.includes(word));
      shown += row.hidden ? 0 : 1;
    }
    told.textContent = words.length ? `${shown} shown` : "";
  });
}
