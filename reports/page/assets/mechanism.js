"use strict";
// A drawing of a mechanism that moves: the reference, and over it any runs, their error magnified.
// It reads what `reports.drawing.moving` writes, and nothing of the page around it.

crankcheck.mechanism = (() => {
  const { svg, unpacked } = crankcheck;
  const MARGIN = 0.12; // room around what moves, over its size
  const FARTHEST = 0.6; // a magnified displacement is cut off here, over the size of the drawing
  const CROWD = 24; // so many pins have no room for letters
  const TURNED = 0.7; // and a magnified turn of a block here [rad]

  /** A row at a position between samples. */
  function between(row, position) {
    const first = Math.min(Math.floor(position), row.length - 1);
    const second = Math.min(first + 1, row.length - 1);
    return row[first] + (position - first) * (row[second] - row[first]);
  }

  /** The vector cut off at a length, and whether it was. */
  function held([x, y], most) {
    const length = Math.hypot(x, y);
    return length > most ? [[(x * most) / length, (y * most) / length], true] : [[x, y], false];
  }

  /** What a drawing knows of a scene, with its series unpacked. */
  function read(drawing) {
    const [x0, y0, x1, y1] = drawing.box;
    const size = Math.max(x1 - x0, y1 - y0);
    const places = unpacked(drawing.places);
    const rows = new Map(drawing.points.map((name, i) => [name, [places[2 * i], places[2 * i + 1]]]));
    return {
      ...drawing, size, rows, turns: unpacked(drawing.angles),
      sliders: drawing.sliders.map((slider) => ({ ...slider, along: unpacked(slider.along)[0] })),
      low: [x0 - MARGIN * size, y0 - MARGIN * size], high: [x1 + MARGIN * size, y1 + MARGIN * size],
    };
  }

  /**
   * Draw into an SVG element. Gives `samples`, `driver(position)` as it is told, and
   * `show(position, overlays, factor)`, which draws overlays `{rows, paint, trail, only, width}` and
   * tells whether any of them was cut off: at `reach` times the size of the drawing. With a `trail`
   * the way that its points have come is drawn; `only` names the `links` that are drawn, the
   * points of `blocks`, and those that get `marks` of their own. `bent` are elastic links by name:
   * the two `pins`, and `rows` of deflections from the line between them, at equal parts of it.
   */
  return (element, drawing, reach = FARTHEST) => {
    const scene = read(drawing);
    const samples = scene.told.at.length;
    const names = [...Object.keys(scene.ground), ...scene.points];
    element.classList.toggle("crowded", names.length > CROWD);
    const layers = ["paths", "ground", "guides", "reference", "overlays", "pins", "forces"].map((name) => svg("g", { class: name }));
    const [paths, ground, guides, reference, over, pins, forces] = layers;
    const arrows = drawing.forces ? crankcheck.arrows(drawing.forces) : null;
    element.replaceChildren(...layers);
    let pixel = 1;
    let toScreen = ([x, y]) => [x, y];

    function fit() {
      const { width, height } = element.getBoundingClientRect();
      const wide = scene.high[0] - scene.low[0];
      const high = scene.high[1] - scene.low[1];
      const scale = Math.min(width / wide, height / high) || 1;
      const [left, top] = [(width - scale * wide) / 2, (height - scale * high) / 2];
      pixel = 1 / scale;
      toScreen = ([x, y]) => [left + scale * (x - scene.low[0]), top + scale * (scene.high[1] - y)];
      element.setAttribute("viewBox", `0 0 ${width || 1} ${height || 1}`);
    }

    /** Where a bar of scale ends: the lower right corner of the element. */
    function corner() {
      const { width, height } = element.getBoundingClientRect();
      return [width - 14, height - 14];
    }

    const text = (points) => points.map((p) => toScreen(p).map((v) => v.toFixed(2)).join(" ")).join(" L");
    const path = (points, attributes, closed = false) =>
      svg("path", { d: `M${text(points)}${closed ? "Z" : ""}`, ...attributes });

    /** Where a point is; `run` adds its displacement. */
    function place(name, position, run) {
      const fixed = scene.ground[name];
      if (fixed) return fixed;
      const [xs, ys] = scene.rows.get(name);
      const exact = [between(xs, position), between(ys, position)];
      if (!exact.every(Number.isFinite)) return null;
      if (!run) return exact;
      const row = 2 * scene.points.indexOf(name);
      const off = [0, 1].map((i) => run.factor * between(run.rows[row + i], position));
      if (!off.every(Number.isFinite)) return null;
      const [moved, cut] = held(off, reach * scene.size);
      run.cut ||= cut;
      return [exact[0] + moved[0], exact[1] + moved[1]];
    }

    /** The angle of a slider's guide or of curves, as the reference or as a run has it. */
    function direction(slider, position, run) {
      const guide = scene.guides.indexOf(slider.on);
      if (guide < 0) return slider.angle;
      const exact = slider.angle + between(scene.turns[guide], position);
      if (!run) return exact;
      const off = run.factor * between(run.rows[2 * scene.points.length + guide], position);
      return exact + Math.max(-TURNED, Math.min(TURNED, off || 0));
    }

    /** The places along an elastic link between its pins; one of them null where a pin has none. */
    function bow({ pins: [a, b], rows }, position, run) {
      const [start, end] = [a, b].map((name) => place(name, position, run));
      if (!start || !end) return [null];
      const [x, y] = [end[0] - start[0], end[1] - start[1]];
      const length = Math.hypot(x, y) || 1;
      return rows.map((row, k) => {
        const [share, off] = [k / (rows.length - 1), (run.factor * between(row, position)) / length];
        return [start[0] + share * x - off * y, start[1] + share * y + off * x];
      });
    }

    /** The curves of one body about its point; a run has none on the ground, and of `only` its links. */
    function outline(own, position, run) {
      if (run && (own.body === "ground" || run.only?.links?.includes(own.body) === false)) return null;
      const middle = place(own.point, position, run);
      if (middle === null) return null;
      const angle = direction({ on: own.on, angle: own.angle_rad }, position, run);
      const [c, s] = [Math.cos(angle), Math.sin(angle)];
      const d = own.curves.map((curve) =>
        `M${text(curve.map(([x, y]) => [middle[0] + c * x - s * y, middle[1] + s * x + c * y]))}Z`).join("");
      return svg("path", { d, class: `curve${own.body === scene.driver ? " driver" : ""}` });
    }

    /** The links and blocks of the reference or of a run; of a run that has `only` some, these. */
    function bodies(position, run) {
      const { links, blocks: those, marks } = run?.only ?? {};
      const found = scene.links.map((link) => {
        if (links && !links.includes(link.name)) return null;
        const bent = run?.bent?.[link.name];
        const corners = bent ? bow(bent, position, run) : link.points.map((name) => place(name, position, run));
        if (corners.some((corner) => corner === null)) return null;
        const plate = corners.length > 2 && !bent;
        const kind = `link${link.name === scene.driver ? " driver" : ""}${plate ? " plate" : ""}`;
        return path(corners, { class: kind }, plate);
      });
      const blocks = scene.sliders.map((slider) => {
        if (slider.bare || (those && !those.includes(slider.point))) return null;
        const middle = place(slider.point, position, run);
        if (middle === null) return null;
        const angle = direction(slider, position, run);
        const [c, s] = [Math.cos(angle), Math.sin(angle)];
        const corners = [[-13, -8], [13, -8], [13, 8], [-13, 8]].map(([x, y]) => [
          middle[0] + pixel * (c * x - s * y), middle[1] + pixel * (s * x + c * y),
        ]);
        return path(corners, { class: "block" }, true);
      });
      const lone = (marks ?? []).map((name) => {
        const middle = place(name, position, run);
        if (middle === null) return null;
        const [cx, cy] = toScreen(middle);
        return svg("circle", { class: "mark", cx, cy, r: 8 });
      });
      const curves = (scene.curves ?? []).map((own) => outline(own, position, run));
      return [...curves, ...found, ...blocks, ...lone].filter(Boolean);
    }

    /** A line through the places of a point, in parts where some are missing. */
    function way(places, attributes) {
      const parts = [[]];
      for (const each of places) {
        if (each) parts.at(-1).push(each);
        else parts.push([]);
      }
      const d = parts.filter((each) => each.length).map((each) => `M${text(each)}`).join("");
      return svg("path", { d, ...attributes });
    }

    /** The way that the points of a run have come. */
    function trails(position, run) {
      if (!run.trail) return [];
      const past = [...Array(Math.floor(position) + 1).keys(), position];
      return scene.points.map((name) => way(past.map((at) => place(name, at, run)), { class: "trail" }));
    }

    /** The line of a guide, as far as its slider runs. */
    function guide(slider, position) {
      const [x, y] = place(slider.point, position) ?? [];
      if (x === undefined) return "";
      const angle = direction(slider, position);
      const along = between(slider.along, position);
      const spare = 22 * pixel;
      const ends = [slider.reach[0] - spare - along, slider.reach[1] + spare - along];
      return path(ends.map((s) => [x + s * Math.cos(angle), y + s * Math.sin(angle)]), { class: "guide" });
    }

    /** What does not move: the paths of the points, and the ground's pins on their triangles. */
    function still() {
      fit();
      const every = [...Array(samples).keys()];
      paths.replaceChildren(...scene.points.map((name) => way(every.map((at) => place(name, at)), { class: "path" })));
      const foot = (names.length > CROWD ? 5 : 11) * pixel;
      ground.replaceChildren(...Object.values(scene.ground).map(([x, y]) =>
        path([[x, y], [x - foot, y - 1.6 * foot], [x + foot, y - 1.6 * foot]], { class: "foot" }, true)));
    }

    function pin(name, position) {
      const found = place(name, position);
      if (!found) return [];
      const [x, y] = toScreen(found);
      const block = scene.sliders.some((slider) => slider.point === name);
      const away = block ? 15 : 8;
      return [
        svg("circle", { class: "pin", cx: x, cy: y, r: names.length > CROWD ? 2 : 4 }),
        ...(names.length > CROWD ? [] : [svg("text", { class: "letter", x: x + away, y: y - away }, name)]),
      ];
    }

    function show(position, overlays, factor) {
      const runs = overlays.map((overlay) => ({ ...overlay, factor, cut: false }));
      guides.replaceChildren(...scene.sliders.map((slider) => guide(slider, position)));
      reference.replaceChildren(...bodies(position));
      // Runs that lie on each other are seen as rims: the first is the widest.
      over.replaceChildren(...runs.map((run, i) =>
        svg("g", { class: `run ${run.paint}`, "stroke-width": run.width ?? Math.min(2 + 2 * (runs.length - 1 - i), 6.5) },
          ...trails(position, run), ...bodies(position, run))));
      pins.replaceChildren(...names.flatMap((name) => pin(name, position)));
      if (arrows) forces.replaceChildren(...arrows(position, (name) => toScreen(place(name, position)), 1 / pixel, corner()));
      return runs.some((run) => run.cut);
    }

    /** The largest displacement of a run at a position, or over all of them [m]. */
    function farthest(rows, position = null) {
      let most = 0;
      for (let i = 0; i < 2 * scene.points.length; i += 2) {
        const at = position === null ? [...rows[i].keys()] : [position];
        for (const t of at) most = Math.max(most, Math.hypot(between(rows[i], t), between(rows[i + 1], t)) || 0);
      }
      return most;
    }

    /** The position at which some runs are farthest off. */
    function worst(rows) {
      let [most, found] = [0, 0];
      for (let at = 0; at < samples; at += 1) {
        const off = Math.max(0, ...rows.map((each) => farthest(each, at)));
        if (off > most) [most, found] = [off, at];
      }
      return found;
    }

    still();
    return {
      samples, show, farthest, worst, refit: still, size: scene.size,
      driver: (position) => between(scene.told.at, position), between, toScreen: (place) => toScreen(place),
    };
  };
})();
