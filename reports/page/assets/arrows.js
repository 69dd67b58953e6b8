"use strict";
// Forces as arrows on a drawing of a mechanism, all to one scale, with a bar that says it.
// They are what `reports.drawing.force_arrows` writes.

/** Gives `(position, onScreen, pixels)`, which draws the arrows: `pixels` are those of a metre. */
crankcheck.arrows = (forces) => {
  const { svg, unpacked } = crankcheck;
  const rows = unpacked(forces.rows);
  const [HEAD, HALF, LEAST] = [11, 4, 4]; // of an arrow, and the shortest that is drawn [px]

  function at(row, position) {
    const first = Math.floor(position);
    const next = Math.min(first + 1, row.length - 1);
    return row[first] + (position - first) * (row[next] - row[first]);
  }

  /** From a place on the screen; cut off, without a head, where it is too long. */
  function arrow([x, y], [fx, fy], kind, pixels) {
    const long = Math.hypot(fx, fy) * forces.m_per_n * pixels;
    if (!(long > LEAST)) return "";
    const most = forces.most_m * pixels;
    const drawn = Math.min(long, most);
    const [c, s] = [fx / Math.hypot(fx, fy), -fy / Math.hypot(fx, fy)]; // the screen's y points down
    const along = (t, across = 0) => `${(x + t * c - across * s).toFixed(2)} ${(y + t * s + across * c).toFixed(2)}`;
    const head = Math.min(HEAD, 0.6 * drawn);
    const half = (HALF * head) / HEAD;
    const foot = long > most ? drawn : drawn - head;
    const tip = long > most ? "" : `M${along(drawn)} L${along(foot, half)} L${along(foot, -half)}Z`;
    return svg("g", { class: `force ${kind}` }, svg("path", { d: `M${along(0)} L${along(foot)}` }), svg("path", { d: tip, class: "head" }));
  }

  /** How long a round force is drawn. */
  function bar(pixels, [right, low]) {
    const long = forces.bar_n * forces.m_per_n * pixels;
    const [from, to] = [right - long, right];
    return svg("g", { class: "force-bar" },
      svg("path", { d: `M${from} ${low - 4}v8m0-4H${to}m0-4v8` }),
      svg("text", { x: (from + to) / 2, y: low - 6, "text-anchor": "middle" }, `${forces.bar_n} N`));
  }

  return (position, onScreen, pixels, corner) => {
    const drawn = forces.arrows.map((one, i) =>
      arrow(onScreen(one.point), [at(rows[2 * i], position), at(rows[2 * i + 1], position)], one.kind, pixels));
    return [...drawn.filter(Boolean), ...(forces.bar_n && corner ? [bar(pixels, corner)] : [])];
  };
};
