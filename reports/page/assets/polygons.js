"use strict";
// Velocity and acceleration polygons that move with their mechanism, drawn up to a step.

(() => {
  const { html, readable, unpacked } = crankcheck;
  const own = crankcheck.embedded("polygons");
  const part = (name) => document.getElementById(`polygons-${name}`);
  const step = part("step");
  const WORDS = { whole: "of a point", rotation: "about a pin", normal: "normal", tangential: "tangential", coriolis: "Coriolis", sliding: "sliding" };
  const degrees = (radians) => `${Number(((radians * 180) / Math.PI).toFixed(1))}°`;

  const figures = own.polygons.map((polygon) => ({
    ...polygon, figure: crankcheck.polygonFigure(part(polygon.quantity), polygon),
    cells: polygon.vectors.map((vector) => ({ size: html("td", { class: "num" }), towards: html("td", { class: "num" }), vector })),
  }));
  for (const { quantity, cells, vectors } of figures) {
    part(`${quantity}-rows`).replaceChildren(...cells.map(({ size, towards, vector }) =>
      html("tr", {}, html("th", { scope: "row", class: `of-${vector.kind}` }, vector.name), size, towards,
        html("td", {}, vector.found ? `by crossing, ${vector.found}` : "known"))));
    const kinds = [...new Set(vectors.map((vector) => vector.kind))];
    part(`${quantity}-key`).replaceChildren(...kinds.map((kind) => html("span", { class: `of-${kind}` }, WORDS[kind])));
  }

  const rates = unpacked(own.links.rows);
  const links = own.links.names.map((name, i) => ({
    omega: rates[2 * i], alpha: rates[2 * i + 1], name,
    cells: [0, 1, 2, 3].map((k) => html("td", { class: k < 2 ? "num" : null })),
  }));
  part("links").replaceChildren(...links.map(({ name, cells }) => html("tr", {}, html("th", { scope: "row" }, name), ...cells)));

  /** What the image of a link is: x + iy is what the link is multiplied by. */
  function image(x, y, unit) {
    if (!Number.isFinite(x + y)) return "not determined";
    if (x === 0 && y === 0) return `one point, as ${unit === "1/s" ? "omega is" : "omega and alpha are"} 0`;
    return `similar, ${readable(Math.hypot(x, y))} ${unit}, turned by ${degrees(Math.atan2(y, x))}`;
  }

  function tell(position) {
    for (const { cells, figure } of figures) {
      cells.forEach(({ size, towards }, i) => {
        const [x0, y0, x1, y1] = figure.ends(i, position);
        const long = Math.hypot(x1 - x0, y1 - y0);
        size.textContent = Number.isFinite(long) ? readable(long, 4) : "–";
        towards.textContent = long > 0 ? degrees(Math.atan2(y1 - y0, x1 - x0)) : "–";
      });
    }
    for (const { omega, alpha, cells } of links) {
      const [w, e] = [omega, alpha].map((row) => figures[0].figure.between(row, position));
      const words = [readable(w, 4), readable(e, 4), image(0, w, "1/s"), image(-w * w, e, "1/s²")];
      words.forEach((text, k) => { cells[k].textContent = text; });
    }
  }

  let last = 0;
  function draw(position) {
    last = position;
    const steps = Number(step.value);
    const { steps: titles } = own.polygons[0];
    part("step-title").textContent = steps === 0 ? "the pole" : steps < titles.length ? titles[steps - 1] : `${titles.at(-1)}, images`;
    for (const { figure } of figures) figure.show(position, steps, part("scale").value === "one");
    tell(position);
  }

  const stage = crankcheck.stage("polygons", {
    overlays: () => [], drawn: (_, position) => draw(position), home: () => own.home, lasts: () => own.lasts_ms,
  });
  step.addEventListener("input", () => draw(last));
  part("scale").addEventListener("change", () => draw(last));
  for (const { quantity } of figures) {
    new ResizeObserver(() => draw(last)).observe(part(quantity));
  }
  stage.set(own.drawing);
  stage.draw();
  stage.start();
})();
