"use strict";
// The figure of a construction: what `reports.sheets.constructions.construction_page` writes, drawn up to a part
// of a step into the drawing of a mechanism.

crankcheck.constructionFigure = (element, own, mechanism) => {
  const { svg } = crankcheck;
  const [FOOT, AWAY, AROUND] = [11, [13, 19, 27, 36], 16]; // of a pivot; letters off their dots [px], directions
  const [HALF, TALL] = [4.6, 8]; // of a letter's box, by letter and all of them [px]
  const lines = svg("g", { class: "lines" });
  const dots = svg("g", { class: "dots" });
  const poses = svg("g", { class: "poses" });
  element.querySelector(".reference").before(svg("g", { class: "construction" }, lines, dots), poses);
  let groups = []; // of each step what it draws: {group, paths} of lines, {group} of dots
  let stands = []; // the paths of each pose

  const pairs = (flat) => Array.from({ length: flat.length / 2 }, (_, i) => mechanism.toScreen([flat[2 * i], flat[2 * i + 1]]));
  const text = (points) => `M${points.map((p) => p.map((v) => v.toFixed(2)).join(" ")).join("L")}`;

  /** Whether a place is on the screen. */
  function isSeen(place) {
    const { width, height } = element.getBoundingClientRect();
    const [x, y] = mechanism.toScreen(place);
    return x >= 0 && x <= width && y >= 0 && y <= height;
  }

  /** Places along all lines [px], to keep letters off them. */
  function ink(every) {
    const found = [];
    for (const points of every) {
      for (let i = 1; i < points.length; i += 1) {
        const [[x0, y0], [x1, y1]] = [points[i - 1], points[i]];
        const many = Math.min(Math.ceil(Math.hypot(x1 - x0, y1 - y0) / 5), 400) || 1;
        for (let k = 0; k < many; k += 1) found.push([x0 + ((x1 - x0) * k) / many, y0 + ((y1 - y0) * k) / many]);
      }
    }
    return found;
  }

  /** Where a letter stands best: near its dot, off lines, off the dots and the letters that are there. */
  function placed(letter, [x, y], crowd, taken) {
    const { width, height } = element.getBoundingClientRect();
    const half = HALF * letter.length + 2;
    let [least, best] = [Infinity, [x, y - AWAY[0]]];
    for (const [far, away] of AWAY.entries()) {
      for (let k = 0; k < AROUND; k += 1) {
        const angle = (2 * Math.PI * (k + 0.5)) / AROUND;
        const at = [x + (away + half - HALF) * Math.cos(angle), y + away * Math.sin(angle)];
        const off = Math.max(half - at[0], at[0] + half - width, TALL - at[1], at[1] + TALL - height, 0);
        const over = crowd.filter(([u, v]) => Math.abs(u - at[0]) < half && Math.abs(v - at[1]) < TALL).length;
        const on = taken.filter((one) => Math.abs(one.at[0] - at[0]) < half + one.half && Math.abs(one.at[1] - at[1]) < 2 * TALL).length;
        const cost = 1.5 * far + over + 100 * on + 100 * off;
        if (cost < least) [least, best] = [cost, at];
      }
    }
    taken.push({ at: best, half });
    return best;
  }

  /** A dot with its letter; a pivot of the ground on its foot. */
  function dot({ at, letter, fixed, look }, spot) {
    const [cx, cy] = mechanism.toScreen(at);
    const foot = [[cx, cy], [cx - FOOT, cy + 1.6 * FOOT], [cx + FOOT, cy + 1.6 * FOOT]];
    return svg("g", { class: look },
      fixed ? svg("path", { class: "foot", d: `${text(foot)}Z` }) : "",
      svg("circle", { cx, cy, r: fixed || look === "result" ? 4.5 : 3.2 }),
      spot ? svg("text", { x: spot[0], y: spot[1] }, letter) : "");
  }

  /** Lay out all of it in the size of the element. */
  function refit() {
    const every = own.steps.map((step) => step.map((each) => (each.lines ?? []).map(pairs)));
    const crowd = ink(every.flat(2));
    for (const { at, fixed } of own.steps.flat().filter((each) => each.at)) {
      const [x, y] = mechanism.toScreen(at);
      crowd.push([x, y], [x - 4, y], [x + 4, y], [x, y - 4], [x, y + 4]);
      if (fixed) crowd.push(...[-1, -0.5, 0, 0.5, 1].flatMap((k) => [[x + k * FOOT, y + 1.6 * FOOT], [x + 0.5 * k * FOOT, y + 0.9 * FOOT]]));
    }
    const [taken, told] = [[], new Set()];
    groups = own.steps.map((step, n) => step.map((each, i) => {
      if (each.at) {
        const name = `${each.letter} ${mechanism.toScreen(each.at).map(Math.round)}`;
        const isNew = each.letter && isSeen(each.at) && !told.has(name);
        told.add(name);
        return { group: dot(each, isNew && placed(each.letter, mechanism.toScreen(each.at), crowd, taken)) };
      }
      const paths = every[n][i].map((points) => svg("path", { d: text(points), pathLength: 1 }));
      return { group: svg("g", { class: each.look }, ...paths), paths };
    }));
    lines.replaceChildren(...groups.flat().filter(({ paths }) => paths).map(({ group }) => group));
    dots.replaceChildren(...groups.flat().filter(({ paths }) => !paths).map(({ group }) => group));
    stands = own.poses.map(({ links, places }) => svg("g", {},
      ...links.map((flat) => svg("path", { d: text(pairs(flat)) })),
      ...places.map((at) => mechanism.toScreen(at)).map(([cx, cy]) => svg("circle", { cx, cy, r: 7 }))));
    poses.replaceChildren(...stands);
  }

  /** Draw the first steps, and a share of the last of them: its lines grow, its dots come after them. */
  function show(steps, share) {
    groups.forEach((step, n) => {
      const grown = n + 1 < steps ? 1 : n + 1 === steps ? share : 0;
      for (const { group, paths } of step) {
        group.classList.toggle("now", n + 1 === steps);
        group.toggleAttribute("hidden", paths ? grown === 0 : grown < 1);
        for (const path of paths ?? []) path.setAttribute("stroke-dasharray", grown < 1 ? `${grown} 2` : "none");
      }
    });
  }

  /** Mark the pose that the mechanism stands in; -1 for none. */
  const meet = (number) => stands.forEach((pose, n) => pose.classList.toggle("met", n === number));

  return { refit, show, meet, isSeen };
};
