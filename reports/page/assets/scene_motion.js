"use strict";
// A scene as the closed form has it, in motion, with what drives it where it was requested.

(() => {
  const own = crankcheck.embedded("motion");
  const effort = own.effort && crankcheck.unpacked(own.effort.series)[0];
  const told = document.getElementById("motion-torque");

  const stage = crankcheck.stage("motion", {
    overlays: () => [],
    drawn: (mechanism, position) => {
      if (!effort) return;
      const here = mechanism.between(effort, position);
      told.textContent = Number.isFinite(here) ? `Driving ${own.effort.name} here: ${Number(here.toPrecision(3))} ${own.effort.unit}.`
        : `The driving ${own.effort.name} is not determined here.`;
    },
  });
  stage.set(own.drawing);
  stage.draw();
  stage.start();
})();
