"use strict";
// A vector polygon at an instant: what `reports.sheets.polygons.polygon_page` writes, drawn up to a step.

crankcheck.polygonFigure = (element, polygon) => {
  const { svg, unpacked } = crankcheck;
  const [HEAD, HALF, BEYOND, AWAY, NEAR] = [11, 3.6, 24, 14, 5]; // of an arrow, a direction, letters [px]
  const [ROOM, BAR] = [38, 110]; // around a polygon; the longest bar of scale [px]
  const rows = unpacked(polygon.rows);
  const places = unpacked(polygon.places);
  let onScreen = ([x, y]) => [x, y];

  function between(row, position) {
    const first = Math.min(Math.floor(position), row.length - 1);
    const next = Math.min(first + 1, row.length - 1);
    return row[first] + (position - first) * (row[next] - row[first] || 0);
  }

  /** The corners of what stands there at a position, the pole with it. */
  function boxAt(position) {
    const each = [...polygon.vectors.map((_, i) => ends(i, position)), ...polygon.points.map((_, i) => pointAt(i, position)), [0, 0]];
    const numbers = each.filter((one) => one.every(Number.isFinite));
    const [xs, ys] = [0, 1].map((k) => numbers.flatMap((one) => one.filter((_, i) => i % 2 === k)));
    return [Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)];
  }

  /** Take a box into the element, with room for letters; gives the pixels of its unit. */
  function fit([x0, y0, x1, y1]) {
    const { width, height } = element.getBoundingClientRect();
    const room = [width, height].map((side) => Math.max(side - 2 * ROOM, 10));
    const scale = Math.min(room[0] / (x1 - x0 || 1e-9), room[1] / (y1 - y0 || 1e-9));
    const pixels = x1 > x0 || y1 > y0 ? scale : 1;
    onScreen = ([x, y]) => [width / 2 + pixels * (x - (x0 + x1) / 2), height / 2 - pixels * (y - (y0 + y1) / 2)];
    element.setAttribute("viewBox", `0 0 ${width || 1} ${height || 1}`);
    return pixels;
  }

  /** How long a round number is drawn, in the lower left corner. */
  function bar(pixels) {
    const most = BAR / pixels;
    const power = 10 ** Math.floor(Math.log10(most));
    const size = [5, 2, 1].find((round) => round * power <= most) * power;
    const low = element.getBoundingClientRect().height - 9;
    return svg("g", { class: "bar" }, svg("path", { d: `M10 ${low - 4}v8m0-4H${10 + size * pixels}m0-4v8` }),
      svg("text", { x: 10 + (size * pixels) / 2, y: low - 11 }, `${crankcheck.readable(size)} ${polygon.unit}`));
  }

  const line = (ends) => `M${ends.map((p) => p.map((v) => v.toFixed(2)).join(" ")).join("L")}`;

  /** Where a vector begins and ends at a position: four numbers, NaN where it is not determined. */
  const ends = (i, position) => [0, 1, 2, 3].map((k) => between(rows[4 * i + k], position));

  function arrow(vector, [x0, y0, x1, y1]) {
    const [a, b] = [onScreen([x0, y0]), onScreen([x1, y1])];
    const long = Math.hypot(b[0] - a[0], b[1] - a[1]);
    if (!(long > 0.5)) return "";
    const [c, s] = [(b[0] - a[0]) / long, (b[1] - a[1]) / long];
    const along = (t, across = 0) => [a[0] + t * c - across * s, a[1] + t * s + across * c];
    const head = Math.min(HEAD, 0.4 * long);
    const half = (HALF * head) / HEAD;
    const tip = `${line([along(long), along(long - head, half), along(long - head, -half)])}Z`;
    return svg("g", { class: `of-${vector.kind}` },
      vector.found && svg("path", { class: "direction", d: line([along(-BEYOND), along(long + BEYOND)]) }),
      svg("path", { d: line([along(0), along(long - head)]) }),
      svg("path", { class: "head", d: tip }));
  }

  const pointAt = (i, position) => (i < 0 ? [0, 0] : [between(places[2 * i], position), between(places[2 * i + 1], position)]);

  /** Letters of points, those that stand together as one, outwards of the middle of all. */
  function letters(named) {
    const spots = [];
    for (const [letter, at] of named) {
      const same = spots.find((each) => Math.hypot(each.at[0] - at[0], each.at[1] - at[1]) < NEAR);
      if (same) same.letters.push(letter);
      else spots.push({ at, letters: [letter] });
    }
    const middle = [0, 1].map((k) => spots.reduce((sum, { at }) => sum + at[k], 0) / spots.length);
    return spots.map(({ at, letters: several }) => {
      const [x, y] = [at[0] - middle[0], at[1] - middle[1]];
      const long = Math.hypot(x, y);
      const [c, s] = long > 1 ? [x / long, y / long] : [0, -1];
      const text = several.join(", ");
      return svg("text", { x: at[0] + c * (AWAY + 3.2 * (text.length - 1)), y: at[1] + s * AWAY }, text);
    });
  }

  /**
   * Draw it as it is at a position, its first steps alone, with the images where these are all; as
   * large as it fits there, or at the `one` scale of all positions.
   */
  function show(position, steps, one) {
    const pixels = fit(one ? polygon.box : boxAt(position));
    const whole = steps >= polygon.steps.length;
    const drawn = polygon.vectors.flatMap((vector, i) => (vector.step < steps ? [arrow(vector, ends(i, position))] : []));
    const there = polygon.points.flatMap((point, i) => {
      const known = whole || (point.step >= 0 && point.step < steps);
      const at = onScreen(pointAt(i, position));
      return known && at.every(Number.isFinite) ? [[point, at]] : [];
    });
    const images = whole ? polygon.images.map((image) => {
      const corners = image.map((i) => onScreen(pointAt(i, position)));
      return corners.flat().every(Number.isFinite) ? svg("path", { class: "image", d: `${line(corners)}Z` }) : "";
    }) : [];
    const nodes = there.filter(([point]) => point.step >= 0);
    element.replaceChildren(...[
      ...images, ...drawn,
      ...nodes.map(([, [cx, cy]]) => svg("circle", { class: "end", cx, cy, r: 3 })),
      pixels === 1 ? "" : bar(pixels),
      ...letters([[polygon.pole, onScreen([0, 0])], ...there.map(([point, at]) => [point.letter, at])]),
    ].filter(Boolean));
  }

  return { show, ends, between };
};
