"use strict";
// The mechanism as the closed form has it, and over it what a log says of it.

(() => {
  const own = crankcheck.embedded("motion");
  const stretch = document.getElementById("motion-stretch");
  const time = document.getElementById("motion-time");
  const FARTHEST = 40; // far out of the picture, over the size of the drawing
  let shown = null;

  const overlays = () => shown.pieces.map((piece) => ({
    name: piece.name, rows: (piece.unpacked ??= crankcheck.unpacked(piece.rows)), only: piece.only, width: 3,
    paint: piece.apart ? "logged apart" : "logged",
  }));

  const stage = crankcheck.stage("motion", {
    overlays,
    home: (mechanism) => mechanism.worst(overlays().map((each) => each.rows)), reach: FARTHEST,
    drawn: (mechanism, position) => {
      const [start, end] = [shown.start, shown.end].map(Number);
      const at = start + ((end - start) * position) / (mechanism.samples - 1);
      const places = Math.max(0, 4 - Math.floor(Math.log10(end - start)));
      time.textContent = `t = ${Number(at.toFixed(places))} s`;
    },
  });

  function choose() {
    shown = own.stretches[Number(stretch?.value ?? 0)];
    stage.set(shown.drawing);
    stage.makeVisible();
  }

  stretch?.addEventListener("change", choose);
  choose();
  stage.start();
})();
