"use strict";
// Elastic links, one scene at a time: how far they bend over a turn, and their errors.

(() => {
  const { colour, escaped, folded, freeCourses, looks, unpacked } = crankcheck;
  const own = crankcheck.embedded("elastic");
  const part = (name) => document.getElementById(`elastic-${name}`);
  const [scene, course, error, table] = ["scene", "course", "error", "cells"].map(part);
  const TOLD = {
    deflection: "Distance of the middle of each elastic link from the line between its pins, at the finest step without failure. Grey and wide: the beam.",
    error: "Error of the deflection compared with the beam, at the finest step without failure.",
  };
  let legend = null;
  let orders = null;

  const shown = () => own.courses.filter((each) => each.scene === scene.value);

  const trace = (each, y, name, paint, width, dash) => ({
    x: each.x, y: [...y].map((v) => 1000 * v), name: escaped(name), mode: "lines", line: { color: paint, width, dash },
    hovertemplate: `${folded(name)}: %{y:.4~g} mm<extra></extra>`,
  });

  /** The beam, once for each elastic link: the deflection in the engine, less its error. */
  function beams(courses) {
    const first = new Map(courses.toReversed().map((each) => [each.link, each]));
    return [...first.values()].map((each) => {
      const [middle, off] = each.rows;
      return trace(each, [...middle].map((v, i) => v - off[i]), `${each.link}, beam`, colour("rule"), 6, "solid");
    });
  }

  function figure() {
    const courses = shown();
    for (const each of courses) if (!Array.isArray(each.rows)) each.rows = unpacked(each.rows).map((row) => [...row]);
    const bent = course.value === "deflection";
    const engines = courses.filter((each) => legend.on(each.look)).map((each) => {
      const look = looks[each.look];
      return trace(each, each.rows[bent ? 0 : 1], `${look.name}, ${each.link}, step ${each.step}`, colour(`c${look.colour}`), 1.6, look.dash);
    });
    const title = bent ? "deflection [mm]" : "error against the beam [mm]";
    return {
      data: [...(bent ? beams(courses) : []), ...engines],
      layout: {
        xaxis: { title: { text: courses[0]?.over ?? "" }, zeroline: false },
        yaxis: { title: { text: title }, exponentformat: "power", zeroline: true },
      },
    };
  }

  const fits = () => own.fits[error.value].filter((fit) => fit.scene === scene.value);
  const plot = crankcheck.chart(part("chart"), figure);
  const against = crankcheck.chart(part("convergence"), () => freeCourses.convergence(fits(), own.units[error.value], orders.on));

  function errors() {
    for (const fit of fits()) orders.note(fit.look, fit.label);
    against();
  }

  function curves() {
    part("caption").textContent = shown().length ? TOLD[course.value] : "All runs of this scene failed.";
    plot();
  }

  function choose() {
    const there = new Set(own.fits[error.value].filter((fit) => fit.scene === scene.value).map((fit) => fit.look));
    legend = crankcheck.legend(part("legend"), crankcheck.lookGroups(there), plot);
    orders = crankcheck.legend(part("orders"), crankcheck.lookGroups(there), against);
    for (const row of table.tBodies[0].rows) row.hidden = row.dataset.scene !== scene.value;
    curves();
    errors();
  }

  scene.addEventListener("change", choose);
  course.addEventListener("change", curves);
  error.addEventListener("change", errors);
  choose();
  crankcheck.cellsLead("elastic", own, (line) => {
    scene.value = line.scene;
    choose();
  });
})();
