"use strict";
// A scene with elastic links in motion: displacements from the rigid mechanism, magnified, over it.

(() => {
  const own = crankcheck.embedded("motion");
  const bent = Object.fromEntries(Object.entries(own.bent).map(([name, { pins, rows }]) =>
    [name, { pins, rows: crankcheck.unpacked(rows) }]));
  const run = { name: "elastic", rows: crankcheck.unpacked(own.moved), bent, paint: "c5", width: 3.2 };
  const told = document.getElementById("motion-deflection");

  const stage = crankcheck.stage("motion", {
    overlays: () => [run],
    lasts: () => own.lasts_ms,
    drawn: (mechanism, position) => {
      const each = Object.entries(bent).map(([name, { rows }]) => {
        const middle = 1e3 * mechanism.between(rows[(rows.length - 1) / 2], position);
        return `${name} ${crankcheck.readable(middle)} mm`;
      });
      told.textContent = each.length ? `Deflection of the middle here: ${each.join("; ")}.` : "";
    },
  });
  stage.set(own.drawing);
  stage.draw();
  stage.start();
})();
